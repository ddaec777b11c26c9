"""A motion that never comes back tells no law; a stroke from rest to rest tells some."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from discover.cli import main
from discover.readers import read_campaign
from discover.record_checks import data_errors, returns

REAL = Path(__file__).resolve().parents[4] / "shared" / "real-data"
SHARE = np.linspace(0.0, 1.0, 2000)


def _record(name: str) -> str:
    return f'[[records]]\nfile = "{name}"\n'


def _write(
    path: Path, time: np.ndarray, x: np.ndarray, *, noise: float = 0.002, friction: float = 0.0
) -> None:
    v = np.gradient(x, time)
    rng = np.random.default_rng(time.size)
    force = 3000.0 * v + 200.0 * np.gradient(v, time) + friction * np.sign(v)
    force = force + noise * np.std(force) * rng.standard_normal(time.size)
    x = x + 1e-4 * np.ptp(x) * rng.standard_normal(time.size)
    table = np.column_stack([time, 1e3 * x, force])
    header = "time [s],displacement [mm],force [N]"
    np.savetxt(path, table, delimiter=",", header=header, comments="", fmt="%.7g")


@pytest.mark.parametrize("samples", [16, 400])
def test_a_lone_record_of_an_eighth_of_a_cycle_does_not_pass(
    tmp_path: Path, samples: int, capsys: pytest.CaptureFixture[str]
) -> None:
    time = np.arange(samples) / (8.0 * samples)
    _write(tmp_path / "a.csv", time, 0.01 * np.sin(2.0 * np.pi * time))
    assert main(["check", str(tmp_path / "a.csv"), "-o", str(tmp_path / "out")]) == 1
    out = capsys.readouterr().out
    assert "Error: a.csv: the motion goes one way, and its speed does not both rise and fall" in out
    assert "these tests can tell" not in out


def test_beside_others_it_is_a_warning(tmp_path: Path) -> None:
    time = np.arange(400) / 100.0
    _write(tmp_path / "whole.csv", time, 0.01 * np.sin(2.0 * np.pi * time))
    _write(tmp_path / "part.csv", time, 0.01 * np.sin(0.1 * np.pi * time))
    toml = _record("whole.csv") + _record("part.csv")
    (tmp_path / "campaign.toml").write_text(toml)
    whole, part = read_campaign(tmp_path).records
    assert returns(whole)
    assert not returns(part)
    assert data_errors(read_campaign(tmp_path)) == ()


@pytest.mark.parametrize(
    ("x", "comes_back"),
    [
        (SHARE, False),
        (np.sin(0.5 * np.pi * SHARE), False),
        (1.0 - np.exp(-3.0 * SHARE), False),
        (np.exp(3.0 * SHARE), False),
        (np.clip(SHARE - 0.2, 0.0, 0.6), True),  # from rest to rest
        (0.5 - 0.5 * np.cos(np.pi * SHARE), True),
        (np.abs(SHARE - 0.5), True),  # to and fro at one speed
        (SHARE + 0.02 * np.sin(40.0 * SHARE), True),
    ],
    ids=["ramp", "quarter", "creep", "runaway", "trapezoid", "stroke", "to and fro", "uneven"],
)
@pytest.mark.parametrize("noise", [0.0, 1e-3])
def test_what_comes_back(x: np.ndarray, comes_back: bool, noise: float) -> None:
    from discover.record_checks.one_way import comes_back as found

    rng = np.random.default_rng(5)
    assert found(x + noise * np.ptp(x) * rng.standard_normal(x.size)) is comes_back


def _strokes(folder: Path, back: int) -> None:
    """Write three strokes from rest to rest, of which some are followed by the way back."""
    for k, seconds in enumerate((1.0, 2.0, 4.0)):
        cycles = 1.0 if k < back else 0.5
        time = np.linspace(0.0, seconds, 400)
        x = -0.01 * np.cos(2.0 * np.pi * cycles * time / seconds)
        _write(folder / f"{k}.csv", time, x, friction=50.0)
    (folder / "campaign.toml").write_text("".join(_record(f"{k}.csv") for k in range(3)))


@pytest.mark.parametrize("back", [0, 1])
def test_strokes_that_never_turn_back_do_not_tell_friction_from_a_constant_force(
    tmp_path: Path, back: int, capsys: pytest.CaptureFixture[str]
) -> None:
    _strokes(tmp_path, back)
    assert main(["check", str(tmp_path), "-o", str(tmp_path / "out")]) == 0
    said = "Warning: no fitted record turns back: dry friction and a constant force are one number"
    assert (said in capsys.readouterr().out) is (back == 0)


def test_an_answer_says_so_where_it_states_friction(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    _strokes(tmp_path, 0)
    assert main(["discover", str(tmp_path), "-o", str(tmp_path / "out")]) == 0
    document = json.loads((tmp_path / "out" / "study.json").read_text())
    assert any(b["friction"] for b in document["bands"])
    assert "Warning: no fitted record turns back" in capsys.readouterr().out


@given(
    st.floats(1e-6, 1e6),
    st.floats(-1e3, 1e3),
    st.booleans(),
    st.sampled_from([np.sin(0.25 * np.pi * SHARE), np.sin(0.9 * np.pi * SHARE)]),
)
def test_unit_zero_and_direction_of_time_change_nothing(
    scale: float, offset: float, turned: bool, x: np.ndarray
) -> None:
    from discover.record_checks.one_way import comes_back as found

    other = scale * (x[::-1] if turned else x)
    assert found(other + offset * np.ptp(other)) == found(x)


@pytest.mark.parametrize("name", sorted(p.name for p in REAL.glob("*/")) if REAL.is_dir() else [])
def test_measured_motions_come_back(name: str) -> None:
    assert all(returns(r) for r in read_campaign(REAL / name).records)

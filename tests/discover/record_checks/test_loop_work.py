"""Work over closed loops: exact for what is known, and undecided for what does no work."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from discover.readers import read_campaign
from discover.record_checks import data_errors, loop_work
from discover.records import Campaign

REAL = Path(__file__).resolve().parents[4] / "shared" / "real-data"
TIME = np.arange(20_000) / 1000.0
FREQUENCIES = np.linspace(0.3, 6.0, 10)


def _motion() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Ten sines: displacement, velocity, acceleration."""
    angle = 2.0 * np.pi * np.outer(FREQUENCIES, TIME) + (FREQUENCIES**2)[:, None]
    omega = 2.0 * np.pi * FREQUENCIES[:, None]
    wave = 0.004 * np.sin(angle)
    rate = 0.004 * omega * np.cos(angle)
    return wave.sum(axis=0), rate.sum(axis=0), -(omega**2 * wave).sum(axis=0)


def _read(folder: Path, x: np.ndarray, force: np.ndarray, step: float = 1e-3) -> Campaign:
    columns = np.column_stack([np.arange(x.size) * step, 1e3 * x, force])
    header = "time [s],displacement [mm],force [N]"
    np.savetxt(folder / "run.csv", columns, delimiter=",", header=header, comments="")
    (folder / "campaign.toml").write_text('[[records]]\nfile = "run.csv"\n')
    return read_campaign(folder)


def test_a_damper_and_friction_take_their_work_a_cycle() -> None:
    w, size = 2.0 * np.pi * 1.3, 0.01
    x, v = size * np.sin(w * TIME), size * w * np.cos(w * TIME)
    found = loop_work(x, 300.0 * v + 40.0 * np.sign(v) + 2e4 * x + 1e6 * x**3 + 75.0)
    assert found is not None
    assert found.mean == pytest.approx(np.pi * 300.0 * w * size**2 + 4.0 * 40.0 * size, rel=1e-3)
    assert found.takes
    assert not found.gives


def test_a_damper_beside_inertia_and_a_spring_is_passive(tmp_path: Path) -> None:
    x, v, a = _motion()
    force = 80.0 * a + 300.0 * v + 20_000.0 * x
    force = force + 0.01 * np.std(force) * np.random.default_rng(0).standard_normal(x.size)
    campaign = _read(tmp_path, x, force)
    assert data_errors(campaign) == ()
    turned = _read(tmp_path, x, -force)
    assert "negative throughout" in data_errors(turned)[0].text


@pytest.mark.parametrize("noise", [0.0, 0.01])
def test_a_spring_does_no_work(tmp_path: Path, noise: float) -> None:
    phase = np.arange(600) / 10.0
    for seed in range(12):
        force = 2000.0 * np.sin(phase)
        force = force + noise * 1400.0 * np.random.default_rng(seed).standard_normal(600)
        campaign = _read(tmp_path, 0.01 * np.sin(phase), force, step=0.01)
        assert data_errors(campaign) == ()
        record = campaign.records[0]
        found = loop_work(record.displacement, record.force)
        assert found is not None
        assert not found.takes
        assert not found.gives


@pytest.mark.parametrize("lossless", ["inertia", "spring", "stiffening spring"])
def test_random_motion_without_loss_is_undecided(lossless: str) -> None:
    x, _, a = _motion()
    force = {"inertia": 80.0 * a, "spring": 2e4 * x, "stiffening spring": 1e8 * x**3}[lossless]
    found = loop_work(x, force)
    assert found is not None
    assert not found.takes
    assert not found.gives


def test_one_loop_tells_a_lossy_spring_of_either_sign() -> None:
    turn = np.linspace(0.0, 2.0 * np.pi, 2000)
    x = 0.01 * (1.0 - np.cos(turn))
    force = 1e4 * x + 10.0 * np.sin(turn)
    found, turned = loop_work(x, force), loop_work(x, -force)
    assert found is not None
    assert turned is not None
    assert found.takes
    assert turned.gives
    # Between the levels at which it closes, which are within a tenth of the stroke's ends.
    assert 0.85 * np.pi * 0.1 < found.mean < np.pi * 0.1


def test_what_never_comes_back_closes_no_loop() -> None:
    assert loop_work(TIME, TIME) is None
    assert loop_work(np.ones(50), np.arange(50.0)) is None


def test_inputs_are_not_changed() -> None:
    x, v, _ = _motion()
    x.flags.writeable = v.flags.writeable = False
    assert loop_work(x, v) is not None


@pytest.mark.parametrize("name", ["foot-single-cam", "rack-pinion", "mr-utfsm-0p5A"])
def test_measured_devices_are_passive(name: str) -> None:
    if not (REAL / name).is_dir():
        pytest.skip(f"{REAL} is not beside the checkout")
    assert data_errors(read_campaign(REAL / name)) == ()

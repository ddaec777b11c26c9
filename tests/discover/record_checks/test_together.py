"""Records that do not belong together are named, and others are not."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from discover.cli import main
from discover.data_check import check_campaign
from discover.gap import close_gap
from discover.readers import read_campaign
from discover.records import Campaign
from discover.study import run_study

REAL = Path(__file__).resolve().parents[4] / "shared" / "real-data"
LONG = pytest.mark.sweep
SHIPPED = Path(__file__).resolve().parents[3] / "data"
PLAN = ((0.3, 15.0), (0.6, 15.0), (1.2, 15.0), (0.5, 6.0), (1.0, 6.0), (2.0, 6.0), (4.0, 6.0),
        (8.0, 3.0))  # fmt: skip
"""Frequencies, Hz, and amplitudes, mm."""


def _written(folder: Path, files: dict[str, tuple[np.ndarray, np.ndarray, np.ndarray]]) -> Campaign:
    """Write time, displacement and force as a testing machine's CSV files, and read them."""
    entries = []
    for number, (name, (time, place, force)) in enumerate(files.items()):
        noise = np.random.default_rng(number).standard_normal(time.size)
        table = np.column_stack([time, 1e3 * place, force + 0.01 * np.std(force) * noise])
        header = "time [s],displacement [mm],force [N]"
        np.savetxt(folder / name, table, delimiter=",", header=header, comments="", fmt="%.7g")
        entries.append(f'[[records]]\nfile = "{name}"\nheld_out = {str(number == 1).lower()}\n')
    (folder / "campaign.toml").write_text("\n".join(entries))
    return read_campaign(folder)


def _sines(law, other, odd: str) -> dict[str, tuple[np.ndarray, np.ndarray, np.ndarray]]:
    files = {}
    for frequency, size in PLAN:
        name = f"{frequency:g}hz-{size:g}mm.csv"
        omega, amplitude = 2.0 * np.pi * frequency, 1e-3 * size
        time = np.arange(600) / (100.0 * frequency)
        force = (other if name == odd else law)(amplitude, omega, omega * time)
        files[name] = time, amplitude * np.sin(omega * time), force
    return files


def _device(inertance: float, damping: float, friction: float):
    def force(amplitude: float, omega: float, theta: np.ndarray) -> np.ndarray:
        return (
            -inertance * amplitude * omega**2 * np.sin(theta)
            + damping * amplitude * omega * np.cos(theta)
            + friction * np.tanh(np.cos(theta) / 0.02)
        )

    return force


def _rough(amplitude: float, omega: float, theta: np.ndarray) -> np.ndarray:
    """A law that no four terms meet: order 0.5 by the rule of harmonics, a cube of the speed."""
    speed = amplitude * omega * np.cos(theta)
    return 3e4 * amplitude * np.sqrt(omega) * np.sin(theta + 0.25 * np.pi) + 3e4 * speed**3


@pytest.mark.parametrize("odd", ["0.6hz-15mm.csv", "2hz-6mm.csv", "8hz-3mm.csv"])
def test_a_file_of_another_device_is_named_and_no_other(tmp_path: Path, odd: str) -> None:
    mine, another = _device(370.0, 4000.0, 60.0), _device(120.0, 9000.0, 300.0)
    check = check_campaign(_written(tmp_path, _sines(mine, another, odd)))
    document = check.to_dict()
    assert document["belongs_together"] is False
    assert [d["record"] for d in document["differing"]] == [odd]
    assert check.passed
    (text,) = [f.text for f in check.findings if f.record == odd and "belong" in f.text]
    assert "standard deviations" in text


@pytest.mark.parametrize("law", [_device(370.0, 4000.0, 60.0), _rough], ids=["plain", "rough"])
def test_tests_of_one_device_belong_together(tmp_path: Path, law) -> None:
    check = check_campaign(_written(tmp_path, _sines(law, law, "")))
    assert check.to_dict()["belongs_together"] is True
    assert check.differing == ()


def _strokes(friction: float, seed: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """To and fro at one speed, smoothly turned, by a seal whose friction wavers by 8 %."""
    rng = np.random.default_rng(seed)
    time = np.arange(4000) / 200.0
    speed = 0.02 * np.tanh(np.sin(2.0 * np.pi * 0.23 * (time + 0.1 * seed)) / 0.1)
    place = np.cumsum(speed) / 200.0
    wavers = 1.0 + 0.08 * np.sin(2.0 * np.pi * time / rng.uniform(5.0, 9.0) + seed)
    return time, place, friction * wavers * np.tanh(speed / 0.002) + 40.0 * speed


def test_repeats_of_one_condition_belong_together_and_more_friction_does_not(
    tmp_path: Path,
) -> None:
    files = {f"run-{k}.csv": _strokes(5.0 * (1.0 + 0.05 * (k - 2)), k) for k in (1, 2, 3)}
    assert check_campaign(_written(tmp_path, files)).differing == ()
    files["pressure.csv"] = _strokes(12.0, 4)
    check = check_campaign(_written(tmp_path, files))
    assert [d.record for d in check.differing] == ["pressure.csv"]
    friction = next(t for t in check.differing[0].terms if t.id == "coulomb-friction")
    assert friction.here == pytest.approx(12.0, rel=0.1)
    assert friction.elsewhere == pytest.approx(5.0, rel=0.1)
    baseline = "fit:viscous-damping,coulomb-friction"
    campaign = read_campaign(tmp_path)
    for answer in (run_study(campaign), close_gap(campaign, baseline, effects=["stiffness"])):
        named = [f.record for f in answer.findings if "does not belong" in f.text]
        assert named == ["pressure.csv"]


@pytest.mark.usefixtures("undrawn")
def test_the_terminal_tells_it_beside_the_verdict(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    files = {f"run-{k}.csv": _strokes(5.0, k) for k in (1, 2, 3)}
    files["pressure.csv"] = _strokes(12.0, 4)
    _written(tmp_path, files)
    chosen = ["--terms", "viscous-damping,coulomb-friction", "-o", str(tmp_path / "out")]
    assert main(["discover", str(tmp_path), *chosen]) == 0
    lines = capsys.readouterr().out.splitlines()
    told = [n for n, line in enumerate(lines) if "does not belong with" in line]
    assert [lines[n].split(": ")[:2] for n in told] == [["Warning", "pressure.csv"]]
    assert lines[0].startswith("Verdict: ")
    assert lines[told[-1] + 1].startswith("Next: ")


@pytest.mark.parametrize("name", ["segmented", "hidden-effect", "device-12-rig"])
def test_shipped_campaigns_belong_together(name: str) -> None:
    assert check_campaign(read_campaign(SHIPPED / name)).differing == ()


@pytest.mark.parametrize(
    "name",
    ["elastomer-vhb4910", "foot-single-cam", pytest.param("fsae-damper-hard", marks=LONG),
     "fsae-damper-soft", "inerter-cvt-r0", "inerter-cvt-steady", "mr-utfsm-0p5A",
     "robot-franka-j7", "seal-oring-1bar", "seal-xring", pytest.param("silverbox", marks=LONG)],
)  # fmt: skip
def test_of_measured_campaigns_only_the_seal_at_several_pressures_is_told(name: str) -> None:
    if not (REAL / name).is_dir():
        pytest.skip(f"{REAL} is not beside the checkout")
    check = check_campaign(read_campaign(REAL / name))
    assert check.passed
    told = {d.record for d in check.differing}
    pressures = {f"xring-{p}bar.csv" for p in (1, 3, 5, 7)}
    assert told == (pressures if name == "seal-xring" else set())

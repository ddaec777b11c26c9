"""Random tests as a rig's logger writes them: used in the band of their motion by every verb."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from discover.data_check import check_campaign
from discover.gap import close_gap
from discover.motion_fit import observe
from discover.readers import read_campaign
from discover.records import Campaign
from discover.study import run_study


def white(rate: float, seconds: float, end: float, seed: int) -> tuple[np.ndarray, ...]:
    """Return time, displacement (m, white up to `end` Hz) and its first two derivatives."""
    rng = np.random.default_rng(seed)
    time = np.arange(int(rate * seconds)) / rate
    omega = 2.0 * np.pi * np.fft.rfftfreq(time.size, 1.0 / rate)
    lines = np.fft.rfft(rng.standard_normal(time.size)) * (omega <= 2.0 * np.pi * end)
    lines[0] = 0.0
    lines *= 2e-3 / np.std(np.fft.irfft(lines, time.size))
    return time, *(np.fft.irfft(lines * (1j * omega) ** k, time.size) for k in range(3))


def written(folder: Path, tests: list[tuple[np.ndarray, np.ndarray, np.ndarray]]) -> Campaign:
    toml = ""
    for number, (time, place, force) in enumerate(tests):
        table = np.column_stack([time, 1e3 * place, force])
        header = "time [s],displacement [mm],force [N]"
        name = f"random-{number}.csv"
        np.savetxt(folder / name, table, delimiter=",", header=header, comments="", fmt="%.7g")
        toml += f'[[records]]\nfile = "{name}"\n'
    (folder / "campaign.toml").write_text(toml)
    return read_campaign(folder)


@pytest.mark.parametrize("seen_to", [0.0, 1e-3])
def test_a_displacement_that_is_white_in_its_band_is_signal(
    tmp_path: Path, seen_to: float
) -> None:
    time, x, v, _ = white(3000.0, 20.0, 50.0, 0)
    rng = np.random.default_rng(1)
    noise = 0.01 * 1500.0 * np.std(v)
    force = 1500.0 * v + noise * rng.standard_normal(time.size)
    seen = x + seen_to * np.std(x) * rng.standard_normal(time.size)
    campaign = written(tmp_path, [(time, seen, force)])
    cutoff = observe(campaign.records[0]).cutoff
    assert cutoff is not None
    assert 40.0 < cutoff < 70.0
    check = check_campaign(campaign)
    assert check.passed
    expected = 100.0 * noise * np.sqrt(cutoff / 1500.0) / np.std(force)
    assert check.records[0].force_noise_percent == pytest.approx(expected, rel=0.3)


@pytest.mark.slow
def test_three_random_records_are_met_to_their_noise_by_every_verb(tmp_path: Path) -> None:
    tests = []
    for seed in range(3):
        time, x, v, a = white(500.0, 30.0, 8.0, seed)
        force = 120.0 * a + 2500.0 * v + 150.0 * np.tanh(v / 1e-3)
        noise = np.random.default_rng(100 + seed).standard_normal(time.size)  # not the drive
        tests.append((time, x, force + 0.01 * np.std(force) * noise))
    campaign = written(tmp_path, tests)
    study = run_study(campaign)
    (band,) = study.bands
    assert band.friction is not None
    assert study.relative_error_percent < 1.2 * band.noise_percent
    gap = close_gap(campaign, "fit:inertia,viscous-damping")
    assert gap.rounds[0].effect == "coulomb-friction"
    assert gap.final_gap_percent < 1.2 * gap.noise_percent
    assert gap.noise_percent == pytest.approx(band.noise_percent, rel=1e-9)

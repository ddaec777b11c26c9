"""Spikes and frozen stretches are told with their place; what devices and drives do is not."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from discover.readers import read_campaign
from tests.discover.readers.folder import DISPLACEMENT, FORCE, HEADER, ONE, TIME, campaign, rows

ROOT = Path(__file__).resolve().parents[3]
REAL = ROOT.parent / "shared" / "real-data"


def _told(folder: Path, displacement: np.ndarray, force: np.ndarray, toml: str = ONE) -> list[str]:
    text = HEADER + "\n" + rows(TIME, displacement, force)
    found = read_campaign(campaign(folder, text, toml=toml))
    return [f.text for f in found.findings if f.level == "warning"]


def _noisy(values: np.ndarray, seed: int) -> np.ndarray:
    return values + 0.01 * values.std() * np.random.default_rng(seed).standard_normal(values.size)


def test_a_spike_is_told_with_line_time_value_and_what_to_do(tmp_path: Path) -> None:
    force, displacement = _noisy(FORCE, 1), DISPLACEMENT.copy()
    force[400] = 20.0
    (text,) = _told(tmp_path, displacement, force)
    assert text.startswith("the force is 2e+04 N for one sample, line 402, between ")
    assert text.endswith("leave 2 s out by `range` in [[records]], or mend the file")
    displacement[1000] = 500.0
    spikes = _told(tmp_path, displacement, force)
    assert [t.split(",")[0] for t in spikes if "for one sample" in t] == [
        "the force is 2e+04 N for one sample",
        "the displacement is 0.5 m for one sample",
    ]


def test_a_spike_of_two_samples_is_told_beside_single_ones(tmp_path: Path) -> None:
    force = _noisy(FORCE, 1)
    force[400], force[700:702] = 20.0, -15.0
    single, double = _told(tmp_path, DISPLACEMENT, force)
    assert single.startswith("the force is 2e+04 N for one sample, line 402, between ")
    said = "the force is -1.5e+04 and -1.5e+04 N for 2 samples from line 702, between "
    assert double.startswith(said)
    assert "leave 3.5 to 3.505 s out by `range`" in double


def test_a_frozen_channel_is_told(tmp_path: Path) -> None:
    displacement = DISPLACEMENT.copy()
    displacement[500:540] = displacement[500]
    (text,) = _told(tmp_path, displacement, _noisy(FORCE, 1))
    assert "for 40 samples from line 502 on, while the rest moves: the channel looks frozen" in text
    assert "leave 2.5 s to 2.695 s out by `range`" in text


def test_a_line_is_that_of_the_file_in_a_part_of_it_too(tmp_path: Path) -> None:
    force = _noisy(FORCE, 1)
    force[400] = 20.0
    (text,) = _told(tmp_path, DISPLACEMENT, force, ONE + 'range = "1 s : 8 s"\n')
    assert "for one sample, line 402, " in text
    assert _told(tmp_path, DISPLACEMENT, force, ONE + 'range = "2.1 s : 8 s"\n') == []


def test_what_devices_and_drives_do_is_not_told(tmp_path: Path) -> None:
    impact = np.exp(-(((np.arange(TIME.size) - 900) / 1.5) ** 2))
    dwell = np.maximum(np.abs(TIME - 5.0) - 1.0, 0.0) ** 2  # begun and ended slowly
    for displacement, force in (
        (DISPLACEMENT, _noisy(FORCE, 1) + 30.0 * impact),
        (np.round(DISPLACEMENT, 0), _noisy(FORCE, 2)),
        (DISPLACEMENT, np.sign(FORCE) * (1.0 + 1e-3 * np.abs(FORCE))),
        (dwell, _noisy(FORCE, 3)),
    ):
        told = _told(tmp_path, displacement, force)
        assert [t for t in told if "one sample" in t or "frozen" in t] == []


@pytest.mark.parametrize("name", ["device-12-rig", "hidden-effect", "segmented"])
def test_shipped_campaigns_have_none(name: str) -> None:
    texts = [f.text for f in read_campaign(ROOT / "data" / name).findings]
    assert [t for t in texts if "one sample" in t or "frozen" in t] == []


@pytest.mark.slow
@pytest.mark.parametrize("name", sorted(p.name for p in REAL.glob("*/")) if REAL.is_dir() else [])
def test_measured_campaigns_have_none(name: str) -> None:
    texts = [f.text for f in read_campaign(REAL / name).findings]
    assert [t for t in texts if "one sample" in t or "frozen" in t] == []

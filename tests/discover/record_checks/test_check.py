"""Noise floors against the noise that was added, signs, copies and roles."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from discover import record_checks
from discover.data_check import check_campaign
from discover.motion_fit import observe, observe_all
from discover.readers import read_campaign
from discover.record_checks import CampaignCheck, RecordCheck, apparent
from discover.record_kind import classify
from discover.records import Campaign, Finding, Record
from discover.study import run_study
from discover.study.options import StudyOptions

REAL = Path(__file__).resolve().parents[4] / "shared" / "real-data"


def _record(
    f: float = 1.3,
    *,
    mass: float = 300.0,
    damping: float = 2000.0,
    friction: float = 0.0,
    noise: float = 0.0,
    seconds: float = 10.0,
    **more: object,
) -> Record:
    rng = np.random.default_rng(int(1000 * f))
    t = np.arange(int(seconds * 1000)) / 1000.0
    w = 2.0 * np.pi * f
    x = 0.01 * np.sin(w * t)
    v = 0.01 * w * np.cos(w * t)
    force = -mass * w**2 * x + damping * v + friction * np.sign(v)
    force = force + noise * rng.standard_normal(t.size)
    values = {"file": f"{f}hz.csv", "held_out": False, **more}
    return Record(
        time=t, force=force, displacement=x + 1e-6 * rng.standard_normal(t.size), **values
    )


def check_record(record: Record) -> RecordCheck:
    return record_checks.check_record(observe(record))


def check_records(campaign: Campaign) -> CampaignCheck:
    return record_checks.check_records(campaign, observe_all(campaign.records, 1))


def _levels(findings: tuple[Finding, ...], level: str) -> list[str]:
    return [f.text for f in findings if f.level == level]


@pytest.mark.parametrize("frequency", [0.23, 1.3, 7.77, 15.0])
@pytest.mark.parametrize("friction", [0.0, 100.0])
def test_sine_noise_floor_is_the_noise_that_was_added(frequency: float, friction: float) -> None:
    check = check_record(_record(frequency, noise=5.0, friction=friction))
    force = _record(frequency, noise=5.0, friction=friction).force
    expected = 100.0 * 5.0 / np.sqrt(np.mean(force**2))
    assert check.force_noise_percent == pytest.approx(expected, rel=0.1)
    assert check.displacement_noise_m == pytest.approx(1e-6, rel=0.1)


def test_hum_that_does_not_repeat_is_noise() -> None:
    record = _record(1.3)
    hum = 20.0 * np.sin(2 * np.pi * 50.0 * record.time)
    level = 20.0 / np.sqrt(2.0)  # its root mean square
    check = check_record(replace(record, force=record.force + hum))
    rms = np.sqrt(np.mean((record.force + hum) ** 2))
    assert check.force_noise_percent == pytest.approx(100.0 * level / rms, rel=0.1)


def test_drift_is_not_noise() -> None:
    record = _record(1.3, noise=5.0)
    drifted = replace(record, force=record.force + 30.0 * record.time)
    plain = check_record(record).force_noise_percent * np.sqrt(np.mean(record.force**2))
    other = check_record(drifted).force_noise_percent * np.sqrt(np.mean(drifted.force**2))
    assert other == pytest.approx(plain, rel=0.02)


def test_periodic_noise_floor() -> None:
    rng = np.random.default_rng(1)
    one = sum(np.cos(2 * np.pi * k * np.arange(2000) / 2000 + k * k) for k in range(3, 20))
    x = np.tile(one, 6) + 0.01 * rng.standard_normal(12000)
    force = np.tile(one[::-1], 6) + 0.2 * rng.standard_normal(12000)
    check = check_record(Record("m.csv", np.arange(12000) / 500.0, force, x))
    assert check.kind.kind == "periodic"
    assert check.displacement_noise_m == pytest.approx(0.01, rel=0.05)
    assert check.force_noise_percent == pytest.approx(20.0 / np.sqrt(np.mean(force**2)), rel=0.05)


def test_document_has_the_contracts_keys() -> None:
    entry = check_record(_record(1.3, noise=5.0)).to_dict()
    assert entry["file"] == "1.3hz.csv"
    assert entry["kind"] == "sine"
    assert entry["samples"] == 10000
    assert entry["sampling_hz"] == pytest.approx(1000.0)
    assert entry["frequency_hz"] == pytest.approx(1.3, rel=1e-5)
    assert entry["amplitude_m"] == pytest.approx(0.01, rel=1e-4)
    assert entry["cycles"] == pytest.approx(13.0, rel=1e-3)
    assert {"force_noise_percent", "displacement_noise_m"} <= entry.keys()


def test_apparent_mass_and_damping_of_a_sine_and_of_random_motion() -> None:
    found = apparent(_record(1.3), classify(_record(1.3)))
    assert found.mass == pytest.approx(300.0, rel=1e-3)
    assert found.damping == pytest.approx(2000.0, rel=1e-3)
    rng = np.random.default_rng(2)
    t = np.arange(20000) / 1000.0
    w = 2 * np.pi * rng.uniform(0.5, 8.0, 60)
    p, size = rng.uniform(0.0, 6.0, 60), 0.01 / np.arange(1, 61)
    x = sum(a * np.sin(k * t + q) for a, k, q in zip(size, w, p, strict=True))
    v = sum(a * k * np.cos(k * t + q) for a, k, q in zip(size, w, p, strict=True))
    acc = sum(-a * k**2 * np.sin(k * t + q) for a, k, q in zip(size, w, p, strict=True))
    record = Record("random.csv", t, 300.0 * acc + 2000.0 * v + 5e4 * x + 40.0, x)
    found = apparent(record, classify(record))
    assert found.mass == pytest.approx(300.0, rel=1e-6)
    assert found.damping == pytest.approx(2000.0, rel=1e-6)


def test_force_of_the_wrong_sign_throughout_is_one_error_that_says_what_to_do() -> None:
    records = tuple(_record(f, mass=-300.0, damping=-2000.0, noise=2.0) for f in (0.3, 1.1, 6.0))
    check = check_records(Campaign("c", records))
    assert not check.passed
    (text,) = _levels(check.findings, "error")
    assert "negative throughout" in text
    assert "by -1" in text


def test_springlike_device_of_the_wrong_sign_is_still_the_sign() -> None:
    records = tuple(_record(f, mass=400.0 / f**2, damping=-9000.0 / f) for f in (0.2, 0.5))
    (text,) = _levels(check_records(Campaign("c", records)).findings, "error")
    assert "negative throughout" in text


def test_springlike_device_of_the_right_sign_passes() -> None:
    records = tuple(_record(f, mass=-400.0 / f**2, damping=9000.0 / f) for f in (0.2, 0.5))
    assert check_records(Campaign("c", records)).passed


def test_one_flipped_record_is_named() -> None:
    records = (_record(0.4), _record(1.1, mass=-300.0, damping=-2000.0), _record(6.0))
    check = check_records(Campaign("c", records))
    assert [f.record for f in check.findings if f.level == "error"] == ["1.1hz.csv"]


def test_delayed_channel_is_not_called_a_wrong_sign() -> None:
    records = tuple(_record(f, damping=-0.1 * 300.0 * 2 * np.pi * f) for f in (2.0, 6.0))
    check = check_records(Campaign("c", records))
    assert check.passed
    assert any("skewed in time" in text for text in _levels(check.findings, "warning"))


def test_copies_are_found() -> None:
    first = _record(1.3, noise=1.0)
    same = replace(first, file="again.csv")
    check = check_records(Campaign("c", (first, same)))
    assert any("copy of 1.3hz.csv" in t for t in _levels(check.findings, "warning"))
    held = replace(first, file="again.csv", held_out=True)
    check = check_records(Campaign("c", (first, held)))
    assert any("holding out proves nothing" in t for t in _levels(check.findings, "error"))


def test_nothing_to_fit_is_an_error_and_nothing_held_out_a_note() -> None:
    held = replace(_record(1.3), held_out=True)
    assert _levels(check_records(Campaign("c", (held,))).findings, "error") == [
        "every record is held out: nothing is left to fit"
    ]
    both = check_records(Campaign("c", (_record(1.3), _record(2.2))))
    assert both.passed
    assert any("no record is held out" in t for t in _levels(both.findings, "note"))


def test_few_cycles_few_samples_and_noise_are_told_and_readings_findings_kept() -> None:
    short = _record(0.2, seconds=11.0)
    noisy = _record(1.3, noise=60.0, mass=10.0, damping=100.0)
    t = np.arange(300) / 10.0
    coarse = Record("coarse.csv", t, np.cos(2 * np.pi * 1.2 * t), np.sin(2 * np.pi * 1.2 * t))
    first = Finding("note", "read", "x.csv")
    check = check_records(Campaign("c", (short, noisy, coarse), findings=(first,)))
    texts = _levels(check.findings, "warning")
    assert any("only 2.20 usable cycles" in t for t in texts)
    assert any("only 8.3 samples a cycle" in t for t in texts)
    assert any("noise is" in t for t in texts)
    assert first in check.findings
    levels = [f.level for f in check.findings]
    assert levels == sorted(levels, key=["error", "warning", "note"].index)


def test_digitised_force_curve_has_the_noise_of_its_points_and_none_of_the_motion() -> None:
    t = np.linspace(0.0, 8.0, 400)
    force = np.sin(np.pi * t) + 0.02 * np.random.default_rng(0).standard_normal(400)
    check = check_record(
        Record("fig.csv", t, force, frequency=0.5, amplitude=0.02, uniform=False)
    )
    assert check.force_noise_percent == pytest.approx(100.0 * 0.02 * np.sqrt(2.0), rel=0.15)
    assert check.displacement_noise_m is None
    assert (check.frequency_hz, check.amplitude_m) == (0.5, 0.02)


def test_scaling_force_leaves_percent() -> None:
    record = _record(1.3, noise=5.0)
    one, ten = check_record(record), check_record(replace(record, force=10.0 * record.force))
    assert ten.force_noise_percent == pytest.approx(one.force_noise_percent)


@pytest.mark.parametrize("name", ["emps", "silverbox"])
def test_measured_campaigns_pass(name: str) -> None:
    if not (REAL / name).is_dir():
        pytest.skip(f"{REAL} is not beside the checkout")
    campaign = read_campaign(REAL / name)
    assert record_checks.data_errors(campaign) == ()


@pytest.mark.xfail(
    strict=True, reason="a trajectory's friction counts as noise in part: 1.5 % is said"
)
def test_a_measured_trajectory_has_the_noise_of_its_cycles() -> None:
    if not (REAL / "emps").is_dir():
        pytest.skip(f"{REAL} is not beside the checkout")
    check = check_records(read_campaign(REAL / "emps"))
    # The command changes by 0.9 % from one cycle to the next: 1 / sqrt 2 of it each.
    assert check.records[0].force_noise_percent == pytest.approx(0.61, abs=0.05)


@pytest.mark.parametrize("kind", ["sine", "random"])
def test_check_says_the_noise_that_discover_says(kind: str) -> None:
    record = _record(1.3, noise=5.0, friction=60.0)
    if kind == "random":
        rng = np.random.default_rng(3)
        w, p = 2 * np.pi * rng.uniform(0.5, 6.0, 40), rng.uniform(0.0, 6.0, 40)
        angle = np.outer(w, record.time) + p[:, None]
        x = 0.001 * np.sin(angle).sum(axis=0)
        v = 0.001 * (w[:, None] * np.cos(angle)).sum(axis=0)
        force = 2000.0 * v + 4e4 * x + 3.0 * rng.standard_normal(x.size)
        record = Record("random.csv", record.time, force, x)
    said = check_campaign(Campaign("c", (record,))).records[0].force_noise_percent
    chosen = StudyOptions(terms=("inertia", "viscous-damping", "stiffness"))
    study = run_study(Campaign("c", (record,)), chosen)
    assert study.bands[0].noise_percent == pytest.approx(said, rel=1e-12)

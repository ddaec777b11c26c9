"""Kinds of record, found from motions whose kind is known."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from discover.motion_fit import observe
from discover.record_checks import check_record
from discover.record_kind import RecordKind, classify
from discover.records import Record
from models.checks import InputError

T = np.arange(20000) / 2000.0
TURN = 2.0 * np.pi
REAL = Path(__file__).resolve().parents[3] / "shared" / "real-data"


def _kind(x: np.ndarray, *, force: np.ndarray | None = None, t: np.ndarray = T) -> RecordKind:
    return classify(Record("run.csv", t.copy(), np.sin(t) if force is None else force, x))


def _noise(size: float, seed: int = 0) -> np.ndarray:
    return size * np.random.default_rng(seed).standard_normal(T.size)


@pytest.mark.parametrize("noise", [0.0, 1e-5, 4e-3])
@pytest.mark.parametrize("frequency", [0.17, 0.53, 3.1, 15.0])
def test_sine_keeps_every_sample(frequency: float, noise: float) -> None:
    kind = _kind(0.02 * np.sin(TURN * frequency * T) + _noise(noise))
    assert kind.kind == "sine"
    assert kind.usable == slice(0, T.size)
    assert kind.frequency == pytest.approx(frequency, abs=0.002)
    assert kind.amplitude == pytest.approx(0.02, rel=0.02)
    assert kind.cycles == pytest.approx(frequency * T[-1], rel=0.01)


def test_actuator_distortion_hum_and_drift_are_still_a_sine() -> None:
    x = 0.005 * np.sin(TURN * 0.5 * T) + 1e-4 * np.sin(TURN * 1.5 * T + 1.0)
    kind = _kind(x + 1e-5 * np.sin(TURN * 50.0 * T) + 2e-4 * T + _noise(2e-5))
    assert kind.kind == "sine"
    assert kind.amplitude == pytest.approx(0.005, rel=1e-3)
    assert abs(kind.sine.coefficients[3]) == pytest.approx(1e-4, rel=0.02)


def test_start_up_and_run_down_are_cut_off() -> None:
    envelope = np.clip(T / 2.0, 0.0, 1.0) * np.clip(10.0 - T, 0.0, 1.0)
    kind = _kind(0.02 * envelope * np.sin(TURN * 3.1 * T) + _noise(1e-5))
    first, last = T[kind.usable.start], T[kind.usable.stop - 1]
    assert kind.kind == "sine"
    assert 1.85 < first < 2.5
    assert 8.5 < last < 9.1
    assert kind.starts_at_rest
    assert kind.amplitude == pytest.approx(0.02, rel=2e-3)


def test_rest_before_and_after_a_sine_is_cut_off() -> None:
    x = np.where((T > 2.0) & (T < 8.0), 0.02 * np.sin(TURN * 3.0 * T), 0.0)
    kind = _kind(x + _noise(1e-5))
    assert kind.kind == "sine"
    assert 2.0 <= T[kind.usable.start] < 2.5
    assert 7.5 < T[kind.usable.stop - 1] <= 8.0
    assert kind.starts_at_rest


@pytest.mark.parametrize(
    "x",
    [
        np.where(T < 5.0, np.sin(TURN * 3.0 * T), np.sin(TURN * 5.0 * T)),
        np.where(T < 5.0, np.sin(TURN * 3.0 * T), 0.5 * np.sin(TURN * 3.0 * T)),
        np.sin(TURN * (0.5 + 0.1 * T) * T),
        np.sin(TURN * (3.0 + 0.01 * T) * T),
        np.cumsum(_noise(1.0)),
        sum(np.cos(TURN * k * T * 2000.0 / 4000.4 + k * k) for k in range(3, 20)),
    ],
    ids=["two-frequencies", "two-amplitudes", "sweep", "slow-sweep", "random", "period-off-grid"],
)
def test_everything_else_is_a_trajectory(x: np.ndarray) -> None:
    kind = _kind(x)
    assert (kind.kind, kind.period, kind.sine) == ("trajectory", None, None)
    assert kind.usable == slice(0, T.size)


@pytest.mark.parametrize("noise", [0.0, 1e-2])
def test_multisine_repeats_in_whole_periods(noise: float) -> None:
    one = sum(np.cos(TURN * k * np.arange(4000) / 4000 + k * k) for k in range(3, 20))
    kind = _kind(np.tile(one, 6)[1500 : 1500 + T.size] + _noise(noise))
    assert (kind.kind, kind.cycles) == ("periodic", 5.0)
    assert kind.period == pytest.approx(2.0, rel=1e-9)
    assert kind.usable == slice(0, 20000)


@pytest.mark.parametrize(
    ("periods", "kind"), [(2, "trajectory"), (3, "trajectory"), (4, "periodic")]
)
def test_every_verb_takes_a_few_periods_for_a_trajectory(periods: int, kind: str) -> None:
    one = sum(np.cos(TURN * k * np.arange(4000) / 4000 + k * k) for k in range(3, 20))
    x = np.tile(one, periods + 1)[: periods * 4000 + 1000]
    time = np.arange(x.size) / 2000.0
    record = Record("run.csv", time, np.roll(x, 7) + 0.01 * np.sin(time**2), x)
    found, seen = classify(record), observe(record)
    assert (found.kind, seen.kind, check_record(seen).to_dict()["kind"]) == (kind, kind, kind)
    assert found.usable.stop - found.usable.start == 4000 * periods
    assert (found.period is None) == (kind == "trajectory")


def test_transient_before_a_multisine_is_left_out() -> None:
    one = sum(np.cos(TURN * k * np.arange(4000) / 4000 + k * k) for k in range(3, 20))
    kind = _kind(np.tile(one, 5) + 10.0 * np.exp(-2.0 * T) * np.sin(20.0 * T))
    assert kind.kind == "periodic"
    assert kind.usable.start in (4000, 8000)
    assert kind.usable.stop == T.size


def test_multisine_that_changes_does_not_repeat() -> None:
    rng = np.random.default_rng(1)
    parts = [
        sum(
            np.cos(TURN * k * np.arange(4000) / 4000 + rng.uniform(0.0, TURN)) for k in range(3, 20)
        )
        for _ in range(5)
    ]
    assert _kind(np.concatenate(parts)).kind == "trajectory"


def test_triangle_wave_is_periodic_for_its_speed_is_no_sine() -> None:
    kind = _kind(np.abs((2.0 * T) % 2.0 - 1.0))
    assert kind.kind == "periodic"
    assert kind.frequency == pytest.approx(1.0)


def test_from_rest_needs_motion_and_force_at_rest() -> None:
    x = 0.02 * (1.0 - np.cos(TURN * 0.6 * T)) * np.exp(-T / 3.0)
    loaded = _kind(x, force=np.cos(T))
    assert _kind(x, force=np.sin(T)).kind == "transient"
    assert (loaded.kind, loaded.starts_at_rest) == ("trajectory", True)
    assert not _kind(np.roll(x, -700)).starts_at_rest


def test_noise_that_hides_the_start_is_not_called_rest() -> None:
    x = 0.02 * (1.0 - np.cos(TURN * 0.6 * T)) * np.exp(-T / 3.0)
    assert _kind(x + _noise(5e-6)).starts_at_rest
    assert not _kind(x + _noise(5e-3)).starts_at_rest


def test_force_curve_without_displacement_is_a_sine_of_its_label() -> None:
    t = np.sort(np.random.default_rng(0).uniform(0.0, 4.0, 60))
    kind = classify(Record("fig2.csv", t, np.sin(t), frequency=0.5, amplitude=0.02, uniform=False))
    assert (kind.kind, kind.sine, kind.amplitude) == ("sine", None, None)
    assert kind.cycles == pytest.approx((t[-1] - t[0]) * 0.5)
    with pytest.raises(InputError, match=r"fig2.csv: frequency must be given where displacement"):
        classify(Record("fig2.csv", t, np.sin(t), uniform=False))


def test_standing_still_is_an_error() -> None:
    with pytest.raises(InputError, match=r"run.csv: displacement must be varying, got a constant"):
        _kind(np.full(T.size, 0.01))


@pytest.mark.parametrize("scale", [1e-6, 1e3])
def test_kind_does_not_depend_on_unit_offset_or_direction(scale: float) -> None:
    x = 0.02 * np.sin(TURN * 3.1 * T) * np.clip(T / 2.0, 0.0, 1.0) + _noise(1e-5)
    plain, other = _kind(x), _kind(-scale * (x + 3.0))
    assert (plain.kind, plain.usable) == (other.kind, other.usable)
    assert plain.to_dict()["frequency_hz"] == pytest.approx(other.to_dict()["frequency_hz"])


@pytest.mark.parametrize(
    ("file", "kind"),
    [
        ("emps/trajectory.csv", "trajectory"),  # its 6.24 s cycle repeats, but three times only
        ("silverbox/multisine.csv", "trajectory"),  # ten different realisations
        ("silverbox/arrow.csv", "trajectory"),
    ],
)
def test_measured_records(file: str, kind: str) -> None:
    if not (REAL / file).is_file():
        pytest.skip(f"{REAL} is not beside the checkout")
    t, x, force = np.loadtxt(REAL / file, delimiter=",", skiprows=1).T
    found = classify(Record(file, t.copy(), force.copy(), x.copy()))
    assert found.kind == kind
    assert not found.starts_at_rest

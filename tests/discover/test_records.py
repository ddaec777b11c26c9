"""Records in memory: what they refuse, and their times."""

from dataclasses import replace

import numpy as np
import pytest

from discover.gap import close_gap
from discover.motion_fit import observe
from discover.records import Campaign, Record
from models.checks import InputError
from tests.discover.gap_data import PLAN, device

MODEL = "fit:inertia,viscous-damping,coulomb-friction"


def jittered(frequency, amplitude, seed):
    """Return a sine test whose steps differ by a sixth, with friction that jumps."""
    rng = np.random.default_rng(seed)
    step = 1.0 / (100.0 * frequency)
    time = (np.arange(800) + rng.uniform(-0.25, 0.25, 800)) * step
    omega = 2.0 * np.pi * frequency
    x = amplitude * np.sin(omega * time)
    v, a = amplitude * omega * np.cos(omega * time), -(omega**2) * x
    force = device(time, x, v, a) + 60.0 * np.tanh(v / 1e-3)
    force += 0.01 * np.std(force) * rng.standard_normal(time.size)
    return Record(f"{frequency:g}-{amplitude:g}.csv", time, force, x)


def test_jitter_is_no_missing_effect():
    records = tuple(jittered(f, a, k) for k, (f, a) in enumerate(PLAN))
    found = close_gap(Campaign("jitter", records), MODEL)
    assert found.verdict == "agrees"
    assert found.gap_percent == pytest.approx(1.0, abs=0.1)
    resampled = close_gap(Campaign("splines", tuple(r.even for r in records)), MODEL)
    assert resampled.gap_percent > 1.5 * found.gap_percent


def test_an_even_record_is_itself():
    time = np.arange(100) / 50.0
    x = np.sin(time)
    record = Record("r.csv", time, x.copy(), x, temperature=300.0 + time, inputs={"u": x.copy()})
    assert record.even is record
    moved = record.sampled(time + 1e-3 * np.sin(9.0 * time), {
        "force": x, "displacement": x, "temperature": record.temperature, "u": x
    })  # fmt: skip
    even = moved.even
    assert even is not moved
    assert even is moved.even
    assert (even.velocity, sorted(even.inputs)) == (None, ["u"])
    assert np.ptp(np.diff(even.time)) < 1e-12


@pytest.mark.parametrize("clock", [-3600.0, 0.9 * 86_400.0, 1_795_823_998.0])
def test_times_of_a_clock_tell_the_same_as_times_from_zero(clock):
    rng = np.random.default_rng(1)
    time = np.arange(3000) / 1000.0
    x = 2e-3 * np.sin(9.0 * time)
    force = 900.0 * 9.0 * 2e-3 * np.cos(9.0 * time) + 0.05 * rng.standard_normal(3000)
    from_zero = observe(Record("zero.csv", time, force, x))
    by_clock = observe(Record("clock.csv", time + clock, force, x))
    assert by_clock.frequency == pytest.approx(from_zero.frequency, rel=1e-7)
    assert by_clock.time[0] == (0.0 if clock > 0.0 else clock)
    since = by_clock.time - by_clock.time[0]
    np.testing.assert_allclose(since, from_zero.time, atol=3e-7)
    lines, expected = by_clock.windows[0].force, from_zero.windows[0].force
    np.testing.assert_allclose(lines, expected, atol=1e-5 * np.abs(expected).max())
    powers = [o.windows[0].noise_power for o in (by_clock, from_zero)]
    assert powers[0] == pytest.approx(powers[1], rel=1e-2)


def test_times_that_start_near_zero_stay():
    time = 2.0 + np.arange(300) / 100.0
    x = np.sin(9.0 * time)
    np.testing.assert_array_equal(Record("r.csv", time, x.copy(), x).time, time)


@pytest.mark.parametrize("time", [np.r_[0.0, np.arange(99.0)], np.arange(100.0)[::-1]])
def test_times_that_do_not_rise_are_refused(time):
    x = np.sin(0.3 * np.arange(100.0))
    with pytest.raises(InputError, match=r"r\.csv: time must be rising"):
        Record("r.csv", time, x.copy(), x)


def test_a_sine_test_may_lack_samples_and_nothing_else_may():
    """One sample in fourteen is lost, at random: the motion is known between them."""
    rng = np.random.default_rng(3)
    time = np.arange(2000) / 1000.0
    kept = rng.random(2000) > 0.07
    for motion, name in ((np.sin(62.83 * time), "sine"), (np.sin(9.0 * time**2), "sweep")):
        x = 3e-3 * motion + 1e-7 * rng.standard_normal(2000)
        record = Record(f"{name}.csv", time[kept], x[kept] * 1e4, x[kept])
        assert record.gaps > 50
        if name == "sine":
            seen = observe(record)
            assert seen.kind == "sine"
            assert seen.frequency == pytest.approx(62.83 / 2.0 / np.pi, rel=1e-5)
            assert seen.usable == slice(0, int(kept.sum()))
        else:
            with pytest.raises(InputError, match=r"sweep\.csv: time must be without gaps"):
                observe(record)


def test_a_digitised_curve_is_left_as_it_is():
    time = np.delete(np.arange(101.0), 50)
    curve = Record("r.csv", time, np.sin(time), frequency=1.0, amplitude=0.01, uniform=False)
    assert curve.even is curve
    assert curve.gaps == 0


def test_what_is_found_in_a_record_is_asked_for_once():
    time = np.arange(8.0)
    record, asked = Record("r", time, time.copy()), []

    def last(one):
        asked.append(one.file)
        return float(one.force[-1])

    assert (record.once(last), record.once(last), asked) == (7.0, 7.0, ["r"])
    other = replace(record, force=np.zeros(8))
    assert (other.once(last), asked) == (0.0, ["r", "r"])

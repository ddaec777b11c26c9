import numpy as np
import pytest

from discover.motion_fit import observe_all
from discover.record_curves import shown_samples
from discover.records import Record


def observed(displacement, force, time):
    (observation,) = observe_all([Record("a.csv", time, force, displacement)], 1)
    return observation


def test_a_sine_test_shows_two_cycles():
    time = np.arange(4000) / 500.0
    x = 0.01 * np.sin(2.0 * np.pi * 2.0 * time)
    noise = np.random.default_rng(0).standard_normal(time.size)
    observation = observed(x, 1e5 * x + noise, time)
    shown = observation.time[shown_samples(observation)]
    assert np.ptp(shown) == pytest.approx(1.0, rel=0.01)
    assert shown.size <= 600


def test_a_random_record_shows_stretches_at_its_own_sampling_its_greatest_force_among_them():
    time = np.arange(20_000) / 500.0
    rng = np.random.default_rng(1)
    tones = rng.uniform(0.5, 5.0, 60), rng.uniform(0.0, 2.0 * np.pi, 60)
    x = sum(np.sin(2.0 * np.pi * f * time + p) for f, p in zip(*tones, strict=True)) * 1e-3
    force = 1e5 * x + rng.standard_normal(time.size)
    observation = observed(x, force, time)
    shown = shown_samples(observation)
    steps = np.diff(observation.time[shown])
    assert 1 <= np.sum(steps > 1.0) <= 2
    peak = np.argmax(np.abs(observation.measured))
    assert np.min(np.abs(shown - peak)) <= 10
    assert np.sum(steps[steps < 1.0]) < 0.5 * np.ptp(observation.time)
    assert shown.size <= 600


def test_a_sweep_shows_as_many_turns_where_it_is_slow_as_where_it_is_fast():
    time = np.arange(20_000) / 500.0
    turns = 0.3 * 40.0 / np.log(20.0) * (np.exp(time / 40.0 * np.log(20.0)) - 1.0)
    loudest = 1.0 + 0.5 * np.exp(-(((time - 20.0) / 3.0) ** 2))
    x = 0.01 * loudest * np.sin(2.0 * np.pi * turns)
    observation = observed(x, 1e5 * x + np.random.default_rng(2).standard_normal(time.size), time)
    shown = shown_samples(observation)
    cuts = np.flatnonzero(np.diff(observation.time[shown]) > 1.0) + 1
    seen = [np.ptp(turns[part]) for part in np.split(shown, cuts)]
    assert len(seen) == 3
    assert max(seen) < 2.5 * min(seen)


def test_a_record_that_rests_for_long_is_shown():
    """Steps and holds of an encoder: for whole windows nothing moves at all."""
    time = np.arange(20_000) / 500.0
    out, back = (np.clip(20.0 * (time - at), 0.0, 1.0) for at in (2.0, 37.0))
    x = 2.0**-7 * (out - back)
    force = 1e5 * x + np.random.default_rng(3).standard_normal(time.size)
    shown = shown_samples(observed(x, force, time))
    assert np.all(np.diff(shown) > 0)
    assert 100 < shown.size <= 600

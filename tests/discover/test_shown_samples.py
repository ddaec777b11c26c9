import numpy as np
import pytest

from discover.motion_fit import observe_all
from discover.records import Record
from discover.shown_samples import shown_samples


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


def test_a_random_record_shows_the_stretch_about_its_greatest_force_at_its_own_sampling():
    time = np.arange(20_000) / 500.0
    rng = np.random.default_rng(1)
    tones = rng.uniform(0.5, 5.0, 60), rng.uniform(0.0, 2.0 * np.pi, 60)
    x = sum(np.sin(2.0 * np.pi * f * time + p) for f, p in zip(*tones, strict=True)) * 1e-3
    force = 1e5 * x + rng.standard_normal(time.size)
    observation = observed(x, force, time)
    shown = observation.time[shown_samples(observation)]
    peak = observation.time[np.argmax(np.abs(observation.measured))]
    assert shown[0] <= peak <= shown[-1]
    assert np.ptp(shown) < 0.5 * np.ptp(observation.time)
    assert shown.size <= 600

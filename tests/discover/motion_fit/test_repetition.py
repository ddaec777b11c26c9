"""What cycles differ by, where it is taken apart from what changes slowly."""

import numpy as np
import pytest
from scipy.signal import lfilter

from discover.motion_fit.noise_spectrum import noise_spectrum
from discover.motion_fit.repetition import unrepeated

RATE = 300.0


def slow_noise(seed, size):
    """Return noise of mean square one, most of it within a few harmonics of 1 Hz."""
    pole = np.exp(-2.0 * np.pi * 3.0 / RATE)
    drawn = np.random.default_rng(seed).standard_normal(size + 2000)
    return lfilter([np.sqrt(1.0 - pole**2)], [1.0, -pole], drawn)[2000:]


def device(time):
    angle = 2.0 * np.pi * time
    return 60.0 * np.cos(angle) + 30.0 * np.tanh(np.cos(angle) / 0.02)


@pytest.mark.parametrize("cycles", [3, 4, 6, 12])
def test_slow_noise_of_few_cycles_is_not_taken_for_change(cycles):
    """Of three cycles slow changes of five harmonics span nearly all that lies between them."""
    time = np.arange(cycles * round(RATE)) / RATE
    ratios = []
    for seed in range(16):
        noise = slow_noise(seed, time.size)
        found = noise_spectrum(time, device(time) + noise, 1.0, 1.0 / RATE)
        ratios.append(found.power / np.mean(noise**2))
    assert 0.5 < np.median(ratios) < 2.0


def test_a_size_that_changes_is_no_noise():
    time = np.arange(12 * round(RATE)) / RATE
    noise = 0.1 * np.random.default_rng(0).standard_normal(time.size)
    steady = unrepeated(time, device(time) + noise, 1.0, 1.0 / RATE)
    warming = unrepeated(time, (1.0 + 0.02 * time) * device(time) + noise, 1.0, 1.0 / RATE)
    assert np.mean(warming.density) == pytest.approx(np.mean(steady.density), rel=0.3)


@pytest.mark.parametrize("seed", range(4))
def test_impacts_that_differ_from_cycle_to_cycle_are_left_out_of_the_noise(seed):
    """At 400 times the noise, they would make it a hundred times as loud."""
    rng = np.random.default_rng(seed)
    time = np.arange(528) / 128.0
    noise = 1e-3 * rng.standard_normal(time.size)
    hit = np.abs(np.mod(0.97 * time, 1.0) - 0.5) < 0.03
    impacts = np.where(hit, 5.0 + 0.4 * rng.standard_normal(time.size), 0.0)
    found = unrepeated(time, impacts + noise, 0.97, 1.0 / 128.0)
    deviation = np.sqrt(np.mean(found.density) * 64.0)
    assert deviation == pytest.approx(1e-3, rel=0.25)

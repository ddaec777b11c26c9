"""What cycles differ by, where it is taken apart from what changes slowly."""

import numpy as np
import pytest
from scipy.signal import lfilter
from scipy.sparse import csr_array, eye_array

from discover.motion_fit.noise_spectrum import noise_spectrum
from discover.motion_fit.repetition import _changes, _without, unrepeated

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
        found = noise_spectrum(time, device(time) + noise, 1.0, 1.0 / RATE, 2.0 * np.pi * time)
        ratios.append(found.power / np.mean(noise**2))
    assert 0.5 < np.median(ratios) < 2.0


def test_a_size_that_changes_is_no_noise():
    time = np.arange(12 * round(RATE)) / RATE
    noise = 0.1 * np.random.default_rng(0).standard_normal(time.size)
    steady = unrepeated(time, device(time) + noise, 1.0, 1.0 / RATE)
    warming = unrepeated(time, (1.0 + 0.02 * time) * device(time) + noise, 1.0, 1.0 / RATE)
    assert np.mean(warming.density) == pytest.approx(np.mean(steady.density), rel=0.3)


def test_samples_that_are_left_out_do_not_run_away():
    """What repeats may lie in them alone: nothing kept then says how it changes."""
    rng = np.random.default_rng(0)
    time = np.arange(528) / 128.0
    phase = np.mod(0.97 * time, 1.0)
    kept = np.abs(phase - 0.5) > 0.03
    repeated = np.where(kept, 1e-7 * rng.standard_normal(528), 5.0)
    left = 0.4 * rng.standard_normal(528)
    nothing = csr_array(0.0 * eye_array(528))
    changes = _changes(nothing, time, repeated, 0.97, 4.0)
    found = _without(left, changes, kept)
    np.testing.assert_array_equal(found[~kept], left[~kept])
    assert np.abs(found).max() <= 1.5 * np.abs(left).max()
    assert np.std(found[kept]) < np.std(left[kept])

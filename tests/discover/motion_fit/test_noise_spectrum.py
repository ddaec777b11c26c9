"""The noise of sine tests against processes of known power, beside a force that jumps."""

import numpy as np
import pytest
from scipy.signal import lfilter

from discover.motion_fit.noise_spectrum import noise_spectrum
from discover.motion_fit.repetition import unrepeated

SEEDS = 12


def white(rng, size):
    return rng.standard_normal(size)


def coloured(rng, size):
    drawn = lfilter([1.0], [1.0, -0.8], rng.standard_normal(size + 200))[200:]
    return drawn * np.sqrt(1.0 - 0.64)


def resonant(rng, size):
    poles = np.convolve([1.0, -0.95 * np.exp(0.5j)], [1.0, -0.95 * np.exp(-0.5j)]).real
    impulse = lfilter([1.0], poles, np.eye(1, 4000)[0])
    drawn = lfilter([1.0], poles, rng.standard_normal(size + 400))[400:]
    return drawn / np.sqrt(np.sum(impulse**2))


def jumping(angle):
    """Return friction, and impacts a hundredth of a cycle long: a hundred harmonics and more."""
    since = np.mod(angle - 1.0, 2.0 * np.pi)
    rings = np.exp(-since / 0.06) * np.sin(since / 0.02)
    return 20.0 * np.sin(angle) + 30.0 * np.sign(np.cos(angle)) + 40.0 * rings


def measured(make, *, seed, frequency=1.0, rate=200.0, cycles=8.0, noise=1.0, missing=False):
    time = np.arange(round(cycles * rate / frequency)) / rate
    drawn = noise * make(np.random.default_rng(seed), time.size)
    if missing:
        kept = np.abs(np.cos(2.0 * np.pi * frequency * time)) > 3e-3
        time, drawn = time[kept], drawn[kept]
    angle = 2.0 * np.pi * frequency * time + 0.01
    return time, jumping(angle) + drawn, 1.0 / rate


def power(make, **test):
    found = []
    for seed in range(SEEDS):
        time, force, step = measured(make, seed=seed, **test)
        frequency = test.get("frequency", 1.0)
        found.append(noise_spectrum(time, force, frequency, step).power)
    return float(np.mean(found))


@pytest.mark.parametrize("make", [white, coloured, resonant])
@pytest.mark.parametrize(
    "test",
    [
        {"cycles": 8.0},
        {"cycles": 8.4, "frequency": 1.37},
        {"cycles": 4.0, "frequency": 0.731},
        {"cycles": 30.0, "frequency": 3.1},
        {"cycles": 6.0, "missing": True},
    ],
    ids=["in step", "out of step", "four cycles", "coarse", "reversals left out"],
)
def test_jumps_and_impacts_are_no_noise(make, test):
    """Their harmonics fold back between the lines: more than ten times the noise's power."""
    assert power(make, **test) == pytest.approx(1.0, rel=0.35)


def test_the_density_follows_the_colour():
    lines = np.array([5.0, 20.0, 60.0])
    transfer = 1.0 / (1.0 - 0.8 * np.exp(-2j * np.pi * lines / 200.0))
    expected = 2.0 / 200.0 * (1.0 - 0.64) * np.abs(transfer) ** 2
    found = []
    for seed in range(SEEDS):
        time, force, step = measured(coloured, seed=seed, cycles=20.3)
        found.append(noise_spectrum(time, force, 1.0, step).at(lines))
    np.testing.assert_allclose(np.mean(found, axis=0), expected, rtol=0.25)


def test_hum_is_power_but_not_density():
    quiet, hum = [], []
    for seed in range(SEEDS):
        time, force, step = measured(white, seed=seed, frequency=1.37, cycles=20.0)
        quiet.append(noise_spectrum(time, force, 1.37, step))
        force = force + np.sqrt(2.0) * np.sin(2.0 * np.pi * 50.0 * time)
        hum.append(noise_spectrum(time, force, 1.37, step))
    more = np.mean([h.power - q.power for h, q in zip(hum, quiet, strict=True)])
    assert more == pytest.approx(1.0, rel=0.25)
    at = np.array([50.0])
    ratios = [h.at(at) / q.at(at) for h, q in zip(hum, quiet, strict=True)]
    # what other cycles measured at the same phase carries a hum of any other phase
    assert np.median(ratios) == pytest.approx(1.0, rel=0.4)


def test_a_drift_is_no_noise():
    time, force, step = measured(white, seed=0, cycles=12.0)
    still = noise_spectrum(time, force, 1.0, step).power
    drifting = noise_spectrum(time, force + 5.0 * time / time[-1], 1.0, step).power
    assert drifting == pytest.approx(still, rel=0.05)


def test_what_changes_between_cycles_is_noise():
    rng = np.random.default_rng(5)
    time = np.arange(4000) / 200.0
    size = 1.0 + 0.1 * rng.standard_normal(21)[np.floor(time).astype(int)]
    force = jumping(2.0 * np.pi * time)
    found = noise_spectrum(time, size * force, 1.0, 0.005).power
    assert found == pytest.approx(np.mean(((size - size.mean()) * force) ** 2), rel=0.5)


@pytest.mark.parametrize("cycles", [1.6, 1.85, 2.05, 2.4, 3.3])
@pytest.mark.parametrize("frequency", [0.713, 2.3])
def test_a_few_cycles_tell_the_noise(cycles, frequency):
    """Wherever the samples of one cycle lie between those of the next."""
    assert power(white, cycles=cycles, frequency=frequency) == pytest.approx(1.0, rel=0.25)


def test_with_less_than_one_and_a_half_cycles_there_is_nothing_to_compare():
    time, force, step = measured(white, seed=0, cycles=1.4)
    assert unrepeated(time, force, 1.0, step) is None
    assert np.isfinite(noise_spectrum(time, force, 1.0, step).power)


def test_a_force_that_repeats_exactly_has_no_noise():
    time, force, step = measured(white, seed=0, noise=0.0)
    assert noise_spectrum(time, force, 1.0, step).power < 1e-16 * np.mean(force**2)


@pytest.mark.parametrize("samples", [4, 5, 7, 12, 20])
@pytest.mark.parametrize("cycles", [2.5, 3.0, 6.3])
def test_coarse_records_have_a_noise_too(samples, cycles):
    time = np.arange(int(samples * cycles)) / samples
    force = 20.0 * np.cos(2.0 * np.pi * time) + white(np.random.default_rng(1), time.size)
    found = noise_spectrum(time, force, 1.0, 1.0 / samples)
    assert 0.0 < found.power < 30.0
    assert np.all(np.isfinite(found.at(np.array([0.1, 1.0, 2.0]))))


def test_a_long_record_s_first_part_is_enough():
    time, force, step = measured(white, seed=0, cycles=1000.0)
    assert noise_spectrum(time, force, 1.0, step).power == pytest.approx(1.0, rel=0.1)


def test_inputs_stay_as_they_are():
    time, force, step = measured(white, seed=0)
    for array in (time, force):
        array.setflags(write=False)
    noise_spectrum(time, force, 1.0, step)

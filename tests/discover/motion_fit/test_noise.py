"""Noise between harmonics against processes of known density."""

import numpy as np
import pytest
from scipy.signal import lfilter

from discover.motion_fit.noise import density_between_lines, power_density

STEP = 1.0 / 200.0
FREQUENCY = 1.0
LINES = np.arange(1.0, 32.0)


def mean_density(make, *, seeds=40, size=6000, frequency=FREQUENCY, lines=LINES):
    found = [
        density_between_lines(make(np.random.default_rng(s), size), STEP, frequency, lines)
        for s in range(seeds)
    ]
    return np.mean(found, axis=0), np.std(found, axis=0) / np.sqrt(seeds)


def test_power_density_of_white_noise_and_of_a_sine():
    rng = np.random.default_rng(0)
    noise = 3.0 * rng.standard_normal(20_000)
    frequencies, density = power_density(noise, STEP)
    assert density.mean() == pytest.approx(2.0 * 9.0 * STEP, rel=0.03)
    tone = np.sqrt(2.0) * np.sin(2.0 * np.pi * 10.0 * STEP * np.arange(20_000))
    _, line = power_density(tone, STEP)
    # the one-sided density integrates to the mean square
    assert line.sum() * frequencies[1] == pytest.approx(1.0, rel=1e-3)


def test_white_noise_has_its_density_at_every_line():
    mean, error = mean_density(lambda rng, n: 2.0 * rng.standard_normal(n))
    expected = 2.0 * 4.0 * STEP
    # a share of doubt is added on purpose: a few per cent, never less than the truth
    assert np.all(mean > expected * (1.0 - 4.0 * error / mean))
    assert mean.mean() == pytest.approx(1.04 * expected, rel=0.05)


@pytest.mark.parametrize("memory", [0.7, 0.95])
def test_coloured_noise_has_its_density_at_every_line(memory):
    def make(rng, n):
        return lfilter([1.0], [1.0, -memory], rng.standard_normal(n + 1000))[1000:]

    lines = np.arange(4.0, 32.0)
    mean, _ = mean_density(make, lines=lines)
    transfer = 1.0 / (1.0 - memory * np.exp(-2j * np.pi * lines * STEP))
    expected = 2.0 * STEP * np.abs(transfer) ** 2
    assert np.mean(mean / expected) == pytest.approx(1.04, abs=0.08)
    assert np.all((mean / expected > 0.8) & (mean / expected < 1.4))


def test_mains_hum_is_no_noise():
    rng = np.random.default_rng(1)
    time = STEP * np.arange(6000)
    noise = rng.standard_normal(6000)
    hum = 30.0 * np.sin(2.0 * np.pi * 50.3 * time)
    lines = np.arange(30.0, 70.0, 5.0)
    quiet = density_between_lines(noise, STEP, FREQUENCY, lines)
    found = density_between_lines(noise + hum, STEP, FREQUENCY, lines)
    np.testing.assert_allclose(found, quiet, rtol=0.25)


def test_harmonics_of_friction_beyond_half_the_rate_are_no_noise():
    """At 200 samples/s and 1.37 Hz, odd harmonics above the 73rd fold between the lines."""
    rng = np.random.default_rng(2)
    time = STEP * np.arange(8000)
    noise = 0.05 * rng.standard_normal(8000)
    square = np.sign(np.cos(2.0 * np.pi * 1.37 * time + 0.1))
    orders = np.arange(1, 72)
    design = np.exp(2j * np.pi * 1.37 * np.outer(time, orders))
    design = np.column_stack((np.ones(time.size), design.real, design.imag))
    square = square - design @ np.linalg.lstsq(design, square, rcond=None)[0]
    lines = 1.37 * np.arange(1.0, 32.0)
    found = density_between_lines(noise + square, STEP, 1.37, lines)
    expected = 2.0 * 0.05**2 * STEP
    assert np.median(found) == pytest.approx(expected, rel=0.2)
    # the mean over all bins is three times the truth
    assert np.mean((noise + square) ** 2) * 2.0 * STEP > 2.5 * expected


def test_lines_themselves_are_left_out():
    rng = np.random.default_rng(3)
    time = STEP * np.arange(6000)
    noise = rng.standard_normal(6000)
    lines = sum(50.0 * np.sin(2.0 * np.pi * k * time) for k in range(1, 60))
    quiet = density_between_lines(noise, STEP, FREQUENCY, LINES)
    found = density_between_lines(noise + lines, STEP, FREQUENCY, LINES)
    np.testing.assert_allclose(found, quiet, rtol=0.1)


@pytest.mark.parametrize("cycles", [2, 3])
def test_with_few_cycles_the_fit_s_own_share_is_made_up_for(cycles):
    """Least squares on harmonics takes one of every few degrees of freedom of the noise."""
    size = round(cycles / FREQUENCY / STEP)
    time = STEP * np.arange(size)
    orders = np.arange(1, 32)
    wave = np.exp(2j * np.pi * FREQUENCY * np.outer(time, orders))
    basis = np.linalg.qr(np.column_stack((np.ones(size), wave.real, wave.imag)))[0]

    def make(rng, n):
        noise = rng.standard_normal(n)
        return noise - basis @ (basis.T @ noise)

    mean, _ = mean_density(make, seeds=200, size=size, lines=np.arange(5.0, 25.0, 4.0))
    assert mean.mean() == pytest.approx(2.0 * STEP, rel=0.35)

"""The Caputo derivative over all orders, starts and rates of sampling, against mpmath."""

import math

import numpy as np
import pytest

from models.fractional import derivative, fractional_derivative
from tests.models.fractional import oracles

OMEGA = 2.0 * np.pi
ORDERS = (0.05, 0.2, 0.5, 0.7, 0.95, 1.0, 1.05, 1.3, 1.5, 1.8, 1.95)
# Phases of a sine: at rest in the middle, all of position, velocity, acceleration, at an end.
PHASES = (0.0, 0.7, np.pi / 2)


def instants(count):
    """Return indices that crowd at the start, where errors of a start are largest."""
    near = np.arange(1, 12)
    growing = np.geomspace(12, count - 1, 30).astype(int)
    even = np.linspace(12, count - 1, 40).astype(int)
    return np.unique(np.concatenate([near, growing, even]))


def errors(found, exact):
    """Return the rms and the largest error, over the rms of the exact derivative."""
    size = np.sqrt(np.mean(exact**2))
    apart = np.abs(found - exact)
    return np.sqrt(np.mean(apart**2)) / size, np.max(apart) / size


@pytest.mark.parametrize("phase", [0.0, 0.7])
@pytest.mark.parametrize("order", [0.3, 1.0, 1.7])
def test_oracles_agree(phase, order):
    # Kummer's function and the power series: nothing in common but the definition.
    t = np.array([1e-4, 0.03, 0.5, 1.1, 4.0])
    series = oracles.sine_by_series(order, OMEGA, phase, t)
    kummer = oracles.sine(order, OMEGA, phase, t, caputo=True)
    np.testing.assert_allclose(series, kummer, rtol=1e-13)


@pytest.mark.parametrize("phase", PHASES)
@pytest.mark.parametrize("order", ORDERS)
def test_four_cycles_from_any_start(order, phase):
    count = 100_000
    t = 4.0 / count * np.arange(count)
    chosen = instants(count)
    exact = oracles.sine(order, OMEGA, phase, t[chosen], caputo=True)
    found = derivative(np.sin(OMEGA * t + phase), order, 4.0 / count)[chosen]
    typical, largest = errors(found, exact)
    assert typical < 2e-9
    assert largest < 1e-8


@pytest.mark.parametrize("count", [2_000, 20_000, 1_000_000])
@pytest.mark.parametrize("order", [0.05, 0.7, 1.05, 1.5, 1.95])
def test_error_does_not_grow_with_the_sampling_rate(order, count):
    t = 4.0 / count * np.arange(count)
    chosen = instants(count)
    exact = oracles.sine(order, OMEGA, 0.7, t[chosen], caputo=True)
    found = derivative(np.sin(OMEGA * t + 0.7), order, 4.0 / count)[chosen]
    assert errors(found, exact)[0] < 1e-8


@pytest.mark.parametrize("order", ORDERS)
@pytest.mark.parametrize(
    "start",
    [(0, 0, 0), (1.0, 0.0, 0.0), (3.0, 0.0, 0.0), (0.0, -2.0, 0.0), (0.0, 0.0, 1.0), (3, -2, 1)],
)
def test_start_with_position_velocity_acceleration(order, start):
    # a + v t + c t^2 on top of a growing sine, that starts with none of them.
    count = 50_000
    dt = 4.0 / count
    t = dt * np.arange(count)
    chosen = instants(count)
    x = oracles.tapered("quintic", 5.0, OMEGA, t) + sum(c * t**k for k, c in enumerate(start))
    exact = oracles.tapered_derivative("quintic", 5.0, order, OMEGA, t[chosen])
    for k, c in enumerate(start):
        if k >= order:
            exact = exact + c * oracles.power(k, order, t[chosen])
    typical, largest = errors(derivative(x, order, dt)[chosen], exact)
    assert typical < 3e-9
    # Half the last digit of one sample, where nothing averages it: no operator is better.
    digit = 0.5 * np.finfo(float).eps * np.abs(x).max() / dt**order
    assert largest < max(1e-8, digit / np.sqrt(np.mean(exact**2)))


@pytest.mark.parametrize("order", [0.05, 0.7, 1.3, 1.95])
@pytest.mark.parametrize("p", [2, 3, 4])
def test_order_of_convergence_of_named_schemes(order, p):
    found = []
    for count in (500, 1000):
        t = 4.0 / count * np.arange(count)
        chosen = np.arange(1, count, count // 100)
        exact = oracles.sine(order, OMEGA, 0.7, t[chosen], caputo=True)
        values = derivative(np.sin(OMEGA * t + 0.7), order, 4.0 / count, scheme=f"bdf{p}")
        found.append(errors(values[chosen], exact)[0])
    assert math.log2(found[0] / found[1]) == pytest.approx(p, abs=0.2)


@pytest.mark.parametrize(("order", "power"), [(0.3, 1.2), (0.8, 1.2), (1.1, 2.3), (1.8, 2.3)])
@pytest.mark.parametrize("scheme", ["bdf2", "auto"])
def test_start_that_is_not_smooth(order, power, scheme):
    # No Taylor series at 0: the error there must not last.
    t = 1e-3 * np.arange(5000)
    exact = oracles.power(power, order, t[100:])
    found = derivative(1.0 + t**power, order, 1e-3, scheme=scheme)[100:]
    assert np.max(np.abs(found - exact)) < 3e-5 * np.max(exact)


@pytest.mark.parametrize("order", [0.2, 0.7, 1.3, 1.9])
@pytest.mark.parametrize("size", [1e-12, 1e-9, 1e-7])
def test_noise_is_met_by_a_longer_stride(order, size):
    # A tapered sine, 10,000 samples a cycle: neighbouring samples differ by little but noise.
    count = 100_000
    dt = 10.0 / count
    t = dt * np.arange(count)
    noise = size * np.random.default_rng(5).standard_normal(count)
    chosen = np.linspace(100, count - 1, 120).astype(int)
    x = oracles.tapered("quintic", 4.0, OMEGA, t) + noise
    exact = oracles.tapered_derivative("quintic", 4.0, order, OMEGA, t[chosen])
    result = fractional_derivative(x, order, dt)
    error = errors(result.values[chosen], exact)[0]
    plain = errors(derivative(x, order, dt, scheme="bdf2")[chosen], exact)[0]
    assert result.stride > 1
    assert error < plain
    assert 0.1 * error < result.error < 10.0 * error


@pytest.mark.parametrize("order", [0.05, 0.95, 1.05, 1.95])
def test_many_cycles_lose_no_digits(order):
    # The integral behind a derivative of low order is long: its rounding must stay small.
    count = 400_000
    t = 1e-3 * np.arange(count)
    chosen = np.linspace(count - 4000, count - 1, 30).astype(int)
    exact = oracles.sine(order, OMEGA, 0.0, t[chosen], caputo=True)
    # A period has a whole number of samples: no rounding of large arguments.
    cycle = np.sin(OMEGA * t[:1000])
    found = derivative(np.tile(cycle, count // 1000), order, 1e-3)[chosen]
    assert errors(found, exact)[1] < 1e-8


@pytest.mark.parametrize("order", [0.3, 1.0, 1.5, 1.9])
@pytest.mark.parametrize("noise", [0.0, 1e-9])
@pytest.mark.parametrize("width", [20, 200])
def test_pulse_between_the_points_of_long_strides(width, noise, order):
    # A Gaussian wave packet in a quiet record: all that moves takes less than a long stride.
    count, middle = 100_000, 50_033
    n = np.arange(count) - middle
    packet = np.exp(-((n / width) ** 2)) * np.sin(3.0 * n / width)
    rough = noise * np.random.default_rng(2).standard_normal(count)
    found = derivative(packet + rough, order, 1.0)
    # From rest the derivative from minus infinity is the same: by a padded spectrum.
    omega = 2.0 * np.pi * np.fft.rfftfreq(4 * count)
    spectrum = np.fft.rfft(packet, 4 * count) * (1j * omega) ** order
    exact = np.fft.irfft(spectrum, 4 * count)[:count]
    assert errors(found, exact)[0] < 1e-3

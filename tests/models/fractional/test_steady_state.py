"""Weyl derivatives: each harmonic turned and scaled."""

import numpy as np
import pytest

from models.fractional import (
    derivative,
    fractional_derivative,
    harmonic_factors,
    spectral_derivative,
)
from models.fractional.harmonics import fit_harmonics
from tests.models.fractional import oracles

ORDERS = (-1.0, -0.5, 0.5, 1.0, 1.5, 1.89, 2.0)


def harmonic_rule(parts, order, t):
    """Eq. 4: D^a A sin(w t + p) = A w^a sin(w t + p + a pi/2)."""
    return sum(a * w**order * np.sin(w * t + p + order * np.pi / 2) for a, w, p in parts)


def test_factors():
    omega = np.array([0.0, 2.0, -2.0])
    factors = harmonic_factors([0.0, 0.5, 1.0, 2.0, -1.0], omega)
    np.testing.assert_array_equal(factors[0], [1, 1, 1])
    np.testing.assert_allclose(factors[1], [0, 1 + 1j, 1 - 1j], atol=1e-15)
    np.testing.assert_array_equal(factors[2], [0, 2j, -2j])
    np.testing.assert_array_equal(factors[3], [0, -4, -4])
    np.testing.assert_array_equal(factors[4], [0, -0.5j, 0.5j])


@pytest.mark.parametrize("order", ORDERS)
@pytest.mark.parametrize("count", [300, 301])
def test_whole_periods(order, count):
    t = np.arange(count) * (2.0 / count)
    parts = [(0.3, 2 * np.pi * 1.5, 0.2), (0.05, 2 * np.pi * 6.0, -1.0)]
    found = spectral_derivative(harmonic_rule(parts, 0.0, t), [order], 2.0 / count)[0]
    assert oracles.relative_rms(found, harmonic_rule(parts, order, t)) < 1e-11


@pytest.mark.parametrize("order", ORDERS)
@pytest.mark.parametrize("cycles", [1.7, 3.3, 12.4, 40.9])
def test_broken_cycles(order, cycles):
    omega = 2 * np.pi * 1.37
    t = np.arange(int(cycles / 1.37 * 200)) / 200
    parts = [(0.3, omega, 0.4), (0.02, 3 * omega, 1.0)]
    result = fractional_derivative(
        0.1 + harmonic_rule(parts, 0.0, t), order, 1 / 200, kind="weyl"
    )
    assert result.scheme == "harmonics"
    assert oracles.relative_rms(result.values, harmonic_rule(parts, order, t)) < 1e-9


def test_caputo_goes_over_to_the_steady_state_as_its_transient_decays():
    # Started with velocity w, Caputo lacks w t^-0.5/Gamma(0.5) of the steady state; the rest of
    # the transient decays like t^-1.5.
    omega = 2 * np.pi
    t = 0.002 * np.arange(40_000)
    x = np.sin(omega * t)
    apart = derivative(x, 1.5, 0.002) - derivative(x, 1.5, 0.002, kind="weyl")
    late = slice(20_000, None)
    np.testing.assert_allclose(apart[late], -omega / np.sqrt(np.pi * t[late]), rtol=1e-3)


def lines(count, dt, cycles):
    """Lines of equal size at so many cycles in the record, ready for `harmonic_rule`."""
    omegas = 2 * np.pi * np.asarray(cycles) / (count * dt)
    return [(1.0, omega, 0.7 * k * k) for k, omega in enumerate(omegas)]


@pytest.mark.parametrize("noise", [1e-3, 1e-4])
@pytest.mark.parametrize("order", [0.5, 1.5])
@pytest.mark.parametrize(
    ("cycles", "asked", "used", "low_passed"),
    [
        ([10.3], "auto", "harmonics", False),
        ([10.3, 30.9], "auto", "harmonics", False),
        (np.linspace(3.3, 25.7, 12), "auto", "band-limited", True),
        (np.arange(3, 25, 2), "auto", "spectral", True),
        (np.arange(3, 25, 3), "spectral", "spectral", False),
    ],
)
def test_error_estimate_is_near_the_error(cycles, asked, used, low_passed, order, noise):
    t = 1e-3 * np.arange(4000)
    parts = lines(4000, 1e-3, cycles)
    x = harmonic_rule(parts, 0.0, t)
    x = x + noise * np.std(x) * np.random.default_rng(2).standard_normal(x.size)
    result = fractional_derivative(x, order, 1e-3, kind="weyl", scheme=asked)
    assert (result.scheme, result.cutoff is not None) == (used, low_passed)
    error = oracles.relative_rms(result.values, harmonic_rule(parts, order, t))
    assert error / 5.0 < result.error < 5.0 * error


def test_clean_periods_keep_every_line():
    # More lines than a fit of harmonics holds: no low-pass may stand in for the spectrum.
    t = 1e-3 * np.arange(4000)
    parts = lines(4000, 1e-3, np.arange(7, 120, 5))
    result = fractional_derivative(harmonic_rule(parts, 0.0, t), 0.5, 1e-3, kind="weyl")
    assert (result.scheme, result.cutoff) == ("spectral", None)
    assert oracles.relative_rms(result.values, harmonic_rule(parts, 0.5, t)) < 1e-10
    assert result.error < 1e-9


@pytest.mark.parametrize("order", [0.0, 0.5, 1.0])
def test_low_pass_of_whole_periods(order):
    # All passes up to the cut-off, half of it midway (by symmetry), nothing from twice it on.
    dt, cutoff = 1e-3, 10.0
    t = dt * np.arange(2000)
    gains = [(4.0, 1.0), (10.0, 1.0), (15.0, 0.5), (20.0, 0.0), (45.0, 0.0), (500.0, 0.0)]
    for frequency, gain in gains:
        part = [(1.0, 2 * np.pi * frequency, 0.3)]
        found = spectral_derivative(harmonic_rule(part, 0.0, t), [order], dt, cutoff=cutoff)[0]
        exact = gain * harmonic_rule(part, order, t)
        np.testing.assert_allclose(found, exact, atol=1e-10 * (2 * np.pi * frequency) ** order)


def test_frequency_and_harmonics_in_noise():
    n = np.arange(5000)
    rng = np.random.default_rng(4)
    x = np.sin(0.0213 * n + 0.3) + 0.01 * np.cos(0.0639 * n) + 1e-3 * rng.standard_normal(n.size)
    fit = fit_harmonics(x)
    # Cramer-Rao: var(omega) = 24 s^2 / (A^2 N^3).
    assert abs(fit.omega - 0.0213) < 5 * np.sqrt(24 * 1e-6 / 5000**3)
    assert fit.coefficients.size == 4
    assert abs(fit.coefficients[3]) == pytest.approx(0.01, rel=0.02)
    assert fit.residual == pytest.approx(1e-3, rel=0.05)


def test_no_fit_without_cycles():
    assert fit_harmonics(np.ones(100)) is None
    assert fit_harmonics(np.arange(8.0)) is None

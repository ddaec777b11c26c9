"""Causal derivatives against closed forms."""

import math

import numpy as np
import pytest
from pymittagleffler import mittag_leffler

from models.fractional import derivative
from tests.models.fractional import oracles

ORDERS = (-1.0, -0.5, 0.3, 0.5, 1.0, 1.5, 1.89, 2.0)
SCHEMES = {"gl": 1, "bdf2": 2, "bdf3": 3, "bdf4": 4, "bdf5": 5, "bdf6": 6}


@pytest.mark.parametrize("order", ORDERS)
@pytest.mark.parametrize("k", range(6))
def test_powers_of_time(order, k):
    t = 1e-3 * np.arange(2000)
    exact = oracles.power(k, order, t[1:])
    found = derivative(t**k, order, 1e-3, kind="riemann-liouville", scheme="bdf6")[1:]
    # Rounding of values near 1, amplified by dt^-order, is what is left.
    assert np.max(np.abs(found - exact)) < 1e-12 * max(1e-3**-order, 1.0) * 60.0
    if k >= math.ceil(order):
        caputo = derivative(t**k, order, 1e-3, scheme="bdf6")[1:]
        assert np.max(np.abs(caputo - exact)) < 1e-12 * max(1e-3**-order, 1.0) * 60.0


@pytest.mark.parametrize("order", [0.3, 0.5, 1.5, 1.89])
def test_caputo_takes_off_initial_value_and_velocity(order):
    t = 1e-3 * np.arange(1500)
    x = 0.7 - 0.4 * t + t**3
    lost = [(0.7, 0)] if order < 1.0 else [(0.7, 0), (-0.4, 1)]
    both = [derivative(x, order, 1e-3, kind=kind) for kind in ("riemann-liouville", "caputo")]
    apart = sum(c * oracles.power(k, order, t[1:]) for c, k in lost)
    scale = np.max(np.abs(apart))
    np.testing.assert_allclose((both[0] - both[1])[1:], apart, atol=1e-9 * scale)
    assert both[1][0] == pytest.approx(0.0, abs=1e-6)


@pytest.mark.parametrize("scheme", SCHEMES)
@pytest.mark.parametrize("order", [-0.5, 0.5, 1.5])
def test_order_of_convergence(scheme, order):
    # A smooth record with all initial derivatives there: the correction must earn the order.
    errors = []
    counts = {"gl": (400, 800), "bdf2": (200, 400)}.get(scheme, (80, 160))
    for count in counts:
        dt = 4.0 / count
        t = dt * np.arange(count)
        found = derivative(np.sin(2.0 * t + 0.5), order, dt, scheme=scheme)
        exact = oracles.sine(order, 2.0, 0.5, t[1::4], caputo=True)
        errors.append(np.sqrt(np.mean((found[1::4] - exact) ** 2)))
    assert math.log2(errors[0] / errors[1]) > SCHEMES[scheme] - 0.35


@pytest.mark.parametrize("order", [0.4, 0.9, 1.3, 1.8])
@pytest.mark.parametrize("rate", [-3.0, 0.8])
def test_exponentials_by_mittag_leffler(order, rate):
    # D^a exp(c t) = c^m t^(m-a) E_{1, m-a+1}(c t)
    t = 2e-3 * np.arange(1000)
    m = math.ceil(order)
    exact = rate**m * t ** (m - order) * mittag_leffler(rate * t, 1.0, m - order + 1.0).real
    found = derivative(np.exp(rate * t), order, 2e-3)
    assert oracles.relative_rms(found, exact) < 1e-8


def test_relaxation_solves_its_own_equation():
    # y = E_a(-t^a) solves D^a y = -y; it is not smooth at 0, so only low accuracy is due there.
    order = 0.8
    t = 1e-3 * np.arange(4000)
    y = mittag_leffler(-(t**order), order, 1.0).real
    found = derivative(y, order, 1e-3, scheme="bdf2")
    late = t > 1.0
    np.testing.assert_allclose(found[late], -y[late], atol=2e-4)


@pytest.mark.parametrize(("count", "bar"), [(10_000, 1e-7), (100_000, 1e-8)])
@pytest.mark.parametrize("order", [0.5, 1.5])
@pytest.mark.parametrize(
    ("name", "length"), [("quintic", 2.0), ("septic", 20.0), ("cubic", 20.0), ("cubic", 2.3)]
)
def test_tapered_sine_of_twenty_cycles(count, bar, order, name, length):
    omega = 2.0 * np.pi
    dt = 20.0 / count
    t = dt * np.arange(count)
    chosen = np.linspace(1, count - 1, 40).astype(int)
    exact = oracles.tapered_derivative(name, length, order, omega, t[chosen])
    found = derivative(oracles.tapered(name, length, omega, t), order, dt)[chosen]
    assert oracles.relative_rms(found, exact) < bar


@pytest.mark.parametrize("count", [10_000, 100_000])
def test_sine_with_initial_velocity(count):
    omega = 2.0 * np.pi
    dt = 20.0 / count
    t = dt * np.arange(count)
    chosen = np.concatenate([np.arange(1, 12), np.linspace(12, count - 1, 40).astype(int)])
    exact = oracles.sine(1.5, omega, 0.0, t[chosen], caputo=True)
    found = derivative(np.sin(omega * t), 1.5, dt)[chosen]
    assert oracles.relative_rms(found, exact) < 1e-6
    # Finer sampling must not lose the start to rounding.
    assert np.max(np.abs(found - exact)[:11]) < 1e-6 * omega**1.5

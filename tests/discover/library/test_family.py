"""Families with a continuous shape against the formula at every shape."""

from math import factorial

import mpmath
import numpy as np
import pytest

from discover.library.family import Family

ORDERS = Family("fractional-derivative", "order", 0.0, 2.0, 17, 2.0 * np.pi)
EXPONENTS = Family("power-law-damping", "exponent", 0.4, 3.0, 17, 0.5)
VALUES = np.linspace(0.0, 1.0, 83)


def orders_at(frequency, values):
    """Return (G,) transfer functions of D^q over reference^q, by mpmath."""
    omega = mpmath.mpf(2) * mpmath.pi * frequency
    return np.array(
        [complex((1j * omega) ** mpmath.mpf(float(q)) / mpmath.mpf(ORDERS.reference) ** float(q))
         for q in values]
    )  # fmt: skip


@pytest.mark.parametrize("frequency", [0.05, 0.1, 1.0, 7.0, 15.0, 31.0])
def test_orders_between_nodes_are_those_of_the_formula(frequency):
    """Fractional derivatives of frequencies from a twentieth to thirty times the reference."""
    at_nodes = orders_at(frequency, ORDERS.nodes)
    wanted = 2.0 * VALUES
    exact = orders_at(frequency, wanted)
    found = at_nodes @ ORDERS.weights(wanted)
    assert np.abs(found - exact).max() < 1e-10 * np.abs(exact).max()


@pytest.mark.parametrize("share", [1.0, 0.1, 1e-2, 1e-3])
def test_exponents_between_nodes_stay_within_the_remainder_of_interpolation(share):
    """|f - p| <= max|f^(n)| / n! times the nodes' polynomial, at most 2^(2 - n) (n = 17)."""
    wanted = 0.4 + 2.6 * VALUES
    exact = share**wanted
    found = share**EXPONENTS.nodes @ EXPONENTS.weights(wanted)
    rate = 1.3 * abs(np.log(share))
    bound = exact.max() * (rate**17 / factorial(17) / 2.0**15 + 1e-14)
    assert np.abs(found - exact).max() < bound


def test_error_falls_geometrically_with_the_number_of_nodes():
    """An entire function: Chebyshev's error falls faster than any power (Bernstein)."""
    errors = []
    for count in (5, 7, 9, 11):
        family = Family("fractional-derivative", "order", 0.0, 2.0, count, 1.0)
        exact = 20.0 ** (2.0 * VALUES)
        errors.append(np.abs(20.0**family.nodes @ family.weights(2.0 * VALUES) - exact).max())
    ratios = np.array(errors[1:]) / errors[:-1]
    assert np.all(ratios < 0.1)
    assert np.all(np.diff(ratios) < 0.0)


def test_polynomials_of_the_nodes_degree_are_exact():
    rng = np.random.default_rng(0)
    polynomial = np.polynomial.Polynomial(rng.standard_normal(17), domain=[0.0, 2.0])
    np.testing.assert_allclose(
        polynomial(ORDERS.nodes) @ ORDERS.weights(2.0 * VALUES), polynomial(2.0 * VALUES),
        atol=1e-12,
    )  # fmt: skip


def test_weights_at_nodes_pick_the_node_and_always_add_up_to_one():
    np.testing.assert_allclose(ORDERS.weights(ORDERS.nodes), np.eye(17), atol=1e-13)
    np.testing.assert_allclose(EXPONENTS.weights(0.4 + 2.6 * VALUES).sum(axis=0), 1.0, atol=1e-13)


@pytest.mark.parametrize("frequency", [0.1, 1.0, 15.0])
@pytest.mark.parametrize("order", [0.0, 0.48, 1.89, 2.0])
def test_slope_is_the_derivative_by_the_order(frequency, order):
    """d/dq (i w / r)^q = log(i w / r) (i w / r)^q."""
    base = 1j * 2.0 * np.pi * frequency / ORDERS.reference
    exact = np.log(base) * base**order
    found = orders_at(frequency, ORDERS.nodes) @ ORDERS.slope(order)
    assert abs(found - exact) < 1e-8 * max(abs(np.log(base)) * abs(base) ** 2, 1.0)

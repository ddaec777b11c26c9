"""Against pycaputo, which is right and O(N^2)."""

import numpy as np
import pycaputo.differentiation as reference
import pytest
from pycaputo.derivatives import Side
from pycaputo.differentiation.caputo import L1
from pycaputo.differentiation.grunwald_letnikov import GrunwaldLetnikov
from pycaputo.grid import make_uniform_points

from models.fractional import derivative
from models.fractional.l1 import l1_weights

COUNT = 2000


@pytest.fixture
def points():
    return make_uniform_points(COUNT, 0.0, 4.0)


@pytest.mark.parametrize("order", [0.3, 0.5, 0.9])
def test_gruenwald_letnikov(points, order):
    # pycaputo adds the constant's derivative exactly; without a constant both are the bare sum.
    x = np.sin(3.0 * points.x) * (1.0 + points.x)
    theirs = reference.diff(GrunwaldLetnikov(order), x, points)
    ours = derivative(x, order, points.dx[0], kind="grunwald-letnikov")
    np.testing.assert_allclose(ours[1:], theirs[1:], atol=1e-9 * np.max(np.abs(ours)))


@pytest.mark.parametrize("order", [0.3, 0.5, 0.9])
def test_l1(points, order):
    x = np.cos(3.0 * points.x) + 0.5
    theirs = reference.diff(L1(order), x, points)
    ours = derivative(x, order, points.dx[0], scheme="l1")
    np.testing.assert_allclose(ours[1:], theirs[1:], atol=1e-9 * np.max(np.abs(ours)))


def test_l1_weights_far_out_keep_their_digits():
    # b_j -> (1-a) j^-a (1 - a/(2j)) / Gamma(2-a): no cancellation at the end of long records.
    from math import gamma

    weights = l1_weights(np.array([0.5]), 1_000_001)[0]
    j = 1e6
    expected = 0.5 * j**-0.5 * (1.0 - 0.25 / j + 0.125 / j**2) / gamma(1.5)
    assert weights[-1] == pytest.approx(expected, rel=1e-13)


def test_l1_converges_with_two_less_order():
    errors = []
    for count in (400, 800):
        dt = 2.0 / count
        t = dt * np.arange(count)
        exact = 2.0 * t**1.5 / 1.329340388179137
        errors.append(np.max(np.abs(derivative(t**2, 0.5, dt, scheme="l1") - exact)))
    assert 1.4 < np.log2(errors[0] / errors[1]) < 1.6


def test_side_is_the_left_one():
    assert GrunwaldLetnikov(0.5).d.side is Side.Left

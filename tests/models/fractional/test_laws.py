"""What any fractional derivative has to obey, whatever its scheme."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from models.fractional import derivative
from tests.models.fractional import oracles

KINDS = ("caputo", "riemann-liouville", "grunwald-letnikov", "weyl")
T = 0.01 * np.arange(800)
X = np.sin(2.0 * np.pi * T) + 0.2 * np.cos(4.0 * np.pi * T)
Y = np.cos(np.pi * T) ** 2 - 0.5


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("order", [-0.5, 0.5, 1.5])
def test_linear(kind, order):
    scheme = {"caputo": "bdf4", "riemann-liouville": "bdf4", "weyl": "spectral"}.get(kind, "gl")
    each = derivative(np.stack([X, Y, 2.0 * X - 3.0 * Y]), order, 0.01, kind=kind, scheme=scheme)
    scale = np.max(np.abs(each[:2, 1:]))
    # The start fit's width may differ between the records: its error, not rounding, bounds this.
    assert np.max(np.abs(each[2] - 2.0 * each[0] + 3.0 * each[1])[1:]) < 1e-6 * scale


@settings(max_examples=25, deadline=None)
@given(scale=st.floats(1e-6, 1e6), order=st.floats(-1.0, 2.0))
def test_time_scaling(scale, order):
    # d^a x(ct) / dt^a = c^a (d^a x)(ct): the same samples at another rate.
    slow = derivative(X, order, 0.01, scheme="bdf4")
    fast = derivative(X, order, 0.01 * scale, scheme="bdf4")
    np.testing.assert_allclose(fast * scale**order, slow, rtol=1e-9, atol=1e-9 * np.abs(slow).max())


@settings(max_examples=25, deadline=None)
@given(factor=st.floats(-1e9, 1e9).filter(lambda c: abs(c) > 1e-9), order=st.floats(-1.0, 2.0))
def test_units_and_sign(factor, order):
    one = derivative(X, order, 0.01, scheme="bdf4")
    other = derivative(factor * X, order, 0.01, scheme="bdf4")
    np.testing.assert_allclose(other / factor, one, atol=1e-8 * np.abs(one).max())


@pytest.mark.parametrize("order", [0.5, 1.5, 1.89])
def test_causal_result_does_not_depend_on_what_follows(order):
    whole = derivative(X, order, 0.01, scheme="bdf4", kind="riemann-liouville")
    part = derivative(X[:600], order, 0.01, scheme="bdf4", kind="riemann-liouville")
    np.testing.assert_allclose(part, whole[:600], atol=1e-8 * np.abs(whole).max())


@pytest.mark.parametrize("kind", ["caputo", "weyl"])
def test_whole_orders(kind):
    omega = 2.0 * np.pi
    x = np.sin(omega * T)
    exact = {0.0: x, 1.0: omega * np.cos(omega * T), 2.0: -(omega**2) * x}
    for order, expected in exact.items():
        found = derivative(x, order, 0.01, kind=kind)
        assert oracles.relative_rms(found, expected) < 2e-4 * 10.0 ** (order - 2.0)


@pytest.mark.parametrize("whole", [0.0, 1.0, 2.0])
@pytest.mark.parametrize("kind", ["riemann-liouville", "weyl"])
def test_orders_near_whole_ones_tend_to_them(kind, whole):
    x = X * T**3
    x -= x.mean()  # a steady mean has no derivative, but itself at order 0: a jump by nature
    near = [o for o in (whole - 1e-9, whole + 1e-9) if o <= 2.0]
    scheme = "spectral" if kind == "weyl" else "bdf6"
    limit = derivative(x, whole, 0.01, kind=kind, scheme=scheme)
    for order in near:
        found = derivative(x, order, 0.01, kind=kind, scheme=scheme)
        # At t = 0 a Riemann-Liouville derivative of any order but 0 has no value to tend to.
        assert np.max(np.abs(found - limit)[1:]) < 1e-6 * np.max(np.abs(limit))


def test_integral_undoes_derivative_from_rest():
    x = oracles.tapered("septic", 3.0, 2.0 * np.pi, T)
    for order in (0.3, 0.7, 1.0):
        back = derivative(derivative(x, order, 0.01), -order, 0.01)
        assert oracles.relative_rms(back, x) < 1e-5


def test_orders_add_from_rest():
    x = oracles.tapered("septic", 3.0, 2.0 * np.pi, T)
    twice = derivative(derivative(x, 0.7, 0.01), 0.8, 0.01)
    once = derivative(x, 1.5, 0.01)
    assert oracles.relative_rms(twice, once) < 1e-4


def test_caputo_orders_do_not_add_with_initial_velocity():
    # D^1 D^0.5 t = t^-0.5/G(0.5), but D^1.5 t = 0: an identity that must fail, and by how much.
    x = T.copy()
    half = derivative(x, 0.5, 0.01)
    np.testing.assert_allclose(half, 2.0 * np.sqrt(T / np.pi), atol=1e-10)
    assert np.max(np.abs(derivative(x, 1.5, 0.01))) < 1e-6
    late = slice(200, None)
    slope = np.gradient(half, 0.01)[late]
    np.testing.assert_allclose(slope, 1.0 / np.sqrt(np.pi * T[late]), rtol=1e-3)


def test_riemann_liouville_of_a_constant_is_not_zero_and_caputo_is():
    ones = np.full(500, 2.5)
    rl = derivative(ones, 0.5, 0.01, kind="riemann-liouville")
    np.testing.assert_allclose(rl[1:], 2.5 / np.sqrt(np.pi * T[1:500]), rtol=1e-9)
    assert np.max(np.abs(derivative(ones, 0.5, 0.01))) < 1e-12


@pytest.mark.parametrize("kind", KINDS)
def test_shapes(kind):
    batch = np.stack([[X, Y], [Y, X], [X + Y, X - Y]])
    one = derivative(X, 0.5, 0.01, kind=kind)
    assert one.shape == X.shape
    assert derivative(batch, 0.5, 0.01, kind=kind).shape == (3, 2, 800)
    many = derivative(batch, [0.5, 1.0, 1.5, 2.0], 0.01, kind=kind)
    assert many.shape == (4, 3, 2, 800)
    assert derivative(X, [0.5], 0.01, kind=kind).shape == (1, 800)


def test_batch_equals_one_by_one():
    batch = np.stack([X, Y, X * Y])
    orders = [-0.5, 0.0, 0.5, 1.5, 2.0]
    many = derivative(batch, orders, 0.01, scheme="bdf3")
    for k, order in enumerate(orders):
        for r, row in enumerate(batch):
            one = derivative(row, order, 0.01, scheme="bdf3")
            np.testing.assert_allclose(many[k, r], one, atol=1e-9 * np.abs(one).max())


@pytest.mark.parametrize("kind", KINDS)
def test_read_only_strided_and_single_precision_input(kind):
    wide = np.stack([X, Y], axis=1)
    wide.setflags(write=False)
    strided = wide[:, 0]
    before = strided.copy()
    found = derivative(strided, [0.5, 1.5], 0.01, kind=kind)
    np.testing.assert_array_equal(strided, before)
    np.testing.assert_array_equal(found, derivative(X.copy(), [0.5, 1.5], 0.01, kind=kind))
    backwards = derivative(X[::-1], 0.5, 0.01, kind=kind)
    np.testing.assert_array_equal(backwards, derivative(X[::-1].copy(), 0.5, 0.01, kind=kind))
    single = derivative(X.astype(np.float32), 0.5, 0.01, kind=kind)
    assert single.dtype == np.float64
    assert oracles.relative_rms(single, derivative(X, 0.5, 0.01, kind=kind)) < 1e-4


def test_constant_and_short_records():
    assert not derivative(np.zeros(50), [0.5, 1.5], 0.1).any()
    assert derivative([1.0, 2.0], 1.0, 0.5) == pytest.approx([2.0, 2.0])
    assert np.all(np.isfinite(derivative([0.0, 1.0, 0.5], [0.5, 1.5], 0.1)))

import mpmath
import numpy as np
import pytest

from models.fractional import derivative
from models.fractional.memory_modes import memory_modes
from models.fractional.weights import convolution_weights, difference_polynomial

ORDERS = np.array([-1.0, -0.6, 0.0, 0.3, 0.5, 1.0, 1.5, 1.89, 2.0])


def by_cauchy_products(order, p, count):
    """Coefficients of delta^order = exp(order log delta), in 40 digits."""
    with mpmath.workdps(40):
        delta = [mpmath.mpf(c.numerator) / c.denominator for c in difference_polynomial(p)]
        # The logarithm's coefficients n l_n = n d_n/d_0 - sum_{k<n} k l_k d_{n-k}/d_0.
        logs = [mpmath.log(delta[0])]
        for n in range(1, count):
            known = n * delta[n] if n <= p else mpmath.mpf(0)
            known -= sum(k * logs[k] * delta[n - k] for k in range(max(1, n - p), n))
            logs.append(known / delta[0] / n)
        weights = [mpmath.exp(order * logs[0])]
        for n in range(1, count):
            total = sum(k * order * logs[k] * weights[n - k] for k in range(1, n + 1))
            weights.append(total / n)
        return np.array([float(w) for w in weights])


@pytest.mark.parametrize("p", [1, 2, 4, 6])
def test_weights_match_forty_digits(p):
    for order in (-0.6, 0.5, 1.89):
        exact = by_cauchy_products(mpmath.mpf(order), p, 150)
        found = convolution_weights(np.array([order]), 150, p)[0]
        np.testing.assert_allclose(found, exact, rtol=1e-12, atol=1e-13)


@pytest.mark.parametrize("p", [1, 3, 6])
def test_head_and_tail_join(p):
    # The recurrence gives 512 weights, the expansion the rest: a smooth sequence across.
    weights = convolution_weights(np.array([0.5, 1.5]), 600, p)
    for row in weights:
        slopes = np.diff(np.log(np.abs(row[480:560]))) * np.arange(480.5, 559.5)
        assert np.max(np.abs(np.diff(slopes))) < 1e-4


@pytest.mark.parametrize("count", [2, 3, 5, 8, 101, 1000])
def test_bare_sum_is_the_sum(count):
    x = np.random.default_rng(count).standard_normal(count)
    found = derivative(x, ORDERS, 0.5, kind="grunwald-letnikov")
    for order, values in zip(ORDERS, found, strict=True):
        weights = convolution_weights(np.array([order]), count, 1)[0]
        np.testing.assert_allclose(
            values, 0.5**-order * np.convolve(weights, x)[:count], rtol=1e-11, atol=1e-12
        )


def test_gruenwald_letnikov_weights_are_binomial():
    found = convolution_weights(np.array([0.4]), 3000, 1)[0]
    n = np.arange(1, 3000)
    exact = np.concatenate([[1.0], np.cumprod(1.0 - 1.4 / n)])
    np.testing.assert_allclose(found, exact, rtol=1e-12)


def test_whole_orders_end():
    for p in (1, 4, 6):
        weights = convolution_weights(np.array([0.0, 1.0, 2.0]), 2000, p)
        assert np.count_nonzero(weights[0]) == 1
        np.testing.assert_allclose(
            weights[1, : p + 1], [float(c) for c in difference_polynomial(p)], rtol=1e-13
        )
        assert not weights[1, p + 1 :].any()
        assert not weights[2, 2 * p + 1 :].any()


@pytest.mark.parametrize("p", [1, 2, 6])
def test_modes_carry_the_tail(p):
    n = np.unique(np.geomspace(512, 49_999, 60).astype(int))
    weights = convolution_weights(ORDERS, 50_000, p)[:, n]
    modes = memory_modes(ORDERS, p)
    found = modes.weights @ np.exp(-np.outer(modes.rates, n - 512.0))
    np.testing.assert_allclose(found, weights, rtol=1e-11, atol=1e-300)

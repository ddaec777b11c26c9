import math

import numpy as np
import pytest

from models.checks import InputError
from models.fractional import exponential_sum


@pytest.mark.parametrize("beta", [0.01, 0.3, 0.5, 0.89, 0.99])
@pytest.mark.parametrize("error", [1e-2, 1e-6, 1e-10, 1e-12])
@pytest.mark.parametrize(("dt", "horizon"), [(1e-3, 10.0), (1e-4, 1e3), (1.0, 1.5)])
def test_relative_error_as_stated(beta, error, dt, horizon):
    weights, rates = exponential_sum(beta, dt, horizon, error)
    t = np.geomspace(dt, horizon, 1511)
    kernel = t**-beta / math.gamma(1.0 - beta)
    found = np.exp(-np.outer(t, rates)) @ weights
    assert np.max(np.abs(found / kernel - 1.0)) < 1.05 * error
    assert np.all(weights > 0.0)
    assert np.all(rates >= 0.0)
    assert np.all(np.diff(rates) > 0.0)


def test_few_terms_and_ever_fewer_for_less():
    counts = [exponential_sum(0.5, 1e-3, 1e2, error)[1].size for error in (1e-4, 1e-8, 1e-12)]
    assert counts[0] < counts[1] < counts[2] < 60


def test_units_of_time():
    weights, rates = exponential_sum(0.4, 1e-3, 1.0, 1e-8)
    other, slower = exponential_sum(0.4, 1.0, 1e3, 1e-8)
    np.testing.assert_allclose(slower * 1e3, rates, rtol=1e-9)
    np.testing.assert_allclose(other * 1e3**0.4, weights, rtol=1e-9)


@pytest.mark.parametrize(
    ("arguments", "what"),
    [
        ((0.0, 1.0, 2.0), "beta"),
        ((1.0, 1.0, 2.0), "beta"),
        ((0.5, 0.0, 2.0), "dt"),
        ((0.5, 1.0, 1.0), "horizon"),
        ((0.5, 1.0, 2.0, 1e-15), "error"),
    ],
)
def test_bad_input(arguments, what):
    with pytest.raises(InputError, match=f"{what} must be"):
        exponential_sum(*arguments)

"""How much of a posterior its signs allow, beside integrals and bounds."""

import numpy as np
import pytest
from scipy.optimize import nnls
from scipy.stats import multivariate_normal

from discover.posterior.signs import allowed


def drawn(rng, alike):
    """Return a covariance of two to five coefficients, the more of one kind the more `alike`."""
    count = int(rng.integers(2, 6))
    parts = rng.standard_normal((count, count + 1)) + alike * rng.standard_normal((1, count + 1))
    return parts @ parts.T + 1e-4 * np.eye(count)


def means_beside(covariance, rng, far):
    return far * rng.standard_normal(len(covariance)) * np.sqrt(np.diag(covariance))


@pytest.mark.parametrize("alike", [0.0, 3.0])
def test_where_little_is_cut_off_it_is_the_integral(alike):
    rng = np.random.default_rng(3)
    errors = []
    while len(errors) < 40:
        covariance = drawn(rng, alike)
        mean = means_beside(covariance, rng, 1.0)
        origin = np.zeros(mean.size)
        share = multivariate_normal(origin, covariance, allow_singular=True).cdf(mean)
        if share > 1e-3:
            found = allowed(mean, covariance, np.ones(mean.size))
            errors.append(found - np.log(share) - mean.size * np.log(2.0))
    assert np.quantile(np.abs(errors), 0.9) < 0.3
    assert np.max(np.abs(errors)) < 0.7


@pytest.mark.parametrize("far", [3.0, 30.0, 1000.0])
def test_far_away_it_is_what_the_nearest_allowed_place_has_to_a_few_nats(far):
    """That is a bound; what is below it is the integral from there on."""
    rng = np.random.default_rng(4)
    for _ in range(100):
        covariance = drawn(rng, 5.0)
        mean = means_beside(covariance, rng, far)
        values, vectors = np.linalg.eigh(covariance)
        root = (vectors / np.sqrt(values)).T
        _, distance = nnls(root, root @ mean)
        bound = mean.size * np.log(2.0) - 0.5 * distance**2
        found = allowed(mean, covariance, np.ones(mean.size))
        assert found < bound + 1e-6 * (1.0 + distance**2) + 0.3
        assert found > bound - 8.0 * mean.size


def test_two_that_may_not_be_negative_do_not_make_up_for_each_other():
    """Whichever is cut off first: their sum is known well, and one of them is far below zero."""
    covariance = np.array([[1.0, -0.9999], [-0.9999, 1.0]])
    mean = np.array([-30.0, 29.0])
    one = allowed(mean, covariance, np.ones(2))
    other = allowed(mean[::-1], covariance, np.ones(2))
    assert one == pytest.approx(other)
    assert one < -1000.0


def test_the_sign_may_be_either_and_what_has_none_is_free():
    rng = np.random.default_rng(5)
    covariance = drawn(rng, 1.0)
    mean = means_beside(covariance, rng, 5.0)
    turn = np.where(np.arange(mean.size) % 2, -1.0, 1.0)
    assert allowed(mean * turn, turn[:, None] * covariance * turn, turn) == pytest.approx(
        allowed(mean, covariance, np.ones(mean.size))
    )
    assert allowed(mean, covariance, np.zeros(mean.size)) == 0.0
    wider = np.eye(mean.size + 1)
    wider[: mean.size, : mean.size] = covariance
    free = allowed(np.append(mean, -7.0), wider, np.append(np.ones(mean.size), 0.0))
    assert free == pytest.approx(allowed(mean, covariance, np.ones(mean.size)))


@pytest.mark.parametrize("correlation", [1.0, -1.0])
def test_equal_columns_have_an_answer(correlation):
    covariance = np.array([[1.0, correlation, 0.0], [correlation, 1.0, 0.0], [0.0, 0.0, 1.0]])
    found = allowed(np.array([-9.0, -9.0, -9.0]), covariance, np.ones(3))
    assert np.isfinite(found)
    assert found < -70.0

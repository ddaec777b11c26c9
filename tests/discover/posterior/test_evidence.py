"""Evidence of linear models: the marginal likelihood by the whole covariance, or by quadrature."""

import numpy as np
import pytest
from scipy.integrate import dblquad, quad
from scipy.stats import norm

from discover.posterior.evidence import root_of, solved, without
from tests.discover.posterior.small import log_density

SIZE = 12


@pytest.fixture(scope="module")
def problem():
    rng = np.random.default_rng(4)
    columns = rng.standard_normal((SIZE, 3))
    root = rng.standard_normal((SIZE, SIZE)) / 4.0
    covariance = np.eye(SIZE) + root @ root.T
    force = columns @ [1.0, -2.0, 0.3] + np.linalg.cholesky(covariance) @ rng.standard_normal(SIZE)
    return columns, covariance, force


def parts(columns, covariance, force):
    weighted = np.linalg.solve(covariance, np.column_stack([columns, force]))
    gram = columns.T @ weighted[:, :-1]
    return gram, columns.T @ weighted[:, -1], log_density(force, covariance)


def test_evidence_is_the_marginal_likelihood(problem):
    columns, covariance, force = problem
    spread = np.array([2.0, 0.5, 1.0])
    found = solved(*parts(*problem)[:2], spread, np.zeros(3), parts(*problem)[2])
    whole = covariance + columns @ np.diag(spread**2) @ columns.T
    assert float(found.log_evidence) == pytest.approx(log_density(force, whole), rel=1e-9)
    gain = np.diag(spread**2) @ columns.T @ np.linalg.inv(whole)
    np.testing.assert_allclose(found.mean, gain @ force, rtol=1e-9)
    np.testing.assert_allclose(
        found.covariance, np.diag(spread**2) - gain @ columns @ np.diag(spread**2), atol=1e-12
    )


def test_many_models_at_once_are_each_alone(problem):
    gram, side, normal = parts(*problem)
    spread = np.array([[2.0, 0.5, 1.0], [1.0, 1.0, 0.1]])
    sign = np.array([[1.0, 0.0, 0.0], [0.0, -1.0, 0.0]])
    both = solved(np.stack([gram, gram]), np.stack([side, side]), spread, sign, normal)
    for i in range(2):
        one = solved(gram, side, spread[i], sign[i], normal)
        assert both.log_evidence[i] == pytest.approx(float(one.log_evidence), rel=1e-12)


@pytest.mark.parametrize("place", [0, 1, 2])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_coefficient_of_one_sign_has_a_prior_that_is_cut_off(problem, place, sign):
    columns, covariance, force = problem
    one, spread = columns[:, [place]], 1.5
    gram, side, normal = parts(one, covariance, force)
    found = solved(gram, side, np.array([spread]), np.array([sign]), normal)

    def density(value):
        shape = -0.5 * gram[0, 0] * value**2 + side[0] * value
        return 2.0 * norm.pdf(value, scale=spread) * np.exp(shape)

    bounds = (0.0, 15.0) if sign > 0.0 else (-15.0, 0.0)
    expected = normal + np.log(quad(density, *bounds, limit=200)[0])
    assert float(found.log_evidence) == pytest.approx(expected, abs=1e-6)


def test_of_columns_that_share_nothing_each_sign_counts_by_itself():
    rng = np.random.default_rng(0)
    columns = np.linalg.qr(rng.standard_normal((SIZE, 2)))[0] * 3.0
    force = columns @ [0.4, -0.2] + rng.standard_normal(SIZE)
    gram, side, normal = parts(columns, np.eye(SIZE), force)
    found = solved(gram, side, np.ones(2), np.ones(2), normal)

    def density(second, first):
        value = np.array([first, second])
        shape = -0.5 * value @ gram @ value + side @ value
        return 4.0 * np.prod(norm.pdf(value)) * np.exp(shape)

    expected = normal + np.log(dblquad(density, 0.0, 6.0, 0.0, 6.0, epsabs=1e-9)[0])
    assert float(found.log_evidence) == pytest.approx(expected, abs=1e-5)


def test_columns_that_are_marginalised_are_a_part_of_the_covariance(problem):
    columns, covariance, force = problem
    whole = np.column_stack([columns, force])
    gram = whole.T @ np.linalg.solve(covariance, whole)
    spread = np.array([0.7, 1.3])
    left, gained = without(gram, np.array([0, 2]), spread)
    taken = columns[:, [0, 2]]
    wider = covariance + taken @ np.diag(spread**2) @ taken.T
    expected = whole.T @ np.linalg.solve(wider, whole)
    kept = np.array([1, 3])
    np.testing.assert_allclose(left[np.ix_(kept, kept)], expected[np.ix_(kept, kept)], rtol=1e-9)
    before = log_density(force, covariance)
    assert before + gained == pytest.approx(log_density(force, wider), rel=1e-9)


def test_columns_that_are_the_same_tell_their_sum():
    size = 1e19
    found = solved(np.full((2, 2), size), np.full(2, 3.0 * size), np.ones(2), np.zeros(2), 0.0)
    assert float(found.mean.sum()) == pytest.approx(3.0, rel=1e-6)
    assert np.isfinite(found.log_evidence)


def test_columns_that_rounding_makes_worse_than_alike_are_still_factored():
    column = np.array([1e9, 1.0])
    gram = np.outer(column, column)
    gram = np.block([[gram, gram], [gram, gram]])
    gram[0, 2] = gram[2, 0] = gram[0, 0] * (1.0 + 1e-12)  # as sums less their parts are rounded
    spread = np.ones(4)
    with pytest.raises(np.linalg.LinAlgError):
        np.linalg.cholesky(np.eye(4) + gram)
    factor = root_of(gram, spread)
    assert np.all(np.diag(factor) >= 1.0 - 1e-6)
    np.testing.assert_array_equal(factor, np.tril(factor))
    np.testing.assert_allclose(factor @ factor.T, np.eye(4) + gram, rtol=1e-9, atol=1e-6 * 1e9)


@pytest.mark.parametrize("wild", [-1e22, 1e40])
def test_beside_a_column_of_which_rounding_leaves_nothing_there_is_no_evidence(wild):
    gram = np.stack([np.eye(3), np.diag([1.0, 1.0, wild])])
    side = np.array([[1.0, 2.0, 3.0], [1.0, 2.0, 1e25]])
    found = solved(gram, side, np.ones((2, 3)), np.zeros((2, 3)), np.zeros(2))
    assert np.isfinite(found.log_evidence[0])
    assert found.log_evidence[1] == -np.inf
    assert np.all(np.isfinite(found.mean))

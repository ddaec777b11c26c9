"""BestSubset inside pysindy and scikit-learn."""

import numpy as np
import pysindy as ps
import pytest
from sklearn.base import clone
from sklearn.model_selection import GridSearchCV

from discover.regression import BestSubset
from discover.regression.best_subset import compress
from models.checks import InputError

TRUE = {2: 3.0, 7: -0.5}


def data(rows=300, noise=0.1, seed=1):
    rng = np.random.default_rng(seed)
    theta = rng.normal(size=(rows, 12))
    force = sum(c * theta[:, i] for i, c in TRUE.items()) + noise * rng.normal(size=rows)
    return theta, force


def support(optimizer, target=0):
    return np.flatnonzero(optimizer.coef_[target]).tolist()


def test_finds_the_terms_with_plain_least_squares_coefficients():
    theta, force = data()
    found = BestSubset(max_terms=5).fit(theta, force)
    assert support(found) == [2, 7]
    expected = np.linalg.lstsq(theta[:, [2, 7]], force, rcond=None)[0]
    np.testing.assert_allclose(found.coef_[0, [2, 7]], expected, rtol=1e-10)
    assert found.ind_.tolist() == [[i in TRUE for i in range(12)]]
    assert len(found.history_) == 6
    assert [np.count_nonzero(h) for h in found.history_] == [0, 1, 2, 3, 4, 5]
    assert found.complexity == 2


def test_every_target_gets_its_own_terms():
    theta, force = data()
    both = np.column_stack([force, 2.0 * theta[:, 0]])
    found = BestSubset().fit(theta, both)
    assert [support(found, i) for i in (0, 1)] == [[2, 7], [0]]
    assert found.coef_[1, 0] == pytest.approx(2.0)
    assert found.predict(theta).shape == (300, 2)


def test_weights_count_as_repeated_rows():
    theta, force = data(rows=40)
    weights = np.arange(40) % 3 + 1
    weighted = BestSubset(3, effective_samples=80.0).fit(theta, force, sample_weight=weights)
    repeated = BestSubset(3, effective_samples=80.0).fit(
        np.repeat(theta, weights, axis=0), np.repeat(force, weights)
    )
    np.testing.assert_allclose(weighted.coef_, repeated.coef_, rtol=1e-9)


def test_a_triangle_for_rows_gives_the_same_terms():
    theta, force = data(rows=5000)
    triangle = compress(np.column_stack([theta, force]))
    full = BestSubset(effective_samples=5000.0).fit(theta, force)
    small = BestSubset(effective_samples=5000.0).fit(triangle[:, :-1], triangle[:, -1])
    np.testing.assert_allclose(full.coef_, small.coef_, rtol=1e-9)
    with pytest.raises(InputError, match="effective_samples or groups must be given where rows"):
        BestSubset().fit(triangle[:, :-1], triangle[:, -1])


def test_a_term_that_holds_in_one_record_alone_is_left_out_by_records():
    """An offset in one of eight records lowers the misfit, not the error on other records."""
    rng = np.random.default_rng(4)
    records = np.repeat(np.arange(8), 200)
    theta = rng.normal(size=(1600, 6))
    theta[:, 5] = 1.0
    force = 2.0 * theta[:, 1] + 0.1 * rng.normal(size=1600)
    force[records == 3] += 2.0
    by_samples = BestSubset(effective_samples=1600.0).fit(theta, force)
    by_records = BestSubset(groups=records).fit(theta, force)
    assert 5 in support(by_samples)
    assert support(by_records) == [1]
    assert by_records.counts_[0].rule == "leave-group-out"


def test_constraints_reach_the_search():
    theta, force = data()
    assert 5 in support(BestSubset(forced=[5]).fit(theta, force))
    assert 7 not in support(BestSubset(nonnegative=range(12)).fit(theta, force))
    assert support(BestSubset(exclusive=[[2, 7]]).fit(theta, force))[0] == 2
    assert 7 not in support(BestSubset(exclusive=[[2, 7]]).fit(theta, force))


def test_correlated_residuals_lower_the_number_of_samples():
    rng = np.random.default_rng(0)
    theta, _ = data(rows=2000)
    drift = np.convolve(rng.normal(size=2099), np.ones(100), mode="valid")
    force = 30.0 * theta[:, 2] + drift
    slow = np.convolve(rng.normal(size=2099), np.ones(100), mode="valid")  # like drift, unrelated
    theta[:, 9] = slow
    assert support(BestSubset().fit(theta, force)) == [2]
    assert 9 in support(BestSubset(effective_samples=2000.0).fit(theta, force))


def test_scikit_learn_conventions():
    theta, force = data()
    optimizer = BestSubset(3, nonnegative=(2,), groups=np.arange(300) % 5)
    copy = clone(optimizer)
    assert copy.get_params().keys() == optimizer.get_params().keys()
    assert copy.set_params(max_terms=2, groups=None) is copy
    assert copy.max_terms == 2
    search = GridSearchCV(BestSubset(effective_samples=200.0), {"max_terms": [1, 2]}, cv=3)
    assert search.fit(theta, force).best_params_ == {"max_terms": 2}


def test_inside_an_ensemble():
    theta, force = data()
    np.random.seed(0)  # noqa: NPY002 - pysindy draws from numpy's global state
    ensemble = ps.EnsembleOptimizer(BestSubset(max_terms=3), bagging=True, n_models=8)
    ensemble.fit(theta, force)
    assert support(ensemble) == [2, 7]
    assert len(ensemble.coef_list) == 8
    assert np.std([c[0, 2] for c in ensemble.coef_list]) > 0.0


def test_inputs_are_not_changed():
    theta, force = data()
    before = theta.copy()
    theta.flags.writeable = force.flags.writeable = False
    BestSubset(groups=np.arange(300) % 4).fit(theta, force)
    np.testing.assert_array_equal(theta, before)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"criterion": "aic"}, "BestSubset: criterion must be one of ebic, bic, got 'aic'"),
        ({"effective_samples": 0.5}, "BestSubset: effective_samples must be a finite number > 1"),
        ({"groups": [0, 1]}, r"BestSubset: groups must be one label for each of 300 rows, got sha"),
        ({"groups": np.zeros(300)}, "BestSubset: groups must be at least two records, got one"),
        ({"max_terms": "four"}, "max_terms must be a whole number >= 1, got 'four'"),
    ],
)
def test_parameters_are_checked_when_fitted(options, message):
    optimizer = BestSubset(**options)
    with pytest.raises(InputError, match=message):
        optimizer.fit(*data())

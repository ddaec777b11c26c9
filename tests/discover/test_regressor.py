"""The regressor for scikit-learn: its conventions, and records of known devices."""

import numpy as np
import pytest
from sklearn.model_selection import GridSearchCV, GroupKFold, cross_validate
from sklearn.pipeline import make_pipeline
from sklearn.utils.estimator_checks import parametrize_with_checks

from discover import InerterLibrary, InerterRegressor
from models.checks import InputError

DT = 1.0 / 256.0
TIME = DT * (np.arange(512) + 0.5)
OMEGA = 2.0 * np.pi


@pytest.mark.filterwarnings("ignore::sklearn.exceptions.SkipTestWarning")
@parametrize_with_checks([InerterRegressor()])
def test_what_scikit_learn_asks_of_an_estimator(estimator, check):
    check(estimator)


def motion(amplitude, frequency):
    w = OMEGA * frequency
    x = amplitude * np.sin(w * TIME)
    return np.column_stack([x, amplitude * w * np.cos(w * TIME), -(w**2) * x])


def measured(*, noise=0.0):
    """Return columns of motion, force and records of 120 kg with 900 N s/m and 30 N of friction."""
    plan = [(0.01, 1), (0.02, 1), (0.005, 3), (0.01, 3)]
    columns = np.concatenate([motion(*test) for test in plan])
    v, a = columns[:, 1], columns[:, 2]
    force = 120.0 * a + 900.0 * v + 30.0 * np.tanh(v / 0.005)
    force += noise * np.random.default_rng(0).normal(size=force.size)
    return columns, force, np.repeat(np.arange(len(plan)), TIME.size)


def library():
    terms = ("inertia", "viscous-damping", "quadratic-damping", "stiffness", "coulomb-friction")
    return InerterLibrary(DT, terms=terms, transition_speed=0.005)


def test_a_pipeline_of_the_terms_finds_the_device_and_predicts_records_that_it_did_not_see():
    columns, force, records = measured(noise=2.0)
    pipeline = make_pipeline(library(), InerterRegressor(nonnegative=library().nonnegative))
    found = cross_validate(
        pipeline, columns, force, groups=records, cv=GroupKFold(4), return_estimator=True
    )
    assert found["test_score"].min() > 0.998
    for fitted in found["estimator"]:
        coefficients = fitted[-1].coef_
        assert np.flatnonzero(coefficients).tolist() == [0, 1, 4]
        np.testing.assert_allclose(coefficients[[0, 1, 4]], [120.0, 900.0, 30.0], rtol=0.03)


def test_columns_with_memory_are_made_record_by_record_before_the_folds():
    plan = [(0.01, 1), (0.02, 1), (0.005, 3), (0.01, 3)]
    terms = InerterLibrary(DT, terms=("inertia",), orders=(0.3, 0.5, 0.7), kind="weyl")
    columns = np.concatenate([np.asarray(terms.fit_transform(motion(*t)[:, :1])) for t in plan])
    force = columns @ [50.0, 0.0, 700.0, 0.0]
    search = GridSearchCV(
        InerterRegressor(exclusive=terms.exclusive), {"max_terms": [1, 2]}, cv=GroupKFold(4)
    )
    search.fit(columns, force, groups=np.repeat(np.arange(4), TIME.size))
    assert search.best_params_ == {"max_terms": 2}
    np.testing.assert_allclose(search.best_estimator_.coef_, [50.0, 0.0, 700.0, 0.0], atol=1e-6)


def test_signs_hold():
    columns, force, _ = measured()
    flipped = InerterRegressor(nonnegative=[0]).fit(columns[:, 2:], -force)
    np.testing.assert_array_equal(flipped.coef_, [0.0])


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"criterion": "aic"}, "InerterRegressor: criterion must be one of ebic, bic"),
        ({"max_terms": 0}, "max_terms must be a whole number >= 1, got 0"),
        ({"forced": [3]}, "forced must be column indices from 0 to 2, got 3"),
    ],
)
def test_parameters_are_checked_when_fitted(options, message):
    columns, force, _ = measured()
    with pytest.raises(InputError, match=message):
        InerterRegressor(**options).fit(columns, force)

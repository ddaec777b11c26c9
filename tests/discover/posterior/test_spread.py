"""How surely numbers are known: a mixture of normal posteriors over sizes, by its moments."""

from dataclasses import replace

import numpy as np
import pytest

from discover.posterior.climb import Place
from discover.posterior.model import Number
from discover.posterior.spread import SURE, Spread, idle, is_told, spread_of
from models.constitutive import FittedTerm
from tests.discover.posterior.small import (
    APART,
    assessor_of,
    dense,
    flat,
    model_of,
    of_formula,
    rows_of,
    whole_force,
)

HERE, THERE = Place((-12, -12, -12)), Place((-3, -12, -4))


def plain(t, x, v, a):
    return 120.0 * a + 800.0 * v


def assessed_of(law, model):
    assessor = assessor_of(rows_of(law, APART, cycles=3), friction=False)
    return assessor.assess(model, assessor.space.start)


@pytest.fixture(scope="module")
def device():
    return assessed_of(plain, model_of(inertia=100.0, viscous_damping=700.0))


def least_squares(assessed, place):
    """Return the posterior of the device's two coefficients at some sizes."""
    space = assessed.space
    columns = np.stack(
        [of_formula(space.sheet.rows, f) for f in (lambda t, x, v, a: a, lambda t, x, v, a: v)], 1
    )
    matrix, force = flat(columns), space.sheet.target.ravel()
    weighted = np.linalg.solve(dense(space, place.sizes(space.own_unit)), matrix)
    spread = whole_force(columns, space.sheet.target)
    covariance = np.linalg.inv(matrix.T @ weighted + np.diag(spread**-2.0))
    return covariance @ weighted.T @ force, covariance


@pytest.mark.parametrize("share", [0.3, 0.8])
def test_the_spread_is_that_of_the_mixture_over_sizes(device, share):
    visited = {HERE: 5.0 + np.log(1.0 - share), THERE: 5.0 + np.log(share)}
    found = spread_of(replace(device, visited=visited), device.model)
    means, covariances = zip(*(least_squares(device, p) for p in visited), strict=True)
    weights = [1.0 - share, share]
    mean = sum(w * m for w, m in zip(weights, means, strict=True))
    whole = sum(
        w * (c + np.outer(m, m)) for w, c, m in zip(weights, covariances, means, strict=True)
    ) - np.outer(mean, mean)
    centre = device.local.values
    whole = whole + np.outer(mean - centre, mean - centre)
    np.testing.assert_allclose(found.mean, centre)
    np.testing.assert_allclose(found.covariance, whole, rtol=1e-3)
    np.testing.assert_allclose(found.deviation, np.sqrt(np.diagonal(whole)), rtol=1e-3)


def test_numbers_that_predict_best_are_the_centre_and_their_distance_widens_it(device):
    visited = {HERE: 0.0}
    numbers = device.local.numbers
    elsewhere = device.model.with_values(numbers, [130.0, 790.0])
    found = spread_of(replace(device, visited=visited), elsewhere)
    mean, covariance = least_squares(device, HERE)
    away = mean - [130.0, 790.0]
    np.testing.assert_array_equal(found.mean, [130.0, 790.0])
    np.testing.assert_allclose(found.covariance, covariance + np.outer(away, away), rtol=1e-4)


def test_sizes_that_are_improbable_do_not_count(device):
    few = spread_of(replace(device, visited={HERE: 0.0}), device.model)
    more = spread_of(replace(device, visited={HERE: 0.0, THERE: -20.0}), device.model)
    np.testing.assert_allclose(more.covariance, few.covariance, rtol=1e-12)


def test_a_shape_counts_from_where_it_is():
    def powered(t, x, v, a):
        return 120.0 * a + 3e3 * np.sign(v) * np.abs(v) ** 1.6

    term = FittedTerm("power-law-damping", 2e3, {"exponent": 1.3})
    assessed = assessed_of(powered, model_of(inertia=100.0).plus(term))
    found = spread_of(assessed, assessed.model)
    place = found.numbers.index(Number(1, "exponent"))
    assert found.mean[place] == pytest.approx(1.6, abs=4.0 * found.deviation[place])
    assert 1e-4 < found.deviation[place] < 0.02


def test_an_interval_has_95_percent_and_stays_within_bounds():
    middle = np.array([3.0, 1.0])
    spread = Spread((Number(0, None), Number(1, None)), middle, middle, np.array([2.0, 0.5]),
                    np.array([[4.0, 0.1], [0.1, 0.25]]))  # fmt: skip
    np.testing.assert_allclose(spread.deviation, [2.0, 0.5])
    assert SURE == pytest.approx(1.96, abs=0.001)
    assert spread.interval(1, -9.0, 9.0) == pytest.approx((0.02, 1.98), abs=1e-3)
    assert spread.interval(0, 0.0, 5.0) == (0.0, 5.0)


def test_an_interval_holds_all_between_what_predicts_best_and_what_a_remainder_leaves(device):
    elsewhere = device.model.with_values(device.local.numbers, [130.0, 790.0])
    found = spread_of(replace(device, visited={HERE: 0.0}), elsewhere)
    mean, covariance = least_squares(device, HERE)
    half = 1.96 * np.sqrt(np.diagonal(covariance))
    for i, value in enumerate((130.0, 790.0)):
        low, high = found.interval(i, -np.inf, np.inf)
        assert low == pytest.approx(min(value, mean[i]) - half[i], rel=1e-6)
        assert high == pytest.approx(max(value, mean[i]) + half[i], rel=1e-6)


def test_what_the_records_do_not_hold_is_idle_the_least_sure_first():
    model = model_of(
        cubic_stiffness=1e3, inertia=100.0, force_offset=1.0, quadratic_damping=1.0,
        viscous_damping=700.0,
    )  # fmt: skip
    assessed = assessed_of(plain, model)
    found = idle(assessed.predicting)
    assert set(found) == {0, 2, 3}
    spread = spread_of(replace(assessed, visited={assessed.place: 0.0}), assessed.model)
    sure = spread.mean / spread.deviation
    sure[[0, 2]] = np.abs(sure[[0, 2]])
    assert found == sorted(found, key=lambda k: sure[k])


def test_a_coefficient_of_the_wrong_sign_is_idle_however_sure():
    def driven(t, x, v, a):
        return 120.0 * a - 300.0 * v + 3e4 * x

    model = model_of(inertia=100.0, viscous_damping=50.0, stiffness=-1e3)
    assert idle(assessed_of(driven, model).predicting) == [1]


def test_a_sure_negative_coefficient_is_not_idle_where_it_may_be_negative():
    def softening(t, x, v, a):
        return 120.0 * a + 800.0 * v - 2e4 * x

    assessed = assessed_of(
        softening, model_of(inertia=100.0, viscous_damping=700.0, stiffness=1.0)
    )
    assert idle(assessed.predicting) == []
    assert is_told(assessed, [2])


def test_the_sign_of_what_the_force_holds_is_told_and_of_nothing_it_is_not():
    model = model_of(inertia=100.0, viscous_damping=700.0, stiffness=1.0, force_offset=1.0)
    assessed = assessed_of(plain, model)
    assert is_told(assessed, [0])
    assert is_told(assessed, [1, 2])
    assert not is_told(assessed, [2, 3])
    assert not is_told(assessed, [])


def test_a_shape_that_is_sure_tells_nothing_of_its_term():
    term = FittedTerm("power-law-damping", 1.0, {"exponent": 1.6})
    model = model_of(inertia=100.0, viscous_damping=700.0).plus(term)
    assessed = assessed_of(plain, model)
    assert not is_told(assessed, [2])


def fractional(order):
    """Return the law of a derivative of a sine beside a third harmonic that no term has."""
    def law(t, x, v, a):
        omega = np.abs(v).max() / np.abs(x).max()
        turn = 0.5 * np.pi * order
        own = omega**order * (x * np.cos(turn) + v / omega * np.sin(turn))
        phase = np.arctan2(v / np.abs(v).max(), x / np.abs(x).max())
        return 5e3 * own + 500.0 * np.abs(own).max() * np.cos(3.0 * phase)

    return law


@pytest.mark.parametrize(("order", "place"), [(0.0, [0]), (0.5, []), (2.0, [0])])
def test_a_derivative_whose_order_is_that_of_a_spring_or_a_mass_is_no_fractional_one(order, place):
    start = model_of().plus(FittedTerm("fractional-derivative", 1e3, {"order": 0.4 + 0.6 * order}))
    assert idle(assessed_of(fractional(order), start).predicting) == place

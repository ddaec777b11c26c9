"""A model's posterior around its values, and its best values, by least squares and densities."""

import numpy as np
import pytest
from scipy.optimize import minimize
from scipy.special import log_ndtr, logsumexp

from discover.posterior.covariance import Sizes
from discover.posterior.local import fitted, judged, local_of, shape_bounds
from discover.posterior.model import Composite, Number, Placed
from discover.posterior.space import departures
from models.constitutive import FittedTerm
from tests.discover.posterior.small import (
    APART,
    assessor_of,
    dense,
    flat,
    log_density,
    model_of,
    of_formula,
    rows_of,
    whole_force,
    widened,
)

SIZES = Sizes(0.02, (0.005, 0.001), 2.0)


def damped(t, x, v, a):
    return 120.0 * a + 800.0 * v + 40.0 * np.tanh(v / 2e-3)


def powered(exponent, size=3e3):
    def law(t, x, v, a):
        return 120.0 * a + size * np.sign(v) * np.abs(v) ** exponent

    return law


def driven(t, x, v, a):
    """Damping of the wrong sign."""
    return 120.0 * a - 300.0 * v + 3e4 * x


@pytest.fixture(scope="module")
def linear():
    return assessor_of(rows_of(damped, APART, cycles=3))


def around(assessor, model, sizes=SIZES, curve=None):
    """Return a model's linear form, and its evidence."""
    local = local_of(assessor.space, assessor.evaluator, model)
    return local, judged(local, local.beside(assessor.space, curve), sizes)


def ridge(columns, spread, force, covariance):
    """Return the mean (K,) and covariance (K, K) of coefficients of columns (U, K, R)."""
    matrix = flat(columns)
    weighted = np.linalg.solve(covariance, matrix)
    whole = np.linalg.inv(matrix.T @ weighted + np.diag(spread**-2.0))
    return whole @ weighted.T @ force, whole


def law_columns(rows):
    return np.stack([of_formula(rows, f) for f in (lambda t, x, v, a: a, lambda t, x, v, a: v)], 1)


def test_evidence_is_that_of_the_whole_covariance_whatever_the_values(linear):
    rows, space = linear.space.sheet.rows, linear.space
    columns = law_columns(rows)
    force = space.sheet.target
    spread = whole_force(columns, force)
    whole = widened(dense(space, SIZES), columns, spread)
    expected = log_density(force.ravel(), whole) + 2.0 * np.log(2.0)  # both signs are sure
    mean, covariance = ridge(columns, spread, force.ravel(), dense(space, SIZES))
    for values in ((100.0, 700.0), (5.0, 3000.0)):
        local, found = around(linear, model_of(inertia=values[0], viscous_damping=values[1]))
        np.testing.assert_allclose(local.spread, spread, rtol=1e-6)
        np.testing.assert_array_equal(local.sign, [1.0, 1.0])
        assert found.value == pytest.approx(expected, rel=1e-6)
        np.testing.assert_allclose(found.solved.mean, mean, rtol=1e-5)
        np.testing.assert_allclose(found.solved.covariance, covariance, rtol=1e-4)


def test_evidence_beside_friction_s_curve_is_the_mean_over_its_scales(linear):
    space, part = linear.space, departures(linear.friction, None)
    model = model_of(inertia=100.0, viscous_damping=700.0, coulomb_friction=30.0)
    columns = np.concatenate(
        [law_columns(space.sheet.rows), space.columns[:, linear.friction.columns[:1]]], axis=1
    )
    force = space.sheet.target
    spread = whole_force(columns, force)
    bank = space.columns[:, part.columns]
    wide = [widened(dense(space, SIZES), bank, s * part.spread) for s in part.scales]
    each = []
    for covariance in wide:
        mean, width = ridge(columns, spread, force.ravel(), covariance)
        value = log_density(force.ravel(), widened(covariance, columns, spread))
        signs = np.log(2.0) + log_ndtr(mean / np.sqrt(np.diagonal(width)))
        each.append((value + float(signs.sum()), mean))
    _, found = around(linear, model, curve=part)
    values = np.array([e[0] for e in each])
    assert found.value == pytest.approx(float(logsumexp(values)) - np.log(values.size), abs=1e-3)
    best = int(values.argmax())
    assert found.scale == part.scales[best]
    np.testing.assert_allclose(found.solved.mean, each[best][1], rtol=1e-3)


def test_a_shape_s_posterior_is_that_of_its_slope(linear):
    rows = rows_of(powered(1.6), APART, cycles=3)
    assessor = assessor_of(rows, friction=False)
    exponent, size = 1.5, 2500.0
    term = FittedTerm("power-law-damping", size, {"exponent": exponent})
    local, found = around(assessor, model_of(inertia=120.0).plus(term))
    unit = of_formula(rows, lambda t, x, v, a: np.sign(v) * np.abs(v) ** exponent)

    def slope(t, x, v, a):
        return size * np.sign(v) * np.abs(v) ** exponent * np.log(np.maximum(np.abs(v), 1e-300))

    columns = np.stack([law_columns(rows)[:, 0], unit, of_formula(rows, slope)], axis=1)
    force = assessor.space.sheet.target
    spread = whole_force(columns, force)
    spread[2] = (3.0 - 0.25) / np.sqrt(12.0)  # as spread evenly between bounds
    assert [n.shape for n in local.numbers] == [None, None, "exponent"]
    np.testing.assert_allclose(local.spread, spread, rtol=1e-6)
    np.testing.assert_array_equal(local.values, [120.0, size, 0.0])
    np.testing.assert_array_equal(local.sign, [1.0, 1.0, 0.0])
    mean, covariance = ridge(columns, spread, force.ravel(), dense(assessor.space, SIZES))
    deviation = np.sqrt(np.diagonal(covariance))
    assert abs(mean[2]) > 5.0 * deviation[2]
    np.testing.assert_allclose(found.solved.mean, mean, rtol=0.01)
    np.testing.assert_allclose(
        found.solved.covariance / np.outer(deviation, deviation),
        covariance / np.outer(deviation, deviation), atol=0.02,
    )  # fmt: skip


def best_of(assessor, model, numbers=None, iterations=12):
    local = local_of(assessor.space, assessor.evaluator, model, numbers)
    return fitted(
        assessor.space, assessor.evaluator, local, SIZES, None, iterations=iterations
    )


def test_the_best_values_of_a_linear_model_are_those_of_least_squares(linear):
    columns = law_columns(linear.space.sheet.rows)
    force = linear.space.sheet.target
    mean, covariance = ridge(
        columns, whole_force(columns, force), force.ravel(), dense(linear.space, SIZES)
    )
    found = best_of(linear, model_of(inertia=3.0, viscous_damping=9e3))
    wide = np.sqrt(np.diagonal(covariance))
    np.testing.assert_allclose((found.values - mean) / wide, 0.0, atol=1e-3)
    assert not np.any(found.held)
    np.testing.assert_allclose(
        found.force, np.einsum("p,upr->ur", mean, columns), atol=1e-3 * np.abs(force).max()
    )


def test_numbers_that_are_not_free_stay(linear):
    model = model_of(inertia=90.0, viscous_damping=9e3)
    found = best_of(linear, model, [Number(1, None)])
    columns, force = law_columns(linear.space.sheet.rows), linear.space.sheet.target
    left = (force - 90.0 * columns[:, 0]).ravel()
    spread = whole_force(columns[:, 1:], force)
    mean, _ = ridge(columns[:, 1:], spread, left, dense(linear.space, SIZES))
    assert found.model.value(Number(0, None)) == 90.0
    assert found.model.value(Number(1, None)) == pytest.approx(mean[0], rel=1e-4)


def test_a_coefficient_that_may_not_be_negative_is_held_at_zero_and_others_make_up_for_it():
    rows = rows_of(driven, APART, cycles=3)
    assessor = assessor_of(rows, friction=False)
    found = best_of(assessor, model_of(inertia=100.0, viscous_damping=50.0, stiffness=-1e3))
    columns = np.stack([law_columns(rows)[:, 0], of_formula(rows, lambda t, x, v, a: x)], axis=1)
    force = assessor.space.sheet.target
    mean, covariance = ridge(
        columns, whole_force(columns, force), force.ravel(), dense(assessor.space, SIZES)
    )
    assert found.values[1] == pytest.approx(0.0, abs=1e-200)
    np.testing.assert_array_equal(found.held, [False, True, False])
    wide = np.sqrt(np.diagonal(covariance))
    np.testing.assert_allclose((found.values[[0, 2]] - mean) / wide, 0.0, atol=1e-2)


def density(rows, space, covariance):
    """Return the density of the measured force, by inertia, size and exponent of damping."""
    target = space.sheet.target.ravel()
    inertia = of_formula(rows, lambda t, x, v, a: a).ravel()

    def value(numbers):
        mass, size, exponent = numbers
        column = of_formula(rows, lambda t, x, v, a: np.sign(v) * np.abs(v) ** exponent).ravel()
        return log_density(target - 100.0 * mass * inertia - 1e3 * size * column, covariance)

    return value


@pytest.mark.parametrize("start", [0.8, 2.6])
def test_a_fit_from_a_wrong_shape_ends_where_the_density_is_greatest(start):
    rows = rows_of(powered(1.6), APART, cycles=3)
    assessor = assessor_of(rows, friction=False)
    term = FittedTerm("power-law-damping", 500.0, {"exponent": start})
    found = best_of(assessor, model_of(inertia=20.0).plus(term), iterations=30)
    value = density(rows, assessor.space, dense(assessor.space, SIZES))
    best = minimize(lambda n: -value(n), [1.2, 3.0, 1.6], method="Nelder-Mead",
                    options={"xatol": 1e-7, "fatol": 1e-7, "maxiter": 2000})  # fmt: skip
    here = [found.values[0] / 100.0, found.values[1] / 1e3, found.model.value(found.numbers[2])]
    assert value(here) > -best.fun - 0.01
    assert here[2] == pytest.approx(best.x[2], abs=2e-3)


def test_a_shape_stays_within_its_bounds():
    rows = rows_of(powered(3.4, 2e4), APART, cycles=3)
    assessor = assessor_of(rows, friction=False)
    term = FittedTerm("power-law-damping", 500.0, {"exponent": 2.0})
    found = best_of(assessor, model_of(inertia=100.0).plus(term))
    assert found.model.value(found.numbers[2]) == 3.0
    cube = of_formula(rows, lambda t, x, v, a: v**3)
    columns = np.stack([of_formula(rows, lambda t, x, v, a: a), cube], axis=1)
    force = assessor.space.sheet.target
    mean, covariance = ridge(
        columns, whole_force(columns, force), force.ravel(), dense(assessor.space, SIZES)
    )
    wide = np.sqrt(np.diagonal(covariance))
    np.testing.assert_allclose((found.values[:2] - mean) / wide, 0.0, atol=0.02)


def test_no_step_is_longer_than_half_of_a_shape():
    rows = rows_of(powered(2.9), APART, cycles=3)
    assessor = assessor_of(rows, friction=False)
    term = FittedTerm("power-law-damping", 500.0, {"exponent": 1.0})
    found = best_of(assessor, model_of(inertia=120.0).plus(term), iterations=1)
    assert 1.0 < found.model.value(found.numbers[2]) <= 1.5


def test_a_fit_gains_with_every_step_and_goes_on_from_where_it_stopped():
    rows = rows_of(powered(1.6), APART, cycles=3)
    assessor = assessor_of(rows, friction=False)
    value = density(rows, assessor.space, dense(assessor.space, SIZES))
    term = FittedTerm("power-law-damping", 500.0, {"exponent": 2.6})
    model, last = model_of(inertia=20.0).plus(term), -np.inf
    for _ in range(4):
        model = best_of(assessor, model, iterations=1).model
        mass, size, exponent = (model.value(n) for n in model.numbers)
        now = value([mass / 100.0, size / 1e3, exponent])
        assert now > last
        last = now
    assert exponent == pytest.approx(1.6, abs=0.05)


def test_a_model_without_free_numbers_is_as_it_was(linear):
    model = Composite(tuple(Placed(p.fitted, held=True) for p in model_of(inertia=90.0).terms))
    local = local_of(linear.space, linear.evaluator, model)
    assert local.numbers == ()
    assert fitted(linear.space, linear.evaluator, local, SIZES, None) is local
    force = linear.space.sheet.target - 90.0 * law_columns(linear.space.sheet.rows)[:, 0]
    found = judged(local, local.beside(linear.space, None), SIZES)
    expected = log_density(force.ravel(), dense(linear.space, SIZES))
    assert found.value == pytest.approx(expected, rel=1e-6)


def test_coefficients_that_have_a_least_and_a_greatest_value_are_spread_no_wider(linear):
    gain = FittedTerm("sensor-gain", 1e-3, {"filter_time": 0.05})
    droop = FittedTerm("sensor-gain", -1e-3, {"droop_time": 0.5})
    model = model_of(inertia=100.0, viscous_damping=700.0).plus(gain, droop)
    local = local_of(linear.space, linear.evaluator, model)
    at = [i for i, n in enumerate(local.numbers) if n.shape is None]
    assert local.spread[at[2]] == pytest.approx(0.3)
    assert local.spread[at[3]] == pytest.approx(1.0)
    np.testing.assert_array_equal(local.sign[at], [1.0, 1.0, 0.0, -1.0])
    assert not local.held[at[3]]


def test_bounds_of_a_shape_are_in_the_campaign_s_sizes_and_hold_its_value(linear):
    scales = linear.space.scales
    assert scales.displacement == pytest.approx(0.02, rel=1e-3)
    for value, expected in ((0.03, (0.0202, 0.2)), (1e-3, (1e-3, 0.2)), (0.5, (0.0202, 0.5))):
        model = Composite((Placed(FittedTerm("cubic-stiffness", 1.0, {"closure": value})),))
        found = shape_bounds(model, Number(0, "closure"), scales)
        assert found == pytest.approx(expected, rel=2e-3)

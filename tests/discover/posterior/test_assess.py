"""A model's evidence over the sizes of what it leaves, and what it predicts, by dense matrices."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.special import logsumexp

from discover.motion_fit import observe_all
from discover.posterior.assess import is_quiet
from discover.posterior.climb import Place
from discover.posterior.left_out import is_needed
from discover.posterior.model import Number
from discover.rows import record_rows
from models.constitutive import FittedTerm
from tests.discover.gap_data import record
from tests.discover.posterior.small import (
    APART,
    assessor_of,
    dense,
    flat,
    log_density,
    model_of,
    of_formula,
    random_rows,
    rows_of,
    whole_force,
    widened,
)

DEVICE = model_of(inertia=100.0, viscous_damping=700.0)


def plain(t, x, v, a):
    return 120.0 * a + 800.0 * v


def missing(t, x, v, a):
    """A device with what no linear term has."""
    return 120.0 * a + 800.0 * v + 40.0 * np.cos(3.0 * np.arctan2(v / np.abs(v).max(), x))


def rubbing(t, x, v, a):
    return 120.0 * a + 800.0 * v + 40.0 * np.tanh(v / 2e-3)


def assessed_of(law, model=DEVICE, *, friction=False, refit=True):
    assessor = assessor_of(rows_of(law, APART, cycles=3), friction=friction)
    return assessor.assess(model, assessor.space.start, refit=refit)


@pytest.fixture(scope="module")
def right():
    return assessed_of(plain)


@pytest.fixture(scope="module")
def wrong():
    return assessed_of(missing)


def linear_columns(space):
    return np.stack(
        [of_formula(space.sheet.rows, f) for f in (lambda t, x, v, a: a, lambda t, x, v, a: v)], 1
    )


def evidence(assessed, place):
    """Return the log evidence of the linear device at some sizes."""
    space = assessed.space
    columns, force = linear_columns(space), space.sheet.target
    covariance = dense(space, place.sizes(space.own_unit))
    whole = widened(covariance, columns, whole_force(columns, force))
    return log_density(force.ravel(), whole) + 2.0 * np.log(2.0)


@pytest.mark.parametrize("which", ["right", "wrong"])
def test_evidence_is_summed_over_all_sizes_that_were_looked_at(which, request):
    assessed = request.getfixturevalue(which)
    assert assessed.value == pytest.approx(float(logsumexp(list(assessed.visited.values()))))
    assert assessed.space.quiet in assessed.visited
    some = sorted(assessed.visited, key=lambda p: -assessed.visited[p])[::3]
    for place in some:
        assert assessed.visited[place] == pytest.approx(evidence(assessed, place), rel=1e-4)


@pytest.mark.parametrize("which", ["right", "wrong"])
def test_its_place_is_that_of_the_most_evidence_and_its_numbers_are_the_best_there(which, request):
    assessed = request.getfixturevalue(which)
    best = max(assessed.visited.values())
    assert assessed.visited[assessed.place] > best - 0.1
    assert assessed.judged.value == pytest.approx(assessed.visited[assessed.place])
    space = assessed.space
    columns, force = linear_columns(space), space.sheet.target
    found, wide = least_squares(
        columns, force, dense(space, assessed.place.sizes(space.own_unit)),
    )  # fmt: skip
    np.testing.assert_allclose((assessed.local.values - found) / wide, 0.0, atol=0.05)


def least_squares(columns, force, covariance):
    """Return coefficients (K,) and their deviations, with the prior of the whole force's size."""
    matrix = flat(columns)
    weighted = np.linalg.solve(covariance, matrix)
    precision = matrix.T @ weighted + np.diag(whole_force(columns, force) ** -2.0)
    width = np.linalg.inv(precision)
    return width @ weighted.T @ force.ravel(), np.sqrt(np.diagonal(width))


def test_a_right_model_leaves_noise_and_a_wrong_one_more(right, wrong):
    assert right.quiet
    assert not wrong.quiet
    assert wrong.place.remainder > right.place.remainder or (
        wrong.place.loudest > right.place.loudest
    )


def test_sizes_follow_what_is_left(wrong):
    space = wrong.space
    left = space.sheet.target - wrong.local.force
    covariance = dense(space, wrong.place.sizes(space.own_unit))
    square = float(left.ravel() @ np.linalg.solve(covariance, left.ravel()))
    # Beside the right sizes what is left is as large as it is expected to be.
    assert 0.5 < square / left.size < 1.5


def test_a_model_that_leaves_noise_predicts_by_the_same_numbers(right):
    assert right.predicting is right


def test_where_more_is_left_the_terms_alone_come_closest(wrong):
    assert wrong.place.remainder > -10  # else nothing is shown
    found = wrong.predicting
    space = wrong.space
    quiet = Place.quiet(len(found.place.powers) - 2).powers
    assert found.place.powers == quiet
    columns, force = linear_columns(space), space.sheet.target
    values = {power: evidence(wrong, Place(quiet, power)) for power in range(-12, 1)}
    assert found.place.flat == max(values, key=lambda k: values[k])
    expected, wide = least_squares(columns, force, dense(space, found.place.sizes(1.0)))
    np.testing.assert_allclose((found.local.values - expected) / wide, 0.0, atol=0.05)
    assert found.judged.value == pytest.approx(values[found.place.flat], rel=1e-4)
    assert set(found.visited) == {Place(quiet, k) for k in range(-12, 1)}


def test_a_model_as_it_is_given_keeps_its_numbers_and_is_judged_at_them():
    given = assessed_of(plain, model_of(inertia=118.0, viscous_damping=800.0), refit=False)
    assert given.model.terms[0].fitted.coefficient == 118.0
    space = given.space
    columns = linear_columns(space)
    left = (space.sheet.target - 118.0 * columns[:, 0] - 800.0 * columns[:, 1]).ravel()
    expected = log_density(left, dense(space, given.place.sizes(space.own_unit)))
    assert given.visited[given.place] == pytest.approx(expected, rel=1e-5)
    assert not given.quiet
    assert given.predicting is given


def test_a_glance_has_the_evidence_at_its_sizes_on_coarse_rows(right):
    assessor, place = right.assessor, Place((-8, -8, -9))
    model, value = assessor.glance(model_of(inertia=20.0, viscous_damping=9e3), place, iterations=9)
    assert value == pytest.approx(evidence(right, place), abs=0.5)
    assert model.value(Number(0, None)) == pytest.approx(120.0, rel=0.01)


def test_small_sizes_that_are_not_ruled_out_may_be_all():
    quiet, loud = Place((-12, -12, -12)), Place((-2, -12, -12))
    assert is_quiet({quiet: 0.0})
    assert is_quiet({quiet: 0.0, loud: 0.0})
    assert is_quiet({quiet: 9.0, loud: 0.0})
    assert not is_quiet({quiet: 0.0, loud: 9.0})
    assert not is_quiet({loud: 0.0})


@pytest.mark.parametrize("powers", [(-1, -12, -12), (-12, -12, -1), (-12, 0, -12)])
def test_a_remainder_an_error_or_friction_of_any_size_is_no_noise(powers):
    assert not is_quiet({Place(powers): 20.0, Place.quiet(1): 0.0})


def test_an_error_of_either_kind_is_no_noise():
    assert is_quiet({Place.quiet(2): 20.0})
    assert not is_quiet({Place((-12, -12, -12, -1)): 20.0})
    assert not is_quiet({Place((-12, -12, -1, -12)): 20.0})


def test_some_friction_of_a_record_s_own_is_ordinary():
    assert is_quiet({Place((-12, -6, -12)): 20.0, Place.quiet(1): 0.0})


def test_the_curve_is_open_to_models_with_that_friction_only():
    assessor = assessor_of(rows_of(rubbing, APART, cycles=3))
    assert assessor.curve_of(DEVICE) is None
    rubbed = DEVICE.plus(FittedTerm("coulomb-friction", 40.0))
    whole = assessor.curve_of(rubbed)
    assert len(whole.terms) == len(assessor.friction.terms) - 1
    assert {t.id for t in whole.terms} == {"coulomb-friction", "stribeck-friction"}
    unnamed = replace(assessor, named=False)
    some = unnamed.curve_of(rubbed)
    assert {t.id for t in some.terms} == {"coulomb-friction"}
    assert all(t.shape["presliding"] == 0.0 for t in some.terms)
    stribeck = FittedTerm("stribeck-friction", 9.0, {"stribeck_velocity": 0.02})
    more = unnamed.curve_of(rubbed.plus(stribeck))
    assert {t.id for t in more.terms} == {"coulomb-friction", "stribeck-friction"}
    assert replace(assessor, friction=None).curve_of(rubbed) is None


def test_friction_s_curve_takes_up_what_a_plain_jump_is_not():
    model = DEVICE.plus(FittedTerm("coulomb-friction", 30.0))
    with_curve = assessed_of(rubbing, model, friction=True)
    without = assessed_of(rubbing, model)
    assert with_curve.quiet
    assert with_curve.value > without.value + 10.0
    assert with_curve.curve is not None and without.curve is None
    assert with_curve.local.values[0] == pytest.approx(120.0, rel=0.01)
    assert with_curve.local.values[1] == pytest.approx(800.0, rel=0.02)


def test_friction_s_curve_is_as_the_model_s_sensors_pass_it_on():
    assessor = assessor_of(rows_of(rubbing, APART, cycles=3))
    plain_columns = assessor.space.columns[:, assessor.friction.columns]
    model = DEVICE.plus(FittedTerm("sensor-gain", 0.25))
    changed = assessor.behind(model)
    np.testing.assert_allclose(
        changed.columns, 1.25 * plain_columns, atol=1e-7 * np.abs(plain_columns).max()
    )
    np.testing.assert_allclose(
        changed.own, 1.25 * assessor.space.own, atol=1e-7 * np.abs(assessor.space.own).max()
    )
    assert changed.own_unit == assessor.space.own_unit
    assert assessor.behind(DEVICE) is assessor.space
    assert replace(assessor, friction=None).behind(model) is assessor.space


def test_a_sensor_s_gain_that_differs_from_test_to_test_is_found():
    """A gain from the third test on: told from the device's own size by the tests before."""
    rng = np.random.default_rng(0)
    tests = []
    for n, (f, a) in enumerate(APART):
        factor = 1.0 if n < 2 else 1.1
        tests.append(
            record(f, a, lambda t, x, v, a, s=factor: s * rubbing(t, x, v, a), rng, cycles=3)
        )
    assessor = assessor_of([record_rows(o) for o in observe_all(tests, 1)])
    model = DEVICE.plus(
        FittedTerm("coulomb-friction", 30.0), FittedTerm("sensor-gain", 0.01, {"from_test": 3.0})
    )
    found = assessor.assess(model, assessor.space.start)
    assert found.quiet
    assert found.model.terms[3].fitted.coefficient == pytest.approx(0.1, abs=0.005)
    assert found.model.terms[0].fitted.coefficient == pytest.approx(120.0, rel=0.01)


def test_a_record_of_many_lines_counts_no_more_than_one_of_few_where_terms_alone_predict():
    """By their lines the random record of another damping would be met, and the sine tests not."""
    rows = [*rows_of(lambda t, x, v, a: 120.0 * a + 300.0 * v, APART), random_rows()]
    assert rows[-1].size.size > 10 * rows[0].size.size
    assessor = assessor_of(rows, friction=False)
    space = assessor.space
    found = assessor.assess(DEVICE, space.start).predicting.model
    terms = (FittedTerm("inertia", 1.0), FittedTerm("viscous-damping", 1.0))
    matrix, side = [], []
    for r in rows:
        force = float(np.linalg.norm(r.target / r.size))
        matrix.append(space.columns_of(r, terms).T / r.size[:, None] / force)
        side.append(r.target / r.size / force)
    alike = np.linalg.lstsq(np.concatenate(matrix), np.concatenate(side), rcond=None)[0]
    for number, expected in zip(found.numbers, alike, strict=True):
        assert found.value(number) == pytest.approx(expected, rel=0.05)
    assert alike[1] < 600.0  # of 300 and 800


@pytest.mark.filterwarnings("ignore::RuntimeWarning")
def test_a_model_whose_force_is_not_finite_is_none():
    """As of a joint that shakes itself apart: no search ends in it, and a sound one is needed."""
    assessor = assessor_of(rows_of(plain, APART, cycles=3), friction=False)
    sound = assessor.assess(DEVICE, assessor.space.start)
    broken = assessor.assess(model_of(inertia=1e308, viscous_damping=1e308), sound.place)
    assert broken.value == -np.inf
    assert broken.predicting is broken
    assert is_needed(broken, sound)

"""What trials gain: the difference of log evidence with and without them, by dense matrices."""

import numpy as np
import pytest
from scipy.special import log_ndtr

from discover.posterior.covariance import Sizes
from discover.posterior.local import local_of
from discover.posterior.model import Composite, Placed
from discover.posterior.weigh import Trial, Trials, gains
from models.constitutive import FittedTerm
from tests.discover.posterior.small import (
    APART,
    assessor_of,
    dense,
    flat,
    log_density,
    model_of,
    rows_of,
    whole_force,
    widened,
)

SIZES = Sizes(0.03, (0.01, 0.002), 3.0)
MODEL = model_of(inertia=100.0, viscous_damping=700.0)


def law(t, x, v, a):
    return 120.0 * a + 800.0 * v + 2e4 * x + 40.0 * np.tanh(v / 2e-3)


def bare(t, x, v, a):
    return 120.0 * a + 800.0 * v


@pytest.fixture(scope="module")
def assessor():
    return assessor_of(rows_of(law, APART, cycles=3))


@pytest.fixture(scope="module")
def bare_assessor():
    return assessor_of(rows_of(bare, APART, cycles=3))


def trials(assessor, entries, model=MODEL):
    flat_terms = [t for terms, _ in entries for t in terms]
    ends = np.cumsum([0, *(len(terms) for terms, _ in entries)])
    made = tuple(
        Trial(tuple(terms), np.arange(ends[i], ends[i + 1]), prior)
        for i, (terms, prior) in enumerate(entries)
    )
    return Trials(made, assessor.evaluator.trials(model, flat_terms))


def weighed(assessor, entries, *, model=MODEL, curve=None):
    """Return the gains, and trials' columns, as they stand."""
    made = trials(assessor, entries, model)
    local = local_of(assessor.space, assessor.evaluator, model)
    return gains(assessor.space, made, local, SIZES, curve), made


def beside(assessor, model=MODEL):
    """Return the covariance of the measured force with a linear model's terms in it."""
    columns = np.stack([assessor.evaluator.unit(p.fitted) for p in model.terms], axis=1)
    target = assessor.space.sheet.target
    return widened(dense(assessor.space, SIZES), columns, whole_force(columns, target))


def expected(columns, spread, force, covariance):
    """Return the gain without signs, and the posterior's mean and deviations."""
    before = log_density(force, covariance)
    whole = widened(covariance, columns, spread)
    matrix = flat(columns)
    pull = np.diag(spread**2) @ matrix.T @ np.linalg.inv(whole)
    left = np.diag(spread**2) - pull @ matrix @ np.diag(spread**2)
    return log_density(force, whole) - before, pull @ force, np.sqrt(np.diagonal(left))


def one(id, **shape):
    return [FittedTerm(id, 1.0, shape)]


@pytest.mark.parametrize("with_curve", [False, True])
@pytest.mark.parametrize("records", ["assessor", "bare_assessor"])
def test_a_gain_is_the_difference_of_log_evidence_with_the_column_and_without(
    records, with_curve, request
):
    assessor = request.getfixturevalue(records)
    entries = [
        (one("stiffness"), -1.5), (one("cubic-stiffness"), -2.0), (one("force-offset"), 0.0),
        (one("quadratic-damping"), -0.5), (one("power-law-damping", exponent=0.5), -1.0),
    ]  # fmt: skip
    curve = assessor.curve_of(model_of(coulomb_friction=1.0)) if with_curve else None
    found, made = weighed(assessor, entries, curve=curve)
    space, covariance = assessor.space, beside(assessor)
    force = space.sheet.target.ravel()
    if curve is not None:
        bank = space.columns[:, curve.columns]
        covariance = max(
            (widened(covariance, bank, s * curve.spread) for s in curve.scales),
            key=lambda whole: log_density(force, whole),
        )
    for gain in found:
        column = made.columns[:, gain.trial.places]
        spread = whole_force(column, space.sheet.target)
        plain, mean, deviation = expected(column, spread, force, covariance)
        if gain.trial.id in ("quadratic-damping", "power-law-damping"):
            plain += np.log(2.0) + log_ndtr(mean[0] / deviation[0])
        assert gain.value == pytest.approx(plain + gain.trial.log_prior, rel=1e-5, abs=1e-4)
        assert gain.coefficients[0] == pytest.approx(mean[0], rel=1e-4, abs=1e-4 * spread[0])
    assert [g.value for g in found] == sorted((g.value for g in found), reverse=True)


def test_what_the_force_holds_gains_most(assessor):
    entries = [(one(i), 0.0) for i in ("cubic-stiffness", "stiffness", "force-offset")]
    found, _ = weighed(assessor, entries, curve=assessor.curve_of(model_of(coulomb_friction=1.0)))
    assert found[0].trial.id == "stiffness"
    assert found[0].coefficients[0] == pytest.approx(2e4, rel=0.05)
    assert found[0].value > 20.0 + found[1].value


@pytest.mark.parametrize(("id", "shape", "cut"), [
    ("sensor-gain", {"droop_time": 0.3}, -1.0), ("time-delay", {"filter_order": 1.0}, 1.0),
    ("time-delay", {}, 0.0), ("sensor-gain", {"filter_time": 0.02}, 0.0),
    ("sensor-gain", {}, 0.0),
])  # fmt: skip
def test_what_a_coefficient_may_not_be_is_no_part_of_its_prior(assessor, id, shape, cut):
    probe = -1e-4 if cut < 0.0 else 1e-4
    found, made = weighed(assessor, [([FittedTerm(id, probe, shape)], 0.0)])
    force = assessor.space.sheet.target
    size = whole_force(made.columns, force)[0]
    if id == "sensor-gain":
        size = min(size, 0.3 if "filter_time" in shape else 1.0)
    value, mean, deviation = expected(
        made.columns, np.array([size]), force.ravel(), beside(assessor)
    )
    if cut:
        value += np.log(2.0) + log_ndtr(cut * mean[0] / deviation[0])
    assert found[0].value == pytest.approx(value, rel=1e-5, abs=1e-4)
    assert found[0].coefficients[0] == pytest.approx(mean[0], rel=1e-4, abs=1e-4 * size)


def test_columns_that_are_tried_together_gain_together(assessor):
    terms = [
        FittedTerm("position-dependent-friction", 1.0, {"power": p, "transition_speed": 0.01})
        for p in (1.0, 2.0)
    ]
    found, made = weighed(assessor, [(one("stiffness"), 0.0), (terms, -0.7)])
    gain = next(g for g in found if len(g.trial.terms) == 2)
    force = assessor.space.sheet.target
    column = made.columns[:, [1, 2]]
    value, mean, _ = expected(
        column, whole_force(column, force), force.ravel(), beside(assessor)
    )
    assert gain.value == pytest.approx(value - 0.7, rel=1e-5, abs=1e-4)
    np.testing.assert_allclose(gain.coefficients, mean, rtol=1e-3)


def test_many_trials_at_once_are_each_alone(assessor):
    entries = [(one("power-law-damping", exponent=p), -p) for p in np.linspace(0.3, 2.9, 90)]
    entries.insert(40, ([*one("stiffness"), *one("cubic-stiffness")], 0.0))
    found, _ = weighed(assessor, entries)
    assert len(found) == len(entries)
    for entry in (*entries[::11], entries[40], entries[-1]):
        (alone,), _ = weighed(assessor, [entry])
        gain = next(g for g in found if g.trial.terms == tuple(entry[0]))
        assert gain.value == pytest.approx(alone.value, rel=1e-6, abs=1e-6)
        np.testing.assert_allclose(gain.coefficients, alone.coefficients, rtol=1e-5)


def test_a_term_that_its_sign_holds_at_zero_takes_nothing_from_what_joins(assessor):
    held = model_of(inertia=100.0, viscous_damping=0.0)
    entries = [(one("quadratic-damping"), 0.0)]
    found, made = weighed(assessor, entries, model=held)
    force = assessor.space.sheet.target
    value, mean, deviation = expected(
        made.columns, whole_force(made.columns, force), force.ravel(),
        beside(assessor, model_of(inertia=100.0)),
    )  # fmt: skip
    value += np.log(2.0) + log_ndtr(mean[0] / deviation[0])
    assert found[0].value == pytest.approx(value, rel=1e-5)
    assert found[0].coefficients[0] == pytest.approx(mean[0], rel=1e-4)


def test_a_column_that_is_nowhere_is_ruled_out(assessor):
    made = trials(assessor, [(one("stiffness"), 0.0), (one("cubic-stiffness"), 0.0)])
    made.columns[:, 1] = 0.0
    local = local_of(assessor.space, assessor.evaluator, MODEL)
    found = gains(assessor.space, made, local, SIZES, None)
    assert found[1].trial.id == "cubic-stiffness"
    assert found[1].value == -np.inf
    assert found[1].coefficients == (0.0,)


def test_terms_that_are_held_stand_for_the_force_that_they_make(assessor):
    spring = Placed(FittedTerm("stiffness", 2e4), held=True)
    model = Composite((*MODEL.terms, spring))
    found, made = weighed(assessor, [(one("stiffness"), 0.0)], model=model)
    target = assessor.space.sheet.target
    force = (target - 2e4 * assessor.evaluator.unit(spring.fitted)).ravel()
    spread = whole_force(made.columns, target)
    value, mean, _ = expected(made.columns, spread, force, beside(assessor))
    assert found[0].value == pytest.approx(value, rel=1e-5, abs=1e-4)
    assert found[0].coefficients[0] == pytest.approx(mean[0], abs=1e-4 * spread[0])

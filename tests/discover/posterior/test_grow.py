"""One more term: what was put into the records is named, and nothing where nothing was."""

import numpy as np
import pytest

from discover.posterior.grow import chosen_again, grown
from discover.posterior.left_out import left_out
from models.constitutive import FittedTerm
from tests.discover.gap_data import PLAN
from tests.discover.posterior.small import assessor_of, model_of, rows_of

IDS = ("stiffness", "cubic-stiffness", "quadratic-damping", "force-offset", "asymmetric-damping")
DEVICE = model_of(inertia=100.0, viscous_damping=700.0)


def step_of(more, ids=IDS, model=DEVICE, *, friction=False, plan=PLAN, noise=0.01):
    def law(t, x, v, a):
        return 120.0 * a + 800.0 * v + more(t, x, v, a)

    assessor = assessor_of(rows_of(law, plan, cycles=3, noise=noise), friction=friction)
    now = assessor.assess(model, assessor.space.start)
    return now, grown(assessor, now, ids)


EFFECTS = {
    "stiffness": (lambda t, x, v, a: 4e3 * x, 4e3),
    "cubic-stiffness": (lambda t, x, v, a: -8e7 * x**3, -8e7),
    "quadratic-damping": (lambda t, x, v, a: 3e3 * v * np.abs(v), 3e3),
    "force-offset": (lambda t, x, v, a: 3.0 + 0.0 * x, 3.0),
    "asymmetric-damping": (lambda t, x, v, a: 60.0 * np.abs(v), 60.0),
}


@pytest.mark.parametrize("effect", EFFECTS)
def test_the_effect_that_was_added_is_named_at_its_size(effect):
    law, size = EFFECTS[effect]
    now, step = step_of(law)
    best = step.best.id
    assert best == effect
    probabilities = step.probabilities
    assert probabilities[effect] > 0.95
    assert sum(probabilities.values()) == pytest.approx(1.0)
    assert list(step.best.places) == [2]
    inertia, damping, added = (p.fitted.coefficient for p in step.best.assessed.model.terms)
    assert added == pytest.approx(size, rel=0.1)
    assert inertia == pytest.approx(120.0, rel=0.01)
    assert damping == pytest.approx(800.0, rel=0.02)
    quiet, gained = step.best.assessed.quiet, step.best.value - now.value
    assert quiet and gained > 3.0


def test_where_nothing_is_missing_the_model_stays_as_it_is():
    now, step = step_of(lambda t, x, v, a: 0.0 * x)
    same, gained = step.best.assessed is now, step.best.value - now.value
    assert same and gained == 0.0
    probabilities = step.probabilities
    assert probabilities[""] > 0.9
    assert set(probabilities) == {"", *IDS}


def test_a_candidate_s_value_is_its_evidence_and_its_prior():
    _, step = step_of(EFFECTS["cubic-stiffness"][0])
    shapes = {"stiffness": 1, "cubic-stiffness": 9, "quadratic-damping": 1, "asymmetric-damping": 9}
    for c in step.candidates:
        if c.assessed is not None and c.id in shapes:
            prior = np.log(0.5 / len(IDS)) - np.log(shapes[c.id])
            beside = c.value - c.assessed.value
            assert beside == pytest.approx(prior)


def test_a_delay_of_the_force_channel_is_named():
    def late(t, x, v, a):
        omega = np.abs(v).max() / np.abs(x).max()
        return -0.003 * (-120.0 * omega**2 * v + 800.0 * a)

    _, step = step_of(late, (*IDS, "time-delay"))
    best = step.best.id
    assert best == "time-delay"
    (term,) = (step.best.assessed.model.terms[k].fitted for k in step.best.places)
    assert term.coefficient == pytest.approx(0.003, rel=0.05)


def test_several_terms_that_join_together_are_counted():
    _, step = step_of(
        lambda t, x, v, a: (300.0 * x - 4e4 * x**2) * np.tanh(v / 2e-3) + 40.0 * np.tanh(v / 2e-3),
        ("position-dependent-friction", "stiffness"),
        DEVICE.plus(FittedTerm("coulomb-friction", 30.0)), friction=True,
    )  # fmt: skip
    best, count = step.best.id, step.best.count
    assert (best, count) == ("position-dependent-friction", 2)
    one, two = (step.best.assessed.model.terms[k].fitted for k in step.best.places)
    assert (one.shape["power"], two.shape["power"]) == (1.0, 2.0)
    assert one.coefficient == pytest.approx(300.0, rel=0.1)
    assert two.coefficient == pytest.approx(-4e4, rel=0.1)


def test_what_is_simulated_is_tried_only_where_others_leave_more_than_noise():
    spring = EFFECTS["stiffness"][0]
    ids = ("stiffness", "series-compliance")
    _, step = step_of(spring, ids)
    assert {c.id for c in step.candidates} == {"", "stiffness"}


def test_what_needs_friction_is_no_candidate_without_it():
    _, step = step_of(lambda t, x, v, a: 0.0 * x, ("stribeck-friction", "stiffness"))
    assert {c.id for c in step.candidates} == {"", "stiffness"}
    _, step = step_of(lambda t, x, v, a: 0.0 * x, ("stribeck-friction",))
    assert [c.id for c in step.candidates] == [""]
    assert step.probabilities == {"": 1.0}


def test_a_term_is_named_beside_what_no_term_has():
    """A third harmonic that differs from test to test: remainder or independent errors hold it."""

    def strange(t, x, v, a):
        x0, v0 = np.abs(x).max(), np.abs(v).max()
        size = 6.0 * np.sin(1e4 * x0 + 7.0 * v0 / x0)
        return size * np.cos(3.0 * np.arctan2(v / v0, x / x0)) + 4e3 * x

    now, step = step_of(strange, noise=0.05)
    assert not now.quiet
    probabilities = step.probabilities
    assert probabilities["stiffness"] > 0.8


def test_where_no_candidate_leaves_noise_prediction_decides():
    ids = ("stiffness", "force-offset")
    now, step = step_of(lambda t, x, v, a: 30.0 * np.tanh(v / 2e-3) + 4e3 * x, ids)
    quiet = [c.assessed.quiet for c in step.candidates if c.assessed]
    assert not any(quiet)
    weighed = {c.id: c for c in step.candidates if c.left is not None}
    assert "" in weighed
    for c in weighed.values():
        left, expected = c.left, left_out(c.assessed.predicting)[1]
        np.testing.assert_allclose(left, expected)
        assert left.shape == (len(PLAN),)
    lines, most = step.lines, now.space.sheet.target.shape[1]
    assert 0.0 < lines < most
    best = step.best.id
    assert best == "stiffness"
    size = step.best.assessed.predicting.model.terms[2].fitted.coefficient
    assert size == pytest.approx(4e3, rel=0.3)


SHAPES = {
    "one way at a power, where both ways differ": ({"power": 1.5, "side": 1.0}, 500.0),
    "both ways, as it is": ({"power": 1.0, "side": 0.0}, 60.0),
}


@pytest.mark.parametrize("shape", SHAPES)
def test_a_shape_that_was_chosen_too_early_is_chosen_again(shape):
    def law(t, x, v, a):
        return 120.0 * a + 800.0 * v + 3e3 * v * np.abs(v) + 60.0 * np.abs(v)

    first, size = SHAPES[shape]
    assessor = assessor_of(rows_of(law, PLAN, cycles=3), friction=False)
    less = assessor.assess(
        DEVICE.plus(FittedTerm("quadratic-damping", 3e3)), assessor.space.start
    )
    early = FittedTerm("asymmetric-damping", size, first)
    now = assessor.assess(less.model.plus(early), less.place)
    again = chosen_again(assessor, now, less, [early], log_prior=-2.0)
    if first["side"] == 0.0:
        assert again.assessed is now and again.id == ""
        return
    assert again.id == "asymmetric-damping"
    (term,) = (again.assessed.model.terms[k].fitted for k in again.places)
    assert term.shape == {"power": 1.0, "side": 0.0}
    assert term.coefficient == pytest.approx(60.0, rel=0.1)
    assert again.log_prior == pytest.approx(-2.0)


def test_another_term_takes_the_place_of_one_that_was_mistaken_for_it():
    """A zero that settles within the first cycle is hardly more than an offset."""

    def law(t, x, v, a):
        return 120.0 * a + 800.0 * v + 3.0 + 0.0 * x

    assessor = assessor_of(rows_of(law, PLAN, cycles=3), friction=False)
    less = assessor.assess(DEVICE, assessor.space.start)
    early = FittedTerm("sensor-drift", 3.0, {"settling_time": 0.1, "stretching_exponent": 0.9})
    now = assessor.assess(less.model.plus(early), less.place)
    alone = chosen_again(assessor, now, less, [early], -5.0)
    assert alone.id != "force-offset"
    others = ("force-offset", "stiffness")
    again = chosen_again(assessor, now, less, [early], -5.0, others, among=10)
    assert again.id == "force-offset"
    offset = again.assessed.model.terms[2].fitted
    assert offset.coefficient == pytest.approx(3.0, rel=0.05)
    assert again.log_prior == pytest.approx(np.log(0.5))  # its own: of one shape, and common


def test_what_can_not_reach_the_evidence_that_is_asked_for_is_not_fitted():
    now, step = step_of(EFFECTS["stiffness"][0])
    reached = step.best.value
    fitted = []
    for least in (reached - 1.0, reached + 1e9):
        asked = grown(now.assessor, now, IDS, least=least)
        assert {c.id for c in asked.candidates} == {"", *IDS}
        fitted.append({c.id for c in asked.candidates if c.assessed})
    assert fitted[0] >= {"", "stiffness"}
    assert fitted[1] == {""}


def test_what_needs_a_term_that_is_gone_stays_as_it_is():
    assessor = assessor_of(rows_of(EFFECTS["stiffness"][0], PLAN, cycles=3), friction=False)
    less = assessor.assess(DEVICE, assessor.space.start)
    fall = FittedTerm("stribeck-friction", 1.0, {"stribeck_velocity": 0.01, "presliding": 0.0})
    now = assessor.assess(less.model.plus(fall), less.place)
    again = chosen_again(assessor, now, less, [fall], -5.0)
    assert again.assessed is now and again.id == ""

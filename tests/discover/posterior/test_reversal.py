"""Friction's curve as it is found in records of a known one."""

from dataclasses import replace

import numpy as np
import pytest

from discover.posterior.model import Composite, Number, Placed
from discover.posterior.reversal import Fading, reversals_of, with_few_curves
from discover.posterior.spread import spread_of
from models.constitutive import FittedTerm
from tests.discover.posterior.small import (
    APART,
    assessor_of,
    dense,
    flat,
    model_of,
    of_formula,
    rows_of,
)

SPEED, LENGTH, FALL = 4e-3, 1e-4, 4.5e-3
RUBBING = model_of(inertia=100.0, viscous_damping=700.0, coulomb_friction=30.0)


def bristles(x, length):
    """Return Dahl's state along a path: it goes to one with the way, by exp(-way / length)."""
    state, found = 0.0, np.zeros(x.size)
    for i in range(1, x.size):
        step = x[i] - x[i - 1]
        goal = np.sign(step)
        state = goal + (state - goal) * np.exp(-abs(step) / length)
        found[i] = state
    found[0] = found[1]
    return found


FRICTIONS = {
    "speed": lambda t, x, v, a: 40.0 * np.tanh(v / SPEED),
    "path": lambda t, x, v, a: 40.0 * bristles(x, LENGTH),
    "falling": lambda t, x, v, a: np.sign(v) * (40.0 + 20.0 * np.exp(-((v / FALL) ** 2))),
}


def assessed_of(friction, model=RUBBING, **options):
    def law(t, x, v, a):
        return 120.0 * a + 800.0 * v + friction(t, x, v, a)

    assessor = assessor_of(rows_of(law, APART, **options))
    return assessor.assess(model, assessor.space.start)


@pytest.fixture(scope="module")
def found():
    made = {name: assessed_of(law) for name, law in FRICTIONS.items()}
    return {n: (a, reversals_of(a.assessor, a, a.predicting)[0]) for n, a in made.items()}


def test_what_friction_turns_over_is_told(found):
    for name, follows, size in (("speed", "motion", SPEED), ("path", "path", LENGTH)):
        reversal = found[name][1]
        assert reversal.name == "coulomb-friction"
        assert reversal.follows == follows
        assert reversal.sure > 0.95
        assert reversal.size == pytest.approx(size, rel=0.5)
        low, high = reversal.interval
        assert low < size < high
        assert low < reversal.size < high
        assert high < 5.0 * low


def test_few_curves_make_the_whole_of_friction(found):
    for name, law in FRICTIONS.items():
        assessed, reversal = found[name]
        assert 1 <= len(reversal.terms) <= 3
        total = sum(
            t.coefficient * assessed.assessor.evaluator.unit(t) for t in reversal.terms
        )
        expected = of_formula(assessed.space.sheet.rows, law)
        # What is left of it is what damping and inertia make up for, by far less than its size.
        left = np.sqrt(np.mean((total - expected) ** 2) / np.mean(expected**2))
        assert left < 0.05
        assert all(t.coefficient > 0.0 for t in reversal.terms)


def test_what_slides_is_its_own_curves_alone(found):
    assert found["speed"][1].sliding == pytest.approx(40.0, rel=0.03)
    falling = found["falling"][1]
    own = [t for t in falling.terms if t.id == "coulomb-friction"]
    other = [t for t in falling.terms if t.id == "stribeck-friction"]
    assert falling.sliding == sum(t.coefficient for t in own) == pytest.approx(40.0, rel=0.05)
    assert sum(t.coefficient for t in other) == pytest.approx(20.0, rel=0.1)


def test_what_falls_away_moves_against_what_slides(found):
    assessed, reversal = found["falling"]
    fading = reversal.fading
    assert fading.main == Number(2, None)
    assert fading.numbers == assessed.local.numbers
    assert fading.variance > 0.0
    slope = dict(zip(fading.numbers, fading.slope, strict=True))[fading.main]
    # A newton more at the jump, whole, is a newton that falls away: the slide stays as it was.
    assert slope == pytest.approx(1.0, abs=0.2)


def test_how_surely_it_slides_and_falls_is_told_by_all_coefficients_together(found):
    assessed, reversal = found["falling"]
    space, numbers, part = assessed.space, assessed.local.numbers, assessed.curve
    spread = np.concatenate([assessed.local.spread, assessed.judged.scale * part.spread])
    columns = np.concatenate([assessed.local.slopes, space.columns[:, part.columns]], axis=1)
    matrix = flat(columns)
    weighted = np.linalg.solve(dense(space, assessed.place.sizes(space.own_unit)), matrix)
    whole = np.linalg.inv(matrix.T @ weighted + np.diag(spread**-2.0))
    falling = np.r_[np.zeros(len(numbers)), [t.id == "stribeck-friction" for t in part.terms]]
    sliding = np.r_[0.0, 0.0, 1.0, np.zeros(len(part.terms))] - falling
    deviations = reversal.fading.deviations(numbers, whole[: len(numbers), : len(numbers)])
    expected = [np.sqrt(g @ whole @ g) for g in (sliding, falling)]
    assert deviations == pytest.approx(expected, rel=1e-3)


def test_deviations_of_what_slides_and_falls_by_hand():
    inertia, main = Number(0, None), Number(2, None)
    fading = Fading((inertia, main), np.array([0.5, 0.25]), 3.0, main)
    covariance = np.array([[4.0, 0.6], [0.6, 2.0]])
    sliding, falling = fading.deviations([inertia, main], covariance)
    # Var(falling) = 3 + 0.25 4 + 0.0625 2 + 2 0.125 0.6, likewise with -0.5 and 0.75.
    assert falling**2 == pytest.approx(3.0 + 1.0 + 0.125 + 0.15)
    assert sliding**2 == pytest.approx(3.0 + 1.0 + 1.125 - 2.0 * 0.375 * 0.6)
    alone = fading.deviations([Number(1, None), main], np.diag([9.0, 2.0]))
    assert np.square(alone) == pytest.approx([3.0 + 0.5625 * 2.0, 3.0 + 0.0625 * 2.0])


def test_beside_a_remainder_friction_is_as_sure_as_the_few_curves_that_make_it(found):
    """A force that no term has leaves 40 N of friction told, beside all that a curve may be."""

    def law(t, x, v, a):
        return FRICTIONS["path"](t, x, v, a) + 3.0 * np.sin(x / 4e-3)

    assessed = assessed_of(law)
    assert not assessed.quiet
    reversal, model = with_few_curves(assessed.assessor, assessed, assessed.predicting)
    spread = spread_of(assessed, model)
    sliding, falling = reversal.deviations(spread.numbers, spread.covariance)
    assert abs(reversal.sliding - 40.0) < 2.0 * sliding < 20.0
    assert falling >= 0.0
    _, quiet = found["path"]
    assert quiet.beside is None


def test_without_friction_there_is_no_reversal():
    assessed = assessed_of(FRICTIONS["speed"], model_of(inertia=100.0, viscous_damping=700.0))
    assert not reversals_of(assessed.assessor, assessed, assessed.predicting)
    none = replace(assessed.assessor, friction=None)
    assert not reversals_of(none, assessed, assessed.predicting)


def test_where_it_can_t_be_told_it_is_not_sure():
    """Of tests of one frequency and size, a speed and a length look alike in strong noise."""
    def law(t, x, v, a):
        return 120.0 * a + 800.0 * v + 0.3 * np.tanh(v / SPEED)

    assessor = assessor_of(rows_of(law, ((2.0, 0.003), (2.0, 0.02)), noise=0.05))
    assessed = assessor.assess(RUBBING, assessor.space.start)
    found = reversals_of(assessor, assessed, assessed.predicting)
    assert all(0.5 <= reversal.sure < 0.9 for reversal in found)


def test_friction_that_differs_from_record_to_record_has_a_size(found):
    sizes = iter((25.0, 55.0, 30.0, 50.0, 45.0, 35.0))

    def differing(t, x, v, a):
        return next(sizes) * np.tanh(v / SPEED)

    plan = (*APART, (4.0, 0.004), (1.0, 0.015))

    def law(t, x, v, a):
        return 120.0 * a + 800.0 * v + differing(t, x, v, a)

    assessor = assessor_of(rows_of(law, plan, cycles=3))
    assessed = assessor.assess(RUBBING, assessor.space.start)
    reversal = reversals_of(assessor, assessed, assessed.predicting)[0]
    # The sizes' own deviation is a quarter of their mean; sizes are powers of two.
    assert 0.1 < reversal.differs < 0.6
    assert found["speed"][1].differs < 0.05


def with_unknown(t, x, v, a):
    """Friction, beside a third harmonic that no term has."""
    phase = np.arctan2(v / np.abs(v).max(), x / np.abs(x).max())
    return 40.0 * np.tanh(v / SPEED) + 15.0 * np.sin(1e4 * x.max()) * np.cos(3.0 * phase)


def test_where_few_curves_make_the_whole_the_numbers_beside_it_stand(found):
    assessed, reversal = found["speed"]
    again, model = with_few_curves(assessed.assessor, assessed, assessed.predicting)
    spread = spread_of(assessed, assessed.model)
    own = [i for i, n in enumerate(spread.numbers) if n.term != 2]
    for i in own:
        moved = model.value(spread.numbers[i]) - assessed.model.value(spread.numbers[i])
        assert abs(moved) < 0.2 * spread.deviation[i]
    assert again.sliding == pytest.approx(reversal.sliding, rel=0.01)
    assert again.beside is None


def test_where_few_curves_do_not_make_the_whole_the_numbers_are_fitted_beside_these():
    """Three elastic sliders: one is a term, the others are together no curve that there is."""

    def law(t, x, v, a):
        sliders = [2.5e4 * s * slider(x, s) for s in (8e-4, 1.4e-3, 2.8e-3)]
        return 20.0 * a + 300.0 * v + 4e4 * x + sum(sliders)

    plan = ((0.5, 0.004), (0.5, 0.016), (1.5, 0.01), (3.0, 0.006), (1.5, 0.02))
    assessor = assessor_of(rows_of(law, plan, cycles=3, noise=0.005))
    start = model_of(inertia=10.0, viscous_damping=700.0, stiffness=3e4, coulomb_friction=30.0)
    longest = FittedTerm("hysteresis", 50.0, {"yield_displacement": 2.8e-3, "form": 0.0})
    assessed = assessor.assess(start.plus(longest), assessor.space.start)
    reversal, model = with_few_curves(assessor, assessed, assessed.predicting)
    others = [p for p in model.terms if p.fitted.id != "coulomb-friction"]
    stated = assessor.evaluator.force(Composite((*others, *map(Placed, reversal.terms))))
    target = assessed.space.sheet.target
    assert np.linalg.norm(target - stated) < 0.02 * np.linalg.norm(target)
    found = {p.fitted.id: p.fitted.coefficient for p in others}
    assert found["inertia"] == pytest.approx(20.0, rel=0.02)
    assert found["stiffness"] == pytest.approx(4e4, rel=0.005)
    assert found["hysteresis"] == pytest.approx(70.0, rel=0.15)


def slider(x, length):
    """Return an elastic slider's force over its limit along a path, gone through twice."""
    state, found = 0.0, np.zeros(x.size)
    for _ in range(2):
        for i in range(x.size):
            state = np.clip(state + (x[i] - x[i - 1]) / length, -1.0, 1.0)
            found[i] = state
    return found


def test_a_model_that_has_to_predict_is_fitted_beside_its_few_curves():
    assessed = assessed_of(with_unknown, cycles=3)
    predicting = assessed.predicting
    same = predicting is assessed
    assert not same
    reversal, model = with_few_curves(assessed.assessor, assessed, predicting)
    assert [p.fitted.id for p in model.terms] == ["inertia", "viscous-damping", "coulomb-friction"]
    assert model.terms[2].fitted.coefficient == pytest.approx(reversal.sliding)
    assert reversal.sliding == pytest.approx(40.0, rel=0.1)
    evaluator = assessed.assessor.evaluator
    wide = Composite((*model.terms[:2], *(Placed(t) for t in reversal.terms)))
    left = assessed.space.sheet.target - evaluator.force(wide)
    sizes = predicting.place.sizes(assessed.space.own_unit)
    loud = np.einsum("l,ulr->ur", np.square(sizes.loud), assessed.space.sheet.loudness**2)
    root = 1.0 / np.sqrt(1.0 + loud)
    matrix = flat(np.stack([evaluator.unit(p.fitted) * root for p in wide.terms], axis=1))
    rest = (left * root).ravel()
    step = np.linalg.lstsq(matrix, rest)[0]
    least = float(np.sum((rest - matrix @ step) ** 2))
    # No other numbers of these terms leave less, weighed as the model weighs its rows.
    assert least <= float(rest @ rest) < least + 0.4


def test_a_curve_of_its_own_that_was_fitted_may_be_among_the_few():
    own = FittedTerm("coulomb-friction", 30.0, {"transition_speed": 5e-3})
    model = model_of(inertia=100.0, viscous_damping=700.0).plus(own)
    assessed = assessed_of(FRICTIONS["speed"], model)
    fitted_speed = assessed.model.terms[2].fitted.shape["transition_speed"]
    assert fitted_speed == pytest.approx(SPEED, rel=0.05)
    reversal = reversals_of(assessed.assessor, assessed, assessed.predicting)[0]
    assert reversal.follows == "motion"
    assert reversal.sliding == pytest.approx(40.0, rel=0.03)

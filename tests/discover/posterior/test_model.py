"""Rows of composite models and of their slopes, by closed formulas and finite differences."""

import numpy as np
import pytest

from discover.motion_fit import observe_all
from discover.posterior.model import Composite, Evaluator, Number, Placed, fitted_names
from discover.posterior.setup import space_of
from discover.rows import record_rows
from models.constitutive import FittedTerm
from models.terms import TERMS, Parameter, Term, own_terms
from tests.discover.gap_data import device, record
from tests.discover.posterior.small import (
    APART,
    assessor_of,
    model_of,
    of_formula,
    random_rows,
    rows_of,
)

SHARES = (0.0, 0.25, 1.0, 0.7)


@pytest.fixture(scope="module")
def assessor():
    return assessor_of(rows_of(device, APART, cycles=3), friction=False)


@pytest.fixture(scope="module")
def evaluator(assessor):
    return assessor.evaluator


@pytest.fixture(scope="module")
def rows(assessor):
    return assessor.space.sheet.rows


def numbered_tests(law=device):
    """Return what assesses models of tests whose numbers are known."""
    rng = np.random.default_rng(0)
    observations = observe_all([record(f, a, law, rng, cycles=3) for f, a in APART], 1)
    return assessor_of([record_rows(o) for o in observations], friction=False)


def near(found, expected, tolerance):
    """Assert that rows are the same, but for a share of their greatest."""
    np.testing.assert_allclose(found, expected, atol=tolerance * np.abs(expected).max())


def test_force_is_the_sum_of_what_is_there_of_each_term_in_each_unit(evaluator, rows):
    model = Composite(
        (
            Placed(FittedTerm("inertia", 120.0)),
            Placed(FittedTerm("viscous-damping", 800.0), SHARES),
            Placed(FittedTerm("cubic-stiffness", -3e9), (1.0, 0.0, 0.5, 1.0), held=True),
        )
    )
    share = np.array(SHARES)[:, None]
    other = np.array([1.0, 0.0, 0.5, 1.0])[:, None]
    expected = (
        of_formula(rows, lambda t, x, v, a: 120.0 * a)
        + share * of_formula(rows, lambda t, x, v, a: 800.0 * v)
        + other * of_formula(rows, lambda t, x, v, a: -3e9 * x**3)
    )
    near(evaluator.force(model), expected, 1e-12)


def test_a_force_channel_that_runs_late_shows_the_force_of_before(evaluator, rows):
    model = model_of(inertia=120.0, viscous_damping=800.0, time_delay=0.004)

    def late(t, x, v, a):
        omega = v.max() / x.max()
        back = omega * 0.004
        # In a sine test v goes round with x/omega: half a turn of these is the delay's.
        was_v = v * np.cos(back) + omega * x * np.sin(back)
        was_a = a * np.cos(back) + omega * v * np.sin(back)
        return 120.0 * was_a + 800.0 * was_v

    near(evaluator.force(model), of_formula(rows, late), 1e-5)


def test_a_change_of_force_is_there_in_part_where_its_unit_holds_a_part_of_it(evaluator, rows):
    model = Composite(
        (
            *model_of(inertia=120.0).terms,
            Placed(FittedTerm("viscous-damping", 800.0), (1.0, 0.5, 0.0, 1.0)),
            Placed(FittedTerm("sensor-gain", 0.2), SHARES),
        )
    )
    force = of_formula(rows, lambda t, x, v, a: 120.0 * a)
    force = force + np.array([1.0, 0.5, 0.0, 1.0])[:, None] * of_formula(
        rows, lambda t, x, v, a: 800.0 * v
    )
    near(evaluator.force(model), force * (1.0 + 0.2 * np.array(SHARES)[:, None]), 1e-9)


def test_a_spring_in_series_gives_way(evaluator, rows):
    """Dynamic stiffnesses D of the device and J of the joint in series: D J / (D + J)."""
    spring = FittedTerm("series-compliance", 1e-6, {"loss": 0.05})
    found = evaluator.force(model_of(inertia=120.0, viscous_damping=800.0).plus(spring))
    expected = []
    for r in rows:
        m = r.cycle
        omega = float(m.velocity.max() / m.displacement.max())
        stiff = -120.0 * omega**2 + 800j * omega
        joint = 1e6 + 1j * omega * 2.0 * 0.05 * np.sqrt(1e6 * 120.0)
        through = stiff * joint / (stiff + joint)
        force = through.real * m.displacement + through.imag * m.velocity / omega
        expected.append(force @ r.cycle_rows)
    near(found, np.array(expected), 5e-3)
    stiff = evaluator.force(model_of(inertia=120.0, viscous_damping=800.0))
    assert np.abs(found - stiff).max() > 2e-2 * np.abs(stiff).max()


def test_the_same_model_asked_for_again_has_the_same_rows(evaluator):
    model = model_of(inertia=120.0, viscous_damping=800.0, time_delay=0.004)
    first = evaluator.force(model).copy()
    for k in range(12):
        evaluator.force(model.with_values([Number(2, None)], [1e-4 * k]))
    np.testing.assert_array_equal(evaluator.force(model), first)
    changed = evaluator.force(model.with_values([Number(0, None)], [60.0]))
    assert np.abs(changed - first).max() > 0.1 * np.abs(first).max()


def test_slopes_of_coefficients_are_what_is_there_of_a_unit(evaluator, rows):
    model = Composite(
        (Placed(FittedTerm("inertia", 120.0)), Placed(FittedTerm("viscous-damping", 0.0), SHARES))
    )
    found = evaluator.slopes(model, model.numbers)
    near(found[:, 0], of_formula(rows, lambda t, x, v, a: a), 1e-12)
    expected = np.array(SHARES)[:, None] * of_formula(rows, lambda t, x, v, a: v)
    near(found[:, 1], expected, 1e-12)
    assert evaluator.slopes(model, []).shape == (4, 0, rows[0].target.size)


@pytest.mark.parametrize("exponent", [1.3, 3.0])
def test_the_slope_of_a_shape_is_the_derivative(evaluator, rows, exponent):
    term = FittedTerm("power-law-damping", 500.0, {"exponent": exponent})
    model = Composite((*model_of(inertia=120.0).terms, Placed(term, SHARES)))
    found = evaluator.slopes(model, [Number(1, "exponent")])[:, 0]

    def slope(t, x, v, a):
        size = np.maximum(np.abs(v), 1e-300)
        return 500.0 * np.sign(v) * size**exponent * np.log(size)

    near(found, np.array(SHARES)[:, None] * of_formula(rows, slope), 1e-2)


def test_the_slope_of_an_order_is_the_derivative_of_the_harmonic_rule(evaluator, rows):
    order = 1.4
    model = Composite((Placed(FittedTerm("fractional-derivative", 300.0, {"order": order})),))
    found = evaluator.slopes(model, model.numbers)

    def harmonic(t, x, v, a):
        omega = v.max() / x.max()
        turn = order * np.pi / 2.0
        return omega**order * (np.cos(turn) * x + np.sin(turn) * v / omega)

    def slope(t, x, v, a):
        omega = v.max() / x.max()
        turn = order * np.pi / 2.0
        size = 300.0 * omega**order
        ahead = np.pi / 2.0 * (np.cos(turn) * v / omega - np.sin(turn) * x)
        return size * (np.log(omega) * (np.cos(turn) * x + np.sin(turn) * v / omega) + ahead)

    near(found[:, 0], of_formula(rows, harmonic), 1e-6)
    near(found[:, 1], of_formula(rows, slope), 1e-2)


CHANGED = {
    "late": FittedTerm("time-delay", 0.002),
    "gain": FittedTerm("sensor-gain", 0.1, {"filter_time": 0.02}),
    "spring": FittedTerm("series-compliance", 2e-6),
}


@pytest.mark.parametrize("name", CHANGED)
def test_slopes_of_a_changed_force_are_finite_differences_of_it(evaluator, name):
    model = model_of(inertia=120.0, viscous_damping=800.0).plus(CHANGED[name])
    found = evaluator.slopes(model, model.numbers)
    assert found.shape[1] == len(model.numbers)
    for k, number in enumerate(model.numbers):
        step = 0.02 * model.value(number)
        more, less = (
            evaluator.force(model.with_values([number], [model.value(number) + s]))
            for s in (step, -step)
        )
        expected = (more - less) / (2.0 * step)
        near(found[:, k], expected, 2e-2)


def test_a_change_that_is_not_there_yet_has_a_slope(evaluator, rows):
    model = model_of(inertia=120.0, viscous_damping=800.0, sensor_gain=0.0)
    found = evaluator.slopes(model, [Number(2, None)])[:, 0]
    near(found, of_formula(rows, lambda t, x, v, a: 120.0 * a + 800.0 * v), 1e-3)


def test_coarse_rows_are_nearly_the_same(evaluator, rows):
    model = model_of(inertia=120.0, viscous_damping=800.0, cubic_stiffness=1e9)
    fine = evaluator.force(model)
    near(evaluator.coarse.force(model), fine, 1e-3)
    assert np.any(evaluator.coarse.force(model) != fine)
    assert evaluator.coarse is evaluator.coarse.coarse


def test_trials_that_add_are_their_units_and_those_that_change_are_over_their_coefficients(
    evaluator, rows
):
    model = model_of(inertia=120.0, viscous_damping=800.0)
    terms = [
        FittedTerm("sensor-gain", 1e-3), FittedTerm("stiffness", 1.0),
        FittedTerm("time-delay", 1e-5), FittedTerm("cubic-stiffness", 1.0),
    ]  # fmt: skip
    found = evaluator.trials(model, terms)
    near(found[:, 0], of_formula(rows, lambda t, x, v, a: 120.0 * a + 800.0 * v), 1e-9)
    near(found[:, 1], of_formula(rows, lambda t, x, v, a: x), 1e-12)
    near(found[:, 3], of_formula(rows, lambda t, x, v, a: x**3), 1e-12)

    def earlier(t, x, v, a):
        omega = v.max() / x.max()
        return 120.0 * omega**2 * v - 800.0 * a  # -dF/dt

    near(found[:, 2], of_formula(rows, earlier), 1e-3)


def test_trials_change_the_force_of_the_model_as_it_is_in_their_unit(evaluator, rows):
    model = Composite((Placed(FittedTerm("viscous-damping", 800.0), SHARES),))
    found = evaluator.trials(model, [FittedTerm("sensor-gain", 1e-3)])[:, 0]
    expected = np.array(SHARES)[:, None] * of_formula(rows, lambda t, x, v, a: 800.0 * v)
    near(found, expected, 1e-9)


def test_of_long_records_changed_forces_are_seen_in_the_same_directions():
    space, _ = space_of([random_rows()], TERMS["coulomb-friction"])
    assert any(u.basis is not None for u in space.sheet.units)
    evaluator = Evaluator(space.sheet, space.scales)
    plain = evaluator.force(model_of(inertia=120.0, viscous_damping=800.0))
    more = model_of(inertia=120.0, viscous_damping=800.0, sensor_gain=0.1)
    near(evaluator.force(more), 1.1 * plain, 1e-9)
    found = evaluator.slopes(more, [Number(2, None)])[:, 0]
    near(found, plain, 1e-6)
    assert np.sum((space.sheet.target - plain) ** 2) < 0.05 * np.sum(space.sheet.target**2)


def test_what_is_there_in_one_test_only_is_in_its_rows_alone():
    assessor = numbered_tests()
    only = [FittedTerm("force-offset", 3.0 * n, {"only": float(n)}) for n in (1, 3)]
    late = FittedTerm("time-delay", 0.004, {"only": 2.0})
    plain = model_of(inertia=120.0, viscous_damping=800.0)
    model, evaluator = plain.plus(*only, late), assessor.evaluator
    force = evaluator.force(plain)
    ones = of_formula(assessor.space.sheet.rows, lambda t, x, v, a: np.ones_like(t))
    delayed = evaluator.force(model_of(inertia=120.0, viscous_damping=800.0, time_delay=0.004))
    expected = [force[0] + 3.0 * ones[0], delayed[1], force[2] + 9.0 * ones[2], force[3]]
    near(evaluator.force(model), np.array(expected), 1e-9)
    by_record = model.by_record(assessor.space.sheet)
    ids = {r: [t.id for t in m.terms][2:] for r, m in by_record.items()}
    assert ids == {0: ["force-offset"], 1: ["time-delay"], 2: ["force-offset"], 3: []}
    assert [t.coefficient for t in by_record[2].terms] == [120.0, 800.0, 9.0]


def test_a_model_in_a_test_is_without_what_others_have():
    own = [Placed(FittedTerm("force-offset", 1.0, {"only": n})) for n in (1.0, 2.0)]
    model = Composite((*own, *model_of(inertia=1.0).terms))
    assert model.in_test(2).terms == model.terms[1:]
    assert model.in_test(5).terms == model.terms[2:]
    assert model.in_test(0) is model


def test_a_model_in_a_unit_has_its_share_of_each_coefficient():
    model = Composite(
        (
            Placed(FittedTerm("inertia", 120.0), SHARES),
            Placed(FittedTerm("power-law-damping", 3.0, {"exponent": 1.5}), SHARES[::-1]),
        )
    )
    assert [(t.id, t.coefficient) for t in model.in_unit(0).terms] == [
        ("power-law-damping", pytest.approx(2.1))
    ]
    assert [t.coefficient for t in model.in_unit(1).terms] == [30.0, 3.0]
    assert model.in_unit(1).terms[1].shape == {"exponent": 1.5}


def test_numbers_are_coefficients_and_shapes_that_are_fitted():
    model = Composite(
        (
            Placed(FittedTerm("inertia", 120.0)),
            Placed(FittedTerm("viscous-damping", 800.0), held=True),
            Placed(FittedTerm("coulomb-friction", 40.0, {"transition_speed": 0.01, "form": 1.0})),
            Placed(FittedTerm("coulomb-friction", 40.0)),
            Placed(FittedTerm("asymmetric-damping", 40.0)),
            Placed(FittedTerm("fractional-derivative", 40.0, {"order": 1.2})),
        )
    )
    assert [(n.term, n.shape) for n in model.numbers] == [
        (0, None), (2, None), (2, "transition_speed"), (3, None), (4, None), (5, None),
        (5, "order"),
    ]  # fmt: skip
    assert fitted_names(model.terms[2].fitted) == ["transition_speed"]
    assert fitted_names(FittedTerm("fractional-derivative", 1.0, {"order": 0.0})) == []
    assert [model.value(n) for n in model.numbers] == [120.0, 40.0, 0.01, 40.0, 40.0, 40.0, 1.2]


def test_a_default_beyond_the_bounds_is_a_limit_that_no_fit_leaves():
    gap = Parameter("gap", 0.5, 1.5, 9.0, "m")
    with own_terms(Term("a", "N", "", column=lambda m, s: m.velocity, parameters=(gap,))):
        assert fitted_names(FittedTerm("a", 1.0, {"gap": 9.0})) == []
        assert fitted_names(FittedTerm("a", 1.0, {"gap": 1.2})) == ["gap"]


def test_other_values_leave_all_else():
    model = Composite(
        (
            Placed(FittedTerm("inertia", 120.0), SHARES),
            Placed(FittedTerm("coulomb-friction", 40.0, {"transition_speed": 0.01, "form": 1.0})),
        )
    )
    numbers = [Number(1, "transition_speed"), Number(0, None), Number(1, None)]
    changed = model.with_values(numbers, [0.02, 7.0, -1.0])
    assert [changed.value(n) for n in numbers] == [0.02, 7.0, -1.0]
    assert changed.terms[0].share == SHARES
    assert changed.terms[1].fitted.shape == {
        **model.terms[1].fitted.shape, "transition_speed": 0.02
    }
    assert model.value(numbers[0]) == 0.01


def test_terms_join_in_all_units_and_leave_again():
    model = Composite((Placed(FittedTerm("inertia", 120.0), SHARES, held=True),))
    more = model.plus(FittedTerm("stiffness", 1.0), FittedTerm("viscous-damping", 2.0))
    assert [p.share for p in more.terms] == [SHARES, None, None]
    assert [p.held for p in more.terms] == [True, False, False]
    assert [p.fitted.id for p in more.without(1).terms] == ["inertia", "viscous-damping"]
    assert more.without(2).without(1) == model


def test_what_a_model_s_force_is_made_of():
    plain = model_of(inertia=120.0)
    late, play = FittedTerm("time-delay", 1e-3), FittedTerm(
        "backlash", 1.0, {"gap": 1e-4, "contact": 600.0}
    )
    assert plain.adds_up and not plain.changes_force
    assert plain.plus(late).changes_force and not plain.plus(late).adds_up
    assert not plain.plus(play).changes_force and not plain.plus(play).adds_up
    assert not plain.plus(late, play).changes_force

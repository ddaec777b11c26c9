"""Columns of terms in records, by closed formulas."""

import numpy as np
import pytest

from discover.posterior.covariance import Sizes
from discover.posterior.sheet import padded
from discover.posterior.space import departures, parts_of, shape_grid, unit
from models.constitutive import FittedTerm
from models.terms import TERMS
from tests.discover.posterior.small import (
    APART,
    assessor_of,
    of_formula,
    random_rows,
    rows_of,
    whole_force,
)


def law(t, x, v, a):
    return 120.0 * a + 800.0 * v + 40.0 * np.tanh(v / 2e-3)


@pytest.fixture(scope="module")
def assessor():
    return assessor_of(rows_of(law, APART, cycles=3))


def near(found, expected, tolerance=1e-9):
    np.testing.assert_allclose(found, expected, atol=tolerance * np.abs(expected).max())


def test_a_curve_s_columns_are_the_jump_and_what_the_others_are_beyond_it(assessor):
    space, part = assessor.space, assessor.friction
    rows = space.sheet.rows
    jump = of_formula(rows, lambda t, x, v, a: np.sign(v))
    near(space.columns[:, part.columns[0]], jump)
    for k, t in enumerate(part.terms):
        speed = t.shape.get("transition_speed", 0.0)
        if t.id == "coulomb-friction" and speed > 0.0:
            other = of_formula(rows, lambda t, x, v, a, s=speed: np.tanh(v / s))
        elif t.id == "stribeck-friction":
            fall = t.shape["stribeck_velocity"]
            other = of_formula(
                rows, lambda t, x, v, a, s=fall: np.sign(v) * np.exp(-((v / s) ** 2))
            )
        else:
            continue
        near(space.columns[:, part.columns[k]], other - jump)
    np.testing.assert_array_equal(part.spread, [1.0, *[0.3] * (len(part.terms) - 1)])
    np.testing.assert_array_equal(part.sign, [1.0, *[0.0] * (len(part.terms) - 1)])


def test_a_curve_is_averaged_over_sizes_down_from_what_makes_the_whole_force(assessor):
    space, part = assessor.space, assessor.friction
    jump = space.columns[:, part.columns[:1]]
    assert part.scales[0] == pytest.approx(whole_force(jump, space.sheet.target)[0], rel=1e-9)
    assert list(part.scales) == sorted(part.scales, reverse=True)
    assert space.own_unit == pytest.approx(part.scales[0], rel=1e-9)


def test_departures_are_all_curves_but_the_plainest(assessor):
    part = assessor.friction
    found = departures(part, None)
    assert found.terms == part.terms[1:]
    np.testing.assert_array_equal(found.columns, part.columns[1:])
    assert np.all(found.sign == 0.0)
    assert found.scales == part.scales


def test_curves_that_have_a_name_are_open_to_models_that_hold_it(assessor):
    part = assessor.friction

    def kinds(*held):
        found = departures(part, held)
        assert all(part.terms[list(part.columns).index(c)] == t
                   for c, t in zip(found.columns, found.terms, strict=True))  # fmt: skip
        return {(t.id, t.shape["presliding"] > 0.0) for t in found.terms}

    path = FittedTerm("hysteresis", 1.0, {"yield_displacement": 1e-3})
    fall = FittedTerm("stribeck-friction", 1.0, {"stribeck_velocity": 0.01})
    spring = FittedTerm("stiffness", 1.0)
    assert kinds(spring) == kinds() == {("coulomb-friction", False)}
    assert kinds(path) == {("coulomb-friction", False), ("coulomb-friction", True)}
    assert kinds(fall) == {("coulomb-friction", False), ("stribeck-friction", False)}


def test_parts_are_columns_with_the_size_of_the_first_as_their_scale(assessor):
    space = assessor.space
    wanted = [
        (FittedTerm("stiffness", 1.0), FittedTerm("cubic-stiffness", 1.0)),
        (FittedTerm("viscous-damping", 1.0),),
    ]
    two, one = parts_of(space, wanted)
    columns = np.stack(
        [of_formula(space.sheet.rows, f) for f in (
            lambda t, x, v, a: x, lambda t, x, v, a: x**3, lambda t, x, v, a: v
        )], axis=1,
    )  # fmt: skip
    near(space.columns[:, two.columns], columns[:, :2])
    near(space.columns[:, one.columns], columns[:, 2:])
    size = whole_force(columns, space.sheet.target)
    assert two.scales == pytest.approx((size[0],))
    np.testing.assert_allclose(two.spread * two.scales[0], size[:2], rtol=1e-9)
    assert one.scales == pytest.approx((size[2],))
    np.testing.assert_array_equal(two.sign, [0.0, 0.0])
    np.testing.assert_array_equal(one.sign, [1.0])


def test_slopes_of_a_part_stand_after_its_terms(assessor):
    space = assessor.space
    wanted = [
        (FittedTerm("stiffness", 1.0),),
        (FittedTerm("power-law-damping", 1.0, {"exponent": 1.5}),),
        (FittedTerm("viscous-damping", 1.0),),
    ]
    first, powered, last = parts_of(space, wanted, [(), (("exponent", 0.2),), ()])
    rows = space.sheet.rows
    near(space.columns[:, first.columns[0]], of_formula(rows, lambda t, x, v, a: x))
    near(space.columns[:, last.columns[0]], of_formula(rows, lambda t, x, v, a: v))
    assert powered.slopes == ("exponent",)
    assert powered.spread == pytest.approx([1.0, 0.2])
    np.testing.assert_array_equal(powered.sign, [1.0, 0.0])

    def column(t, x, v, a):
        return np.sign(v) * np.abs(v) ** 1.5

    def slope(t, x, v, a):
        return column(t, x, v, a) * np.log(np.maximum(np.abs(v), 1e-300))

    near(space.columns[:, powered.columns[0]], of_formula(rows, column))
    near(space.columns[:, powered.columns[1]], of_formula(rows, slope), 1e-2)


def test_products_follow_the_columns_that_are_added():
    space = assessor_of(rows_of(law, APART, cycles=3)).space
    sizes = Sizes(0.01, (0.0, 0.0), 1.0)
    before = space.given(sizes)
    assert space.given(sizes) is before
    (part,) = parts_of(space, [(unit(TERMS["stiffness"], {}),)])
    after = space.given(sizes)
    assert after.force == before.force + 1
    gram = after.gram([(np.r_[part.columns, after.force], None)])
    old = before.gram([(np.array([before.force]), None)])
    assert gram[1, 1] == pytest.approx(old[0, 0], rel=1e-9)
    assert gram[0, 0] > 0.0
    space.forget()
    np.testing.assert_allclose(
        space.given(sizes).gram([(np.r_[part.columns, after.force], None)]), gram, rtol=1e-9
    )


@pytest.mark.parametrize(("bounds", "step", "expected"), [
    ((0.0, 1.0), 0.25, [0.125, 0.375, 0.625, 0.875]),
    ((1.0, 2.0), 0.6, [1.25, 1.75]),
    ((1.0, 2.0), 5.0, [1.5]),
    ((0.0, 0.3), 0.1, [0.05, 0.15, 0.25]),
])  # fmt: skip
def test_a_grid_has_the_middle_of_equal_steps(bounds, step, expected):
    assert list(shape_grid(bounds, step)) == pytest.approx(expected)


def test_rows_of_the_units_of_a_long_record_are_seen_in_orthonormal_directions():
    rows = random_rows()
    sheet = assessor_of([rows], friction=False).space.sheet
    velocity = rows.of_motion(rows.motion.velocity)
    found = sheet.stack([velocity[None]])[:, 0]
    for place, u in enumerate(sheet.units):
        assert u.record == 0
        if u.basis is not None:
            inner = u.basis.T @ u.basis
            np.testing.assert_allclose(inner, np.eye(inner.shape[0]), atol=1e-9)
        # What models are made of loses nothing that noise would not hide.
        lost = np.sum(velocity[u.part] ** 2) - np.sum(found[place] ** 2)
        assert abs(lost) < 1e-2 * np.sum(velocity[u.part] ** 2)
    assert sorted(np.concatenate([u.part for u in sheet.units])) == list(range(velocity.size))


def test_tests_that_are_alike_share_the_remainder(assessor):
    sheet = assessor.space.sheet
    alike = sheet.kernel @ sheet.kernel.T
    for i, one in enumerate(sheet.units):
        for j, other in enumerate(sheet.units):
            apart = np.log(one.frequency / other.frequency) ** 2
            apart += np.log(one.amplitude / other.amplitude) ** 2
            assert alike[i, j] == pytest.approx(np.exp(-0.5 * apart), abs=1e-3)
    for u, (frequency, amplitude) in zip(sheet.units, APART, strict=True):
        assert u.frequency == pytest.approx(frequency, rel=1e-6)
        assert u.amplitude == pytest.approx(amplitude, rel=1e-6)
        assert u.speed == pytest.approx(2.0 * np.pi * frequency * amplitude, rel=1e-6)


def test_the_scale_of_a_column_makes_the_whole_force_in_the_mean(assessor):
    sheet = assessor.space.sheet
    velocity = of_formula(sheet.rows, lambda t, x, v, a: v)
    columns = np.stack([velocity, -3.0 * velocity, sheet.target], axis=1)
    found = sheet.scale(columns)
    np.testing.assert_allclose(found, whole_force(columns, sheet.target), rtol=1e-9)
    assert found[1] == pytest.approx(found[0] / 3.0)
    assert found[2] == pytest.approx(1.0)


def test_rows_are_padded_with_zeros_at_their_end():
    found = padded([np.ones((2, 3)), 2.0 * np.ones((2, 1))], 4)
    np.testing.assert_array_equal(found[0], [[1, 1, 1, 0]] * 2)
    np.testing.assert_array_equal(found[1], [[2, 0, 0, 0]] * 2)

"""The candidate columns of a study: values, positions, and what is kept."""

import numpy as np
import pytest

from discover.library.dictionary import DELAY, PLAIN, Column, friction_column, standard_dictionary
from models.motion import harmonic_motion, sine_motion

SPEEDS = np.array([0.05, 0.1, 0.4])
OMEGAS = 2.0 * np.pi * np.array([0.5, 2.0, 8.0])
SPACE = standard_dictionary(SPEEDS, OMEGAS)
AMPLITUDE, FREQUENCY = 0.01, 2.0
OMEGA = 2.0 * np.pi * FREQUENCY
THETA = 2.0 * np.pi * np.arange(256) / 256
X = AMPLITUDE * np.sin(THETA)
V = AMPLITUDE * OMEGA * np.cos(THETA)
EXPECTED = {
    "inertia": -(OMEGA**2) * X,
    "viscous-damping": V,
    "quadratic-damping": V * np.abs(V),
    "stiffness": X,
    "cubic-stiffness": X**3,
    "force-offset": np.ones(256),
    "asymmetric-damping": np.abs(V),
}


def evaluated(space=SPACE):
    return space.evaluate(sine_motion(AMPLITUDE, FREQUENCY, samples=256))


def test_fixed_columns_are_their_formulas_at_their_positions():
    values = evaluated()
    assert set(PLAIN) == set(EXPECTED)
    for identifier, column in EXPECTED.items():
        np.testing.assert_allclose(
            values[SPACE.index(identifier)], column, atol=1e-12 * np.abs(column).max()
        )


def test_families_are_scaled_and_continuous():
    values = evaluated()
    family, where = SPACE.family("fractional-derivative")
    assert family.reference == pytest.approx(np.prod(OMEGAS) ** (1.0 / 3.0))
    for order in (0.3, 0.48, 1.0, 1.89):
        exact = AMPLITUDE * OMEGA**order * np.sin(THETA + 0.5 * np.pi * order)
        found = family.reference**order * (values[where].T @ family.weights(order))[:, 0]
        np.testing.assert_allclose(found, exact, atol=1e-10 * np.abs(exact).max())
    family, where = SPACE.family("power-law-damping")
    assert family.reference == SPEEDS.max()
    for power in (1.0, 1.75, 2.6):
        exact = np.sign(V) * np.abs(V) ** power
        found = family.reference**power * (values[where].T @ family.weights(power))[:, 0]
        # at the reversals |v| is nearly nothing, and no polynomial in p follows
        np.testing.assert_allclose(found, exact, atol=3e-4 * np.abs(exact).max())


def test_order_zero_is_the_limit_from_above():
    """A mean has no fractional derivative of any order above zero."""
    motion = harmonic_motion([0.02, -1j * AMPLITUDE], FREQUENCY, samples=256)
    _, where = SPACE.family("fractional-derivative")
    np.testing.assert_allclose(SPACE.evaluate(motion)[where][0], X, atol=1e-11)


def test_size_and_order_of_columns():
    plain, frictions = len(PLAIN), 10
    assert SPACE.size == plain + frictions + 17 + 17 + 1
    assert evaluated().shape == (SPACE.size - 1, 256)
    assert SPACE.index(DELAY) == SPACE.size - 1
    assert SPACE.family("fractional-derivative")[1] == slice(17, 34)
    assert SPACE.family("power-law-damping")[1] == slice(34, 51)
    assert SPACE.family("hysteresis") is None


def test_friction_jumps_once_and_reverses_over_rising_speeds():
    speeds = SPACE.transition_speeds
    assert speeds[0] == 0.0
    assert np.all(np.diff(speeds) > 0.0)
    values = evaluated()
    start = SPACE.index("coulomb-friction")
    np.testing.assert_array_equal(np.abs(values[start][np.abs(V) > 1e-9]), 1.0)
    np.testing.assert_allclose(values[start + 4], np.tanh(V / speeds[4]), atol=1e-12)


def test_restricted_keeps_the_columns_named_and_all_families():
    wanted = [Column("inertia"), friction_column(SPACE.transition_speeds[3])]
    small, kept = SPACE.restricted(wanted)
    assert small.columns == tuple(wanted)
    assert small.size == 2 + 17 + 17 + 1
    whole = np.concatenate((evaluated(), np.full((1, 256), np.nan)))
    np.testing.assert_array_equal(evaluated(small), whole[kept[:-1]])
    assert kept[-1] == SPACE.size - 1
    assert small.has("inertia")
    assert not small.has("viscous-damping")


def test_without_delay_there_is_no_column_for_it():
    space = standard_dictionary(SPEEDS, OMEGAS, delay=False)
    assert not space.has(DELAY)
    assert SPACE.has(DELAY)
    assert space.size == SPACE.size - 1


def test_other_transitions_replace_friction_only():
    space = SPACE.with_transitions([0.01, 0.02])
    assert space.transition_speeds.tolist() == [0.01, 0.02]
    assert space.size == SPACE.size - 8
    np.testing.assert_array_equal(evaluated(space)[: len(PLAIN)], evaluated()[: len(PLAIN)])


def test_curve_of_reversal_is_what_other_speeds_differ_by():
    one = SPACE.with_transitions([0.02]).with_reversal(30.0)
    assert one.reversal_scale == 30.0
    values = evaluated(one)[one.reversal_positions]
    speeds = [dict(c.shape)["transition_speed"] for c in one.reversal]
    assert min(speeds) < 0.02 < max(speeds)
    for speed, found in zip(speeds, values, strict=True):
        np.testing.assert_allclose(found, np.tanh(V / speed) - np.tanh(V / 0.02), atol=1e-12)
    # far from the reversals they say nothing
    assert one.index(DELAY) == one.reversal_positions.stop


def test_ranges_and_terms_are_those_asked_for():
    space = standard_dictionary(
        SPEEDS, OMEGAS, terms=("inertia",), orders=(0.5, 1.5), exponents=(1.0, 2.0)
    )
    assert space.family("fractional-derivative")[0].nodes[[0, -1]].tolist() == [0.5, 1.5]
    assert space.family("power-law-damping")[0].nodes[[0, -1]].tolist() == [1.0, 2.0]
    assert [c.id for c in space.columns[:2]] == ["inertia", "coulomb-friction"]


def test_motion_may_be_read_only():
    motion = sine_motion(AMPLITUDE, FREQUENCY, samples=256)
    for array in (motion.displacement, motion.velocity, motion.acceleration, motion.time):
        array.flags.writeable = False
    np.testing.assert_array_equal(SPACE.evaluate(motion), evaluated())

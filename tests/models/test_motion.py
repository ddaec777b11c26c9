"""Motions and their derivatives of any order against closed forms."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.special import gamma

from models.checks import InputError
from models.motion import harmonic_motion, sampled_motion, sine_motion

COEFFICIENTS = (0.003, 0.01 - 0.004j, 0.0, 0.002j)


def series(time, frequency, order):
    """Return the derivative of the series term by term: c_k (i k w)^order, a mean has none."""
    omega = 2.0 * np.pi * frequency
    total = np.zeros(time.size)
    for k, c in enumerate(COEFFICIENTS):
        if k == 0:
            total += c if order == 0.0 else 0.0
        else:
            total += np.real(c * (1j * k * omega) ** order * np.exp(1j * k * omega * time))
    return total


@pytest.mark.parametrize("order", [0.0, 0.48, 1.0, 1.5, 1.89, 2.0, -0.6])
def test_harmonic_motion_is_exact_for_every_order(order):
    motion = harmonic_motion(COEFFICIENTS, 3.0, samples=64, cycles=2)
    expected = series(motion.time, 3.0, order)
    np.testing.assert_allclose(
        motion.fractional(order), expected, atol=1e-12 * np.abs(expected).max()
    )


def test_the_first_three_derivatives_are_carried_along():
    motion = harmonic_motion(COEFFICIENTS, 3.0, samples=64)
    for order, found in enumerate((motion.displacement, motion.velocity, motion.acceleration)):
        expected = series(motion.time, 3.0, float(order))
        np.testing.assert_allclose(found, expected, atol=1e-12 * np.abs(expected).max())


def test_samples_are_whole_periods_at_a_uniform_step():
    motion = harmonic_motion(COEFFICIENTS, 4.0, samples=50, cycles=3)
    assert motion.time.size == 150
    assert motion.step == pytest.approx(1.0 / 200.0, rel=1e-12)
    assert motion.periodic
    assert motion.operator == "weyl"
    np.testing.assert_allclose(np.diff(motion.time), motion.step, rtol=1e-9)


def test_the_paper_s_sine_starts_at_nothing_and_rises():
    motion = sine_motion(0.02, 0.5, samples=200)
    np.testing.assert_allclose(
        motion.displacement, 0.02 * np.sin(2.0 * np.pi * 0.5 * motion.time), atol=1e-15
    )


@settings(max_examples=25, deadline=None)
@given(first=st.floats(0.05, 1.0), second=st.floats(0.05, 1.0))
def test_orders_add_up_in_the_steady_state(first, second):
    """D^a D^b = D^(a + b) on the derivative of a sine, taken from its phasor."""
    omega = 2.0 * np.pi * 2.0
    once = harmonic_motion([0.0, -0.01j * (1j * omega) ** first], 2.0, samples=64)
    both = harmonic_motion([0.0, -0.01j], 2.0, samples=64).fractional(first + second)
    np.testing.assert_allclose(once.fractional(second), both, atol=1e-12 * np.abs(both).max())


def test_one_order_gives_one_row_and_several_give_as_many():
    motion = sine_motion(0.01, 1.0, samples=32)
    assert motion.fractional(1.5).shape == (32,)
    several = motion.fractional([0.5, 1.5, 2.0])
    assert several.shape == (3, 32)
    np.testing.assert_allclose(several[1], motion.fractional(1.5))
    np.testing.assert_allclose(several[2], motion.acceleration, atol=1e-12)


def test_more_harmonics_than_the_samples_hold_are_refused():
    with pytest.raises(InputError, match="more than twice 40 harmonics"):
        harmonic_motion(np.ones(41), 1.0, samples=80)
    with pytest.raises(InputError, match="frequency"):
        harmonic_motion([0.0, 1.0], 0.0)


@pytest.mark.parametrize("order", [0.5, 1.5])
def test_a_sampled_motion_from_rest_has_the_caputo_derivative(order):
    """D^a t^3 = 6 t^(3 - a) / Gamma(4 - a) from rest at nothing."""
    time = np.linspace(0.0, 1.0, 4001)
    motion = sampled_motion(time, time**3)
    expected = 6.0 * time ** (3.0 - order) / gamma(4.0 - order)
    np.testing.assert_allclose(motion.fractional(order), expected, atol=2e-3)
    np.testing.assert_allclose(motion.velocity, 3.0 * time**2, atol=1e-4)
    assert motion.operator == "caputo"
    assert not motion.periodic


def test_a_sampled_steady_state_has_the_weyl_derivative():
    reference = harmonic_motion(COEFFICIENTS, 3.0, samples=256)
    motion = sampled_motion(reference.time, reference.displacement, kind="weyl")
    assert motion.periodic
    np.testing.assert_allclose(motion.fractional(1.89), reference.fractional(1.89), atol=1e-9)


def test_time_and_displacement_of_unequal_length_are_refused():
    with pytest.raises(InputError, match="displacement"):
        sampled_motion(np.arange(5.0), np.arange(4.0))


def test_inputs_are_not_changed():
    time, x = np.linspace(0.0, 1.0, 50), np.linspace(0.0, 1.0, 50) ** 2
    time.flags.writeable = x.flags.writeable = False
    sampled_motion(time, x).fractional(0.5)
    coefficients = np.array(COEFFICIENTS)
    coefficients.flags.writeable = False
    harmonic_motion(coefficients, 1.0).fractional(0.5)

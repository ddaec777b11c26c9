"""Eq. 8 against the steady-state derivative, describing functions and its limits."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from models.checks import InputError
from models.constitutive import FittedTerm, ForceModel, foim, ioim_laminar
from models.device import Device
from models.equivalents import fractional_equivalents, harmonic_equivalents, order_by_phase


@given(order=st.floats(0.0, 2.0), frequency=st.floats(0.01, 50.0))
def test_inertance_and_damping_give_the_steady_state_derivative(order, frequency):
    # Eq. 4: D^order A sin(wt) = A w^order sin(wt + order pi/2).
    omega, amplitude, coefficient = 2 * math.pi * frequency, 0.01, 500.0
    wt = np.linspace(0.0, 2 * math.pi, 50)
    exact = coefficient * amplitude * omega**order * np.sin(wt + order * math.pi / 2)
    inertance, damping = fractional_equivalents(coefficient, order, omega)
    acceleration = -amplitude * omega**2 * np.sin(wt)
    velocity = amplitude * omega * np.cos(wt)
    built = inertance * acceleration + damping * velocity
    np.testing.assert_allclose(built, exact, atol=1e-9 * np.abs(exact).max())


def test_order_two_is_an_inerter_and_order_one_a_damper():
    omega = np.array([1.0, 10.0, 100.0])
    mass, damper = fractional_equivalents(3.0, 2.0, omega), fractional_equivalents(3.0, 1.0, omega)
    np.testing.assert_allclose(mass.inertance, 3.0)
    np.testing.assert_allclose(mass.damping, 0.0, atol=1e-12)
    np.testing.assert_allclose(damper.damping, 3.0)
    np.testing.assert_allclose(damper.inertance, 0.0, atol=1e-12)


def test_order_below_one_has_negative_inertance():
    assert float(fractional_equivalents(1.0, 0.48, 3.0).inertance) < 0.0


@pytest.mark.parametrize(
    ("term", "damping"),
    [
        # Describing functions: friction 4 f/(pi V), v|v| 8 V/(3 pi), |v|^p by the Beta function.
        (FittedTerm("coulomb-friction", 400.0), lambda v: 4 * 400.0 / (math.pi * v)),
        (FittedTerm("quadratic-damping", 790.0), lambda v: 8 / (3 * math.pi) * 790.0 * v),
        (
            FittedTerm("power-law-damping", 60.0, {"exponent": 1.75}),
            lambda v: 60.0 * v**0.75 * 2 / math.sqrt(math.pi)
            * math.gamma(1.75 / 2 + 1) / math.gamma(1.75 / 2 + 1.5),
        ),
    ],
)
def test_nonlinear_terms_follow_their_describing_function(term, damping):
    omega, amplitude = 7.0, 0.01
    found = harmonic_equivalents(ForceModel((term,)), amplitude, omega)
    assert float(found.damping) == pytest.approx(damping(omega * amplitude), rel=1e-5)
    assert abs(float(found.inertance)) * omega < 1e-6 * float(found.damping)


def test_laminar_model_adds_up():
    model = ioim_laminar(Device.preset("device-12"), friction=0.0)
    omega, amplitude = np.array([2.0, 20.0]), 0.005
    found = harmonic_equivalents(model, amplitude, omega)
    c1, c2 = Device.preset("device-12").laminar_coefficients
    np.testing.assert_allclose(found.inertance, model.coefficient("inertia"), rtol=1e-9)
    expected = c2 + 8 / (3 * math.pi) * c1 * omega * amplitude
    np.testing.assert_allclose(found.damping, expected, rtol=1e-6)


def test_phase_gives_the_order_back_at_every_frequency():
    model = foim(Device.preset("device-12"), 0.57, 1.89, friction=0.0)
    omega = np.geomspace(0.5, 200.0, 7)
    found = harmonic_equivalents(model, 0.005, omega)
    np.testing.assert_allclose(order_by_phase(found, omega), 1.89, rtol=1e-9)


@pytest.mark.parametrize("omega", [0.0, -1.0, [1.0, 0.0]])
def test_frequency_must_be_above_zero(omega):
    with pytest.raises(InputError, match="omega must be > 0"):
        fractional_equivalents(1.0, 1.5, omega)


def test_order_outside_two_is_refused():
    with pytest.raises(InputError, match="order must be a finite number >= 0.0 and <= 2.0"):
        fractional_equivalents(1.0, 2.4, 1.0)

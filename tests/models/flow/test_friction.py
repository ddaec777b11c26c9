from dataclasses import replace

import numpy as np
import pytest
from fluids.friction import (
    friction_factor,
    helical_laminar_fd_Schmidt,
    helical_laminar_fd_White,
    helical_Re_crit,
    helical_turbulent_fd_Schmidt,
)

from models.checks import InputError
from models.device import Device
from models.flow import channel_force, friction_times_reynolds, transition_reynolds
from models.flow.friction import LAMINAR, TRANSITION, TURBULENT

TWELVE = Device.preset("device-12")
TEN = Device.preset("device-10")


def test_published_example_of_white():
    # fluids' documented example: Re = 250, d = 0.02 m, D = 0.1 m gives f = 0.4063281817830202.
    value = friction_times_reynolds(250.0, curvature=0.2) / 250.0
    assert value == pytest.approx(0.4063281817830202, rel=1e-12)


def test_correlations_stand_outside_the_transition():
    low = friction_times_reynolds(2000.0, curvature=0.05, laminar="schmidt")
    assert low == pytest.approx(2000.0 * helical_laminar_fd_Schmidt(2000.0, 0.05, 1.0), rel=1e-13)
    high = friction_times_reynolds(20000.0, curvature=0.05)
    expected = 20000.0 * helical_turbulent_fd_Schmidt(20000.0, 0.05, 1.0)
    assert high == pytest.approx(expected, rel=1e-13)


@pytest.mark.parametrize("laminar", sorted(LAMINAR))
def test_straight_pipe_limit(laminar):
    re = np.array([0.0, 1e-300, 1.0, 1500.0])
    for curvature in (0.0, 1e-9):
        value = friction_times_reynolds(re, curvature=curvature, laminar=laminar)
        np.testing.assert_allclose(value, 64.0, rtol=1e-4)
    turbulent = friction_times_reynolds(1e5, curvature=1e-12)
    assert turbulent == pytest.approx(1e5 * friction_factor(1e5), rel=1e-4)


@pytest.mark.parametrize("turbulent", sorted(TURBULENT))
@pytest.mark.parametrize("transition", sorted(TRANSITION))
def test_blend_is_continuous_with_its_slope(turbulent, transition):
    centre = transition_reynolds(0.05, method=transition)
    re = centre * np.exp(np.linspace(-0.3, 0.3, 4001))
    re = re[re < 2.1e4]  # fluids' Schmidt correlation itself jumps at 22,000
    value = friction_times_reynolds(
        re, curvature=0.05, turbulent=turbulent, transition=transition, width=0.15
    )
    step = np.diff(np.log(value)) / np.diff(np.log(re))
    assert np.max(np.abs(np.diff(step))) < 0.02


def test_transition_depends_on_the_author_and_tends_to_the_straight_pipe():
    values = [transition_reynolds(0.05, method=m) for m in TRANSITION]
    assert max(values) / min(values) > 1.3
    assert 5000.0 < min(values) < max(values) < 8500.0
    assert transition_reynolds(0.0) == pytest.approx(2300.0, rel=1e-5)
    assert transition_reynolds(0.1) == helical_Re_crit(0.1, 1.0)


def test_channel_force_is_odd_dissipative_and_zero_at_rest():
    speed = np.arange(-20, 21) / 20.0
    speed.flags.writeable = False
    force = channel_force(TEN, speed)
    np.testing.assert_array_equal(force, -force[::-1])
    assert np.all(force[speed != 0.0] * speed[speed != 0.0] > 0.0)
    assert force[20] == 0.0


def test_channel_force_is_poiseuille_at_creep():
    device = replace(TWELVE, transition_length=0.0)
    expected = device.laminar_coefficients.c2 * 1e-4
    assert channel_force(device, 1e-4) == pytest.approx(expected, rel=1e-12)


def test_transitions_add_their_length_at_creep():
    ratio = channel_force(TWELVE, 1e-4) / channel_force(replace(TWELVE, transition_length=0), 1e-4)
    assert ratio == pytest.approx(TWELVE.total_length / TWELVE.channel_length, rel=1e-12)


def test_curvature_raises_the_resistance_as_white_says():
    device = replace(TWELVE, transition_length=0.0)
    speed = 0.3
    re = 800.0 * speed * device.area_ratio * 0.01 / 0.027
    factor = re * helical_laminar_fd_White(re, 0.01, 0.2) / 64.0
    expected = device.laminar_coefficients.c2 * speed * factor
    assert factor > 1.5
    assert channel_force(device, speed) == pytest.approx(expected, rel=1e-12)


def test_blasius_is_near_in_a_straight_turbulent_channel():
    # Same length, no curvature: Eq. 6's Blasius term within its known few per cent.
    device = replace(TEN, helix_radius=120.0, turns=7e-3)
    speed = 0.4
    blasius = device.turbulent_coefficients.c1 * speed**1.75
    assert channel_force(device, speed) == pytest.approx(blasius, rel=0.05)


def test_bad_input_is_refused():
    with pytest.raises(InputError, match="friction: laminar must be one of white, schmidt"):
        friction_times_reynolds(1.0, curvature=0.1, laminar="best")
    with pytest.raises(InputError, match="transition: method"):
        transition_reynolds(0.1, method="best")
    with pytest.raises(InputError, match="curvature"):
        friction_times_reynolds(1.0, curvature=1.0)
    with pytest.raises(InputError, match="width"):
        friction_times_reynolds(1.0, curvature=0.1, width=0.0)

"""Relaxation beside a spring and a dashpot whose joint is moved step by step."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from models.motion import harmonic_motion, sampled_motion
from models.terms import find_term

STIFFNESS, DASHPOT = 4e3, 900.0
SHAPE = {"relaxation_time": DASHPOT / STIFFNESS}


@pytest.mark.parametrize("frequency", [0.05, 0.7, 9.0])
def test_a_steady_cycle_is_that_of_both_in_series(frequency):
    motion = harmonic_motion([0.004, -0.01j, 0.002], frequency, samples=1024)
    found = np.fft.rfft(STIFFNESS * find_term("relaxation").column(motion, SHAPE)) / 512
    for k, line in ((1, -0.01j), (2, 0.002)):
        rate = 2j * np.pi * k * frequency
        expected = line / (1.0 / STIFFNESS + 1.0 / (DASHPOT * rate))
        assert abs(found[k] - expected) < 1e-9 * abs(expected)
    assert abs(found[0]) < 1e-9  # what lasts has relaxed


def test_from_rest_the_joint_between_them_creeps_after_the_motion():
    time = np.linspace(0.0, 4.0, 4001)
    moved = np.where(time < 1.0, 0.01 * time, 0.01) + 0.002 * np.sin(9.0 * time) * (time > 2.0)

    def creep(t, joint):
        return STIFFNESS * (np.interp(t, time, moved) - joint) / DASHPOT

    joint = solve_ivp(creep, (0.0, 4.0), [0.0], t_eval=time, rtol=1e-9, atol=1e-12, max_step=2e-3)
    motion = sampled_motion(time, moved)
    force = STIFFNESS * find_term("relaxation").column(motion, SHAPE)
    expected = STIFFNESS * (moved - joint.y[0])
    np.testing.assert_allclose(force, expected, atol=1e-5 * np.abs(expected).max())

"""Saturating damping beside the laws of what saturates: an eddy-current brake, a thinning oil."""

import numpy as np
import pytest

from models.motion import sampled_motion
from models.terms import find_term

TIME = np.linspace(0.0, 20.0, 4001)


def force(speed, **shape):
    """Return the column at speeds that are held: the motion is a ramp of each."""
    made = []
    for v in speed:
        column = find_term("saturating-damping").column(sampled_motion(TIME, v * TIME), shape)
        made.append(column[TIME.size // 2])
    return np.array(made)


def test_with_a_fall_of_two_it_is_an_eddy_current_brake():
    greatest, knee = 900.0, 0.25
    speed = np.array([-1.4, -0.25, 0.02, 0.25, 0.6])
    brake = 2.0 * greatest / (speed / knee + knee / speed)
    found = 2.0 * greatest / knee * force(speed, knee_speed=knee, fall=2.0, sharpness=2.0)
    np.testing.assert_allclose(found, brake, rtol=1e-6)


def test_with_a_fall_of_one_it_goes_to_a_level():
    np.testing.assert_allclose(force([2.0, 8.0, -8.0], knee_speed=0.01, fall=1.0, sharpness=2.0),
                               [0.01, 0.01, -0.01], rtol=1e-4)  # fmt: skip


@pytest.mark.parametrize("index", [0.35, 0.8])
def test_a_thinning_oil_flows_as_a_power_of_speed_far_beyond_the_knee(index):
    slow, fast, faster = force([1e-4, 5.0, 10.0], knee_speed=0.01, fall=1.0 - index, sharpness=2.0)
    assert slow == pytest.approx(1e-4, rel=1e-3)
    assert np.log2(faster / fast) == pytest.approx(index, abs=1e-4)

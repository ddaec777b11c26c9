"""What of a force is a curve of speed, beside what it was made of."""

import numpy as np
import pytest

from models.terms.speed_curve import SpeedCurves, nodes_of

SPEED = 0.4 * np.sin(np.linspace(0.0, 2.0 * np.pi, 1500, endpoint=False))


def valve(speed):
    """A table: steep below one speed, flat beyond, less in the other direction."""
    return np.interp(speed, [-0.4, -0.1, 0.0, 0.05, 0.4], [-130.0, -100.0, 0.0, 200.0, 240.0])


def test_a_curve_of_speed_is_met_and_what_turns_beside_it_is_left_out():
    curves = SpeedCurves.of(SPEED)
    acceleration = np.gradient(SPEED)
    found = curves.fitted(valve(SPEED) + 1e4 * acceleration)
    made = np.interp(SPEED, nodes_of(0.4), found)
    assert np.std(made - valve(SPEED)) < 0.02 * np.std(valve(SPEED))


@pytest.mark.parametrize("size", [1.0, -40.0])
def test_beside_a_jump_it_stays_between_what_there_is(size):
    found = SpeedCurves.of(SPEED[1:]).fitted(size * np.sign(SPEED[1:]))
    assert np.abs(found).max() <= 1.2 * abs(size)


def test_nodes_without_samples_lie_on_a_line_between_the_others():
    nodes = nodes_of(0.4)
    speed = np.concatenate([SPEED[np.abs(SPEED) > 0.2], [0.4]])
    found = SpeedCurves.of(speed).fitted(300.0 * speed)
    np.testing.assert_allclose(found, 300.0 * nodes, rtol=0.05, atol=3.0)

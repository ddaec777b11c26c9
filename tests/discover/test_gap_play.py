"""A rod with play in an eye lined with rubber, stepped by SciPy; the lining's curve is its own."""

from functools import cache

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from discover.gap import close_gap
from tests.discover.gap_data import campaign

MASS, VISCOUS = 120.0, 800.0
BASE = "fit:inertia,viscous-damping"
GAP = 4e-5
"""m on either side."""
ROUNDED = 1.5e-5
"""m of rubber that bears before it is met."""
CYCLES = 6
POINTS = 4096
"""Of one cycle."""


def lining(depth, pace):
    """Rubber on either side, that is met along hyperbolas: its spring and its loss."""
    deep = np.array([depth - GAP, -depth - GAP])
    bearing = 0.5 + 0.5 * deep / np.hypot(deep, ROUNDED)
    pressed = 0.5 * (deep + np.hypot(deep, ROUNDED))
    return 7e7 * (pressed[0] - pressed[1]) + 8e4 * np.sum(bearing) * pace


@cache
def cycle(frequency, amplitude):
    """Return the eye's force over one cycle, once it repeats."""
    omega = 2.0 * np.pi * frequency

    def carried(t, y):
        return lining(
            amplitude * np.sin(omega * t) - y[0], amplitude * omega * np.cos(omega * t) - y[1]
        )

    times = (CYCLES + np.arange(POINTS) / POINTS) / frequency
    found = solve_ivp(
        lambda t, y: (y[1], (carried(t, y) - VISCOUS * y[1]) / MASS), (0.0, times[-1]),
        (0.0, amplitude * omega), method="LSODA", t_eval=times, rtol=1e-7, atol=1e-10,
        max_step=1e-3 / frequency,
    )
    return np.array([carried(t, y) for t, y in zip(times, found.y.T, strict=True)])


def law(t, x, v, a):
    frequency = round(float(np.abs(v).max() / np.abs(x).max()) / (2.0 * np.pi), 1)
    force = cycle(frequency, round(float(np.abs(x).max()), 4))
    phase = np.mod(t * frequency, 1.0)
    return np.interp(phase, np.arange(POINTS + 1) / POINTS, np.append(force, force[0]))


@pytest.fixture(scope="module")
def found():
    return close_gap(campaign(law), BASE)


def test_play_in_a_lined_eye_is_no_mount_that_yields(found):
    first = found.rounds[0]
    assert first.effect == "backlash"
    assert first.probability > 0.9
    play = next(t for t in found.mended if t.fitted.id == "backlash")
    assert play.fitted.shape["softness"] > 0.0


def test_the_gap_shrinks_on_records_that_were_left_out(found):
    assert found.held_out_gap_percent > 5.0 * found.noise_percent
    assert found.final_held_out_gap_percent < found.held_out_gap_percent / 3.0

"""A rod with play in an eye, lined with rubber along a curve of its own, or hard; by SciPy."""

from functools import cache

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from discover.gap import close_gap
from tests.discover.gap_data import campaign

MASS, VISCOUS = 120.0, 800.0
BASE = "fit:inertia,viscous-damping"
RIVALS = (
    "backlash", "series-compliance", "time-delay", "stiffness", "cubic-stiffness",
    "coulomb-friction", "hysteresis", "force-offset",
)  # fmt: skip
"""What play is mistaken for, and what has a part of its loop."""
GAP = 4e-5
"""m on either side."""
ROUNDED = 1.5e-5
"""m of rubber that bears before it is met."""
STEEL, LOSS = 1.2e8, 8e4
CYCLES = 6
POINTS = 16384
"""Of one cycle."""


def lining(depth, pace):
    """Rubber on either side, that is met along hyperbolas: its spring and its loss."""
    deep = np.array([depth - GAP, -depth - GAP])
    bearing = 0.5 + 0.5 * deep / np.hypot(deep, ROUNDED)
    pressed = 0.5 * (deep + np.hypot(deep, ROUNDED))
    return 7e7 * (pressed[0] - pressed[1]) + 8e4 * np.sum(bearing) * pace


def bare(depth, pace):
    """Steel on either side, that only pushes."""
    beyond = depth - np.clip(depth, -GAP, GAP)
    force = (STEEL * beyond + LOSS * pace) * (beyond != 0.0)
    return max(force, 0.0) if beyond > 0.0 else min(force, 0.0)


@cache
def cycle(eye, frequency, amplitude):
    """Return the eye's force over one cycle, once it repeats."""
    omega = 2.0 * np.pi * frequency

    def carried(t, y):
        return eye(
            amplitude * np.sin(omega * t) - y[0], amplitude * omega * np.cos(omega * t) - y[1]
        )

    times = (CYCLES + np.arange(POINTS) / POINTS) / frequency
    found = solve_ivp(
        lambda t, y: (y[1], (carried(t, y) - VISCOUS * y[1]) / MASS), (0.0, times[-1]),
        (0.0, amplitude * omega), method="LSODA", t_eval=times, rtol=1e-7, atol=1e-10,
        max_step=1e-3 / frequency,
    )
    return np.array([carried(t, y) for t, y in zip(times, found.y.T, strict=True)])


def through(eye):
    def law(t, x, v, a):
        frequency = round(float(np.abs(v).max() / np.abs(x).max()) / (2.0 * np.pi), 1)
        force = cycle(eye, frequency, round(float(np.abs(x).max()), 4))
        phase = np.mod(t * frequency, 1.0)
        return np.interp(phase, np.arange(POINTS + 1) / POINTS, np.append(force, force[0]))

    return close_gap(campaign(law), BASE, effects=RIVALS)


@pytest.fixture(scope="module")
def found():
    return through(lining)


def test_play_in_a_lined_eye_is_no_mount_that_yields(found):
    first = found.rounds[0]
    assert first.effect == "backlash"
    assert first.probability > 0.9
    play = next(t for t in found.mended if t.fitted.id == "backlash")
    assert play.fitted.shape["softness"] > 0.0


def test_the_gap_shrinks_on_records_that_were_left_out(found):
    assert found.held_out_gap_percent > 5.0 * found.noise_percent
    assert found.final_held_out_gap_percent < found.held_out_gap_percent / 3.0


@pytest.mark.sweep
@pytest.mark.xfail(strict=True, reason="a delay of each test joins the play, and 9.8 % is left")
def test_impacts_of_hard_flanks_are_met_to_the_sample():
    found = through(bare)
    (only,) = found.rounds
    assert only.effect == "backlash"
    play = next(t for t in found.mended if t.fitted.id == "backlash")
    assert play.fitted.shape["gap"] == pytest.approx(2.0 * GAP, rel=0.01)
    assert play.fitted.shape["contact"] == pytest.approx(np.sqrt(STEEL / MASS), rel=0.02)
    assert found.held_out_gap_percent > 10.0 * found.noise_percent
    assert found.final_held_out_gap_percent < 1.3 * found.noise_percent

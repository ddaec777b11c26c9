"""Friction that reverses over too wide a range of speed, and what it hides."""

import numpy as np
import pytest

from discover.gap import close_gap
from discover.records import Campaign, Record

LACKING = "fit:inertia,quadratic-damping,coulomb-friction"


def sweep(amplitude, top, seed, force):
    """Return a linear sweep from 0.3 Hz with the force of a law of v and a, and 1 % noise."""
    rate = (top - 0.3) / 20.0
    t = np.arange(0.0, 20.0, 0.004)
    phase = 2.0 * np.pi * (0.3 * t + 0.5 * rate * t**2)
    w = 2.0 * np.pi * (0.3 + rate * t)
    x = amplitude * np.sin(phase)
    v = amplitude * w * np.cos(phase)
    a = amplitude * (2.0 * np.pi * rate * np.cos(phase) - w**2 * np.sin(phase))
    f = force(v, a)
    f = f + 0.01 * np.std(f) * np.random.default_rng(seed).standard_normal(t.size)
    return Record(f"sweep-{amplitude:g}.csv", t, f, x)


def device(v, a):
    return 330.0 * a + 4500.0 * v + 900.0 * v * np.abs(v) + 190.0 * v / np.hypot(v, 2e-4)


@pytest.fixture(scope="module")
def found():
    records = [sweep(a, 8.0, k, device) for k, a in enumerate((0.003, 0.005, 0.008))]
    return close_gap(Campaign("sweeps", tuple(records)), LACKING)


def test_a_wide_reversal_does_not_hide_viscous_damping(found):
    """Without it the best friction reverses over a twentieth of the speed, as a resistance does."""
    widened = next(t for t in found.baseline if t.id == "coulomb-friction")
    assert widened.shape["transition_speed"] > 3e-3
    first = found.rounds[0]
    assert first.effect == "viscous-damping"
    assert first.probability > 0.9
    assert first.coefficient == pytest.approx(4500.0, rel=0.01)
    assert [r.effect for r in found.rounds] == ["viscous-damping"]
    assert found.verdict == "closed"


def test_a_change_over_time_has_to_show(found):
    """Drift that has settled after a fiftieth of the record fits as well: no name for it."""
    assert "thermal-drift" not in dict(found.rounds[0].alternatives)

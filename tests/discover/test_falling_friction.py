"""Friction that falls with speed, after Bo and Pavelescu, beside viscous damping: no power law."""

import numpy as np
import pytest

from discover import run_study
from discover.records import Campaign
from tests.discover.gap_data import record

MASS, VISCOUS = 40.0, 150.0
SLIDING, STATIC = 8.0, 13.0
"""N."""
PACE, POWER, REVERSAL = 0.02, 0.8, 5e-4
"""m/s over which friction falls, the power of that, and m/s over which it reverses."""
PLAN = ((0.2, 0.02), (0.5, 0.02), (1.0, 0.02), (2.0, 0.015), (3.0, 0.015), (0.5, 0.005))


def law(t, x, v, a):
    """Return the force."""
    friction = SLIDING + (STATIC - SLIDING) * np.exp(-((np.abs(v) / PACE) ** POWER))
    return MASS * a + VISCOUS * v + friction * (2.0 / np.pi) * np.arctan(v / REVERSAL)


def test_a_damper_with_friction_that_falls_is_linear():
    rng = np.random.default_rng(3)
    records = tuple(record(f, a, law, rng, noise=0.01) for f, a in PLAN)
    (band,) = run_study(Campaign("falling friction", records)).bands
    assert band.structure == "IOIM-linear"
    assert band.probability > 0.8
    found = {t.fitted.id: t.fitted.coefficient for t in band.terms}
    assert found["inertia"] == pytest.approx(MASS, rel=0.01)
    assert found["viscous-damping"] == pytest.approx(VISCOUS, rel=0.05)
    assert "stribeck-friction" in {e.term.fitted.id for e in band.extras}

"""Friction that falls with speed, by laws that no term has, beside damping: no power law."""

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
    """Return the force; friction after Bo and Pavelescu."""
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


WIDE = (*PLAN, (1.0, 0.05), (2.0, 0.036), (5.0, 0.014), (8.0, 0.0055))


def law_of_vehicles(t, x, v, a):
    """Return the force of a laminar device; friction after Brown and McPhee, peak at PACE."""
    ratio = np.abs(v) / PACE
    fall = (STATIC - SLIDING) * (v / PACE) / (0.25 * ratio**2 + 0.75) ** 2
    friction = SLIDING * np.tanh(4.0 * v / PACE) + fall
    return 60.0 * a + VISCOUS * v + 1500.0 * np.abs(v) * v + friction


def test_a_laminar_device_with_friction_that_falls_is_laminar():
    rng = np.random.default_rng(4)
    records = tuple(record(f, a, law_of_vehicles, rng, noise=0.003) for f, a in WIDE)
    (band,) = run_study(Campaign("falling friction", records)).bands
    assert band.structure == "IOIM-laminar"
    assert band.probability > 0.8
    found = {t.fitted.id: t.fitted.coefficient for t in band.terms}
    assert found["quadratic-damping"] == pytest.approx(1500.0, rel=0.03)

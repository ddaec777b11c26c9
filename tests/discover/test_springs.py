"""Springs with dry friction: nothing fractional, of however small an order."""

import numpy as np
import pytest

from discover import run_study
from tests.discover.gap_data import campaign

SPRING, CUBIC, SLIDING = 21_500.0, 5.5e7, 40.0
"""N/m, N/m^3, N."""
OTHERS = {"fractional-derivative", "inertia", "viscous-damping"}


def friction(v):
    return SLIDING * np.tanh(v / 0.002)


def test_a_spring_with_friction_is_a_spring():
    def law(t, x, v, a):
        return SPRING * x + friction(v)

    (band,) = run_study(campaign(law, seed=1)).bands
    assert band.structure == "other" and band.probability > 0.8
    found = {t.fitted.id: t.fitted.coefficient for t in band.terms}
    assert found["stiffness"] == pytest.approx(SPRING, rel=0.005)
    assert not OTHERS & set(found)


def test_a_spring_that_hardens_has_a_cubic_term_beside_it():
    def law(t, x, v, a):
        return SPRING * x + CUBIC * x**3 + friction(v)

    (band,) = run_study(campaign(law, seed=2)).bands
    found = {t.fitted.id: t.fitted.coefficient for t in band.terms}
    assert found["stiffness"] == pytest.approx(SPRING, rel=0.01)
    assert found["cubic-stiffness"] == pytest.approx(CUBIC, rel=0.02)
    assert not OTHERS & set(found)

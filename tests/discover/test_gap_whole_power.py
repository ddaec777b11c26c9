"""Powers that are nearly whole, and one that is not."""

import numpy as np
import pytest

from discover.gap import close_gap
from tests.discover.gap_data import campaign

BASELINE = "fit:inertia,viscous-damping,coulomb-friction"


def arcs(u):
    """Two seals that near their limit slowly."""
    return 2.0 / np.pi * (0.6 * np.arctan(u) + 0.4 * np.arctan(u / 8.0))


def law(exponent, seal=200.0, over=3e-4):
    def force(t, x, v, a):
        grown = np.sign(v) * np.abs(v / 0.1) ** exponent
        return 120.0 * a + 300.0 * v + seal * arcs(v / over) + 60.0 * grown

    return force


@pytest.mark.parametrize("exponent", [2.0, 2.06])
def test_a_power_of_nearly_two_is_quadratic_damping(exponent):
    """Beside friction of another curve it was a power law with certainty, also where it is v|v|."""
    found = close_gap(campaign(law(exponent)), BASELINE)
    (only,) = found.rounds
    assert only.effect == "quadratic-damping"
    assert only.coefficient == pytest.approx(60.0 / 0.1**exponent, rel=0.05)
    assert found.final_held_out_gap_percent < 1.1 * found.noise_percent


def test_viscous_damping_is_no_low_power_beside_seals_that_near_their_limit_slowly():
    """It was a power of 0.75 with certainty, which made up for the curve."""
    found = close_gap(campaign(law(2.0)), "fit:inertia,quadratic-damping,coulomb-friction")
    (only,) = found.rounds
    assert only.effect == "viscous-damping"
    assert only.probability < 0.9
    assert "power-law-damping" in dict(only.alternatives)
    assert only.coefficient == pytest.approx(300.0, rel=0.15)


def test_a_low_power_that_no_curve_of_friction_makes_up_for_keeps_its_name():
    def low(t, x, v, a):
        grown = 30.0 * np.sign(v) * np.abs(v / 0.1) ** 0.35
        return 120.0 * a + 1200.0 * v * np.abs(v) + 60.0 * arcs(v / 3e-4) + grown

    found = close_gap(campaign(low), "fit:inertia,quadratic-damping,coulomb-friction")
    assert found.rounds[0].effect == "power-law-damping"


def test_the_power_of_turbulent_flow_is_not():
    found = close_gap(campaign(law(1.75, 90.0), noise=0.003), BASELINE)
    first = found.rounds[0]
    assert first.effect == "power-law-damping"
    assert first.parameters["exponent"] == pytest.approx(1.75, abs=0.1)

"""End stops as rigs have them: bumpers that lose energy, cushions, ends that are not even.

Forces are written here from the contact laws of the literature, at the exact motion. The catalogue
has the first two laws, so that their tests prove recovery, not that a rig's bumper is met.
"""

import numpy as np
import pytest

from discover.gap import close_gap
from tests.discover.gap_data import campaign, device

GAP, STIFFNESS = 0.009, 2e4


def bumper(x, v):
    """Hunt and Crossley (1975)."""
    return STIFFNESS * np.maximum(np.abs(x) - GAP, 0.0) * (1.0 + 2.0 * v * np.sign(x))


def spring_and_damper(x, v):
    """Kelvin and Voigt's, which lets go before it would pull."""
    push = STIFFNESS * (np.abs(x) - GAP) + 300.0 * v * np.sign(x)
    return np.where(np.abs(x) > GAP, np.maximum(push, 0.0), 0.0)


def cushion(x, v):
    """A spear closes the outlet: a square law on the way in, a check valve on the way out."""
    return np.where(x * v > 0.0, 4e6 * np.maximum(np.abs(x) - GAP, 0.0) * v**2, 0.0)


@pytest.mark.parametrize("push", [bumper, spring_and_damper, cushion])
def test_a_stop_that_dissipates_is_named_and_met_to_the_noise(push):
    found = close_gap(
        campaign(lambda t, x, v, a: device(t, x, v, a) + np.sign(x) * push(x, v)),
        "fit:inertia,viscous-damping",
    )
    (only,) = found.rounds
    assert only.effect == "end-stop"
    assert only.probability > 0.9
    assert only.parameters["gap"] == pytest.approx(GAP, rel=0.01)
    assert found.final_gap_percent < 1.2 * found.noise_percent


def test_ends_that_are_not_even_are_two_stops_of_one_name():
    def law(t, x, v, a):
        above, below = np.maximum(x - 0.008, 0.0), np.maximum(-0.01 - x, 0.0)
        return device(t, x, v, a) + STIFFNESS * (above - below)

    found = close_gap(campaign(law), "fit:inertia,viscous-damping")
    (only,) = found.rounds
    assert only.effect == "end-stop"
    assert only.probability > 0.9
    stops = [t.fitted for t in found.mended if t.fitted.id == "end-stop"]
    gaps = {t.shape["side"]: t.shape["gap"] for t in stops}
    assert gaps == {1.0: pytest.approx(0.008, rel=0.01), -1.0: pytest.approx(0.01, rel=0.01)}

"""Cavitation: suction can't fall below vapour pressure, so force in one direction is limited."""

import numpy as np
from numba import njit

from models.checks import Array
from models.motion import Motion
from models.terms.sensor_clipping import excess
from models.terms.term import ForceOf, Parameter, Shape, Term


def transform(force_of: ForceOf, motion: Motion, coefficient: float, shape: Shape) -> Array:
    """Return the device's force less `coefficient` of what exceeds the limit in one direction.

    A void has to be filled again before force can rise: for `delay` (a share of the time spent
    in the void) the force stays away after the limit is left.
    """
    force = force_of(motion)
    return np.asarray(force - coefficient * _lost(force, motion, shape))


def _lost(force: Array, motion: Motion, shape: Shape) -> Array:
    side = 1.0 if shape["side"] >= 0.0 else -1.0
    turned = side * force
    torn = excess(turned, {"limit": shape["limit"], "softness": shape["softness"], "side": 1.0})
    lag = shape["refill"]
    if lag == 0.0:
        return np.asarray(side * torn)
    passes = 2 if motion.periodic else 1
    return np.asarray(side * _void(turned, torn, shape["limit"], lag, passes))


@njit(cache=True)  # type: ignore[untyped-decorator]
def _void(turned: Array, torn: Array, limit: float, lag: float, passes: int) -> Array:
    """Return the force lost while the void, grown by what is lost, fills again."""
    result = np.zeros_like(turned)
    void = 0.0
    for _ in range(passes):
        for i in range(turned.size):
            if torn[i] > 0.0:
                void += lag * torn[i]
                result[i] = torn[i]
            elif void > 0.0:
                lost = min(turned[i], void) if turned[i] > 0.0 else 0.0
                void -= max(limit - turned[i], 0.0)
                result[i] = lost if void > 0.0 else 0.0
            else:
                result[i] = 0.0
    return result


TERM = Term(
    "cavitation",
    "1",
    "force in one direction is limited",
    transform=transform,
    acts="output",
    parameters=(
        Parameter("limit", 0.2, 1.0, 0.7, "N", "force"),
        Parameter("softness", 0.0, 0.5, 0.0, "N"),
        Parameter("refill", 0.0, 2.0, 0.0, ""),
        Parameter("side", -1.0, 1.0, -1.0, ""),
    ),
    nonnegative=True,
    mistaken_for=("asymmetric-damping", "sensor-clipping"),
)

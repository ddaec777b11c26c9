"""Damping that differs between extension and compression."""

import numpy as np

from models.checks import Array
from models.motion import Motion
from models.terms.scales import Scales
from models.terms.term import Parameter, Shape, Start, Term


def column(motion: Motion, shape: Shape) -> Array:
    """Return |v| to a `power`: half the difference of the two directions' forces.

    With power 1 both are viscous. With `side` 1 or -1 the force is there in extension or in
    compression only, and resists.
    """
    side, power = shape.get("side", 0.0), shape.get("power", 1.0)
    if side == 0.0:
        return np.asarray(np.abs(motion.velocity) ** power)
    return np.asarray(side * np.maximum(side * motion.velocity, 0.0) ** power)


def starts(scales: Scales) -> list[Start]:
    """Return a loss that differs by direction, or is of one way only, at several powers of speed.

    Of power 1, one way only is a loss that differs beside viscous damping.
    """
    others = [
        Start.one(power=power, side=side)
        for power in (0.5, 1.5, 2.0, 3.0)
        for side in (0.0, 1.0, -1.0)
    ]
    return [Start.one(power=1.0, side=0.0), *others]


def described(shape: Shape) -> str:
    """Return in which direction and at which power of speed the force is there."""
    side, power = shape.get("side", 0.0), shape.get("power", 1.0)
    where = {1.0: "in extension only", -1.0: "in compression only"}.get(side, "")
    how = "" if power == 1.0 else f"with speed to the power {power:g}"
    return " ".join(part for part in (where, how) if part)


TERM = Term(
    "asymmetric-damping",
    "N s^{power}/m^{power}",
    "c times |v|: damping c_v + c in extension, c_v - c in compression; or a power of v one way",
    column,
    parameters=(
        Parameter("power", 0.25, 4.0, 1.0, "", fitted=False),
        Parameter("side", -1.0, 1.0, 0.0, "", fitted=False),
    ),
    mistaken_for=("force-offset", "cavitation"),
    starts=starts,
    described=described,
)

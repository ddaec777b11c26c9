"""Quadratic stiffness: a spring that is stiffer to one side, as enclosed gas."""

import numpy as np

from models.checks import Array
from models.motion import Motion
from models.terms.scales import Scales
from models.terms.term import Parameter, Shape, Start, Term

_MOST_CLOSED = 0.98


def column(motion: Motion, shape: Shape) -> Array:
    """Return the square of the displacement, m^2.

    With a `closure` L (m) above 0 it is x^2 / (1 - x/L), on `side` -1 with -x in place of x: what
    an enclosed gas, whose column is L long in the middle, adds to its offset and its stiffness
    (at constant temperature exactly: 1 / (1 - u) = 1 + u + u^2 / (1 - u)).
    """
    x = motion.displacement
    closure, side = shape.get("closure", 0.0), shape.get("side", 1.0)
    if closure == 0.0:
        return np.asarray(x**2)
    return np.asarray(x**2 / (1.0 - np.minimum(side * x / closure, _MOST_CLOSED)))


def starts(scales: Scales) -> list[Start]:
    """Return a square, and gas that is compressed to either side."""
    size = scales.displacement
    gas = [Start.one(closure=c * size, side=s) for c in (1.2, 2.0, 5.0) for s in (1.0, -1.0)]
    return [Start.one(), *gas]


TERM = Term(
    "quadratic-stiffness",
    "N/m^2",
    "k2 times displacement squared, over 1 - x/L where gas closes",
    column,
    parameters=(
        Parameter("closure", 1.01, 20.0, 0.0, "m", "displacement", "log"),
        Parameter("side", -1.0, 1.0, 1.0, "", fitted=False),
    ),
    mistaken_for=("force-offset", "asymmetric-damping"),
    starts=starts,
)

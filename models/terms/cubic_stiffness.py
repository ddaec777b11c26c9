"""Cubic stiffness: a spring that hardens or softens."""

import numpy as np

from models.checks import Array
from models.motion import Motion
from models.terms.scales import Scales
from models.terms.term import Parameter, Shape, Start, Term

_MOST_CLOSED = 0.98


def column(motion: Motion, shape: Shape) -> Array:
    """Return the cube of the displacement, m^3.

    With a `closure` L (m) above 0 it is x^3 / (1 - x^2/L^2): gas that is compressed and coils that
    close harden faster than the cube. With a `span` s (m) above 0 it is x^3 / (1 + x^2/s^2): a
    wire or a strut across the motion hardens, and beyond about its length is a plain spring.
    """
    x = motion.displacement
    closure, span = shape.get("closure", 0.0), shape.get("span", 0.0)
    left = 1.0 if closure == 0.0 else 1.0 - np.minimum((x / closure) ** 2, _MOST_CLOSED)
    return np.asarray(x**3 / (left if span == 0.0 else left + (x / span) ** 2))


def starts(scales: Scales) -> list[Start]:
    """Return a cube, a spring that closes up, one that levels off."""
    size = scales.displacement
    closing = [Start.one(closure=c * size) for c in (1.05, 1.2, 1.5, 2.5)]
    levelling = [Start.one(span=s * size) for s in (0.2, 0.5, 1.0, 2.5)]
    return [Start.one(), *closing, *levelling]


TERM = Term(
    "cubic-stiffness",
    "N/m^3",
    "k3 times displacement cubed, over 1 - x^2/L^2 where it closes, 1 + x^2/s^2 where it levels",
    column,
    parameters=(
        Parameter("closure", 1.01, 10.0, 0.0, "m", "displacement", "log"),
        Parameter("span", 0.1, 10.0, 0.0, "m", "displacement", "log"),
    ),
    mistaken_for=("end-stop", "stiffness"),
    starts=starts,
)

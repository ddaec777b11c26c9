"""Fractional derivative of displacement: inertia and damping with memory in one term (Eq. 7)."""

from models.checks import Array
from models.motion import Motion
from models.terms.scales import Scales
from models.terms.term import Parameter, Shape, Start, Term


def column(motion: Motion, shape: Shape) -> Array:
    """Return D^order x, m/s^order, by the operator of the motion."""
    return motion.fractional(shape["order"])


def starts(scales: Scales) -> list[Start]:
    """Return orders between the whole ones."""
    return [Start.one(order=0.1 * k) for k in range(1, 20) if k != 10]


TERM = Term(
    "fractional-derivative",
    "N s^{order}/m",
    "c times D^order x; the product b(1 + b0) of the FOIM",
    column,
    parameters=(Parameter("order", 0.0, 2.0, 1.9, ""),),
    nonnegative=True,
    mistaken_for=("inertia", "viscous-damping", "stiffness"),
    harmonic=True,
    starts=starts,
)

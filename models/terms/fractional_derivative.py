"""Fractional derivative of displacement: inertia and damping with memory in one term (Eq. 7)."""

from models.checks import Array
from models.motion import Motion
from models.terms.term import Parameter, Shape, Term


def column(motion: Motion, shape: Shape) -> Array:
    """Return D^order x, m/s^order, by the operator of the motion."""
    return motion.fractional(shape["order"])


TERM = Term(
    "fractional-derivative",
    "N s^{order}/m",
    "c times D^order x; the product b(1 + b0) of the FOIM",
    column,
    parameters=(Parameter("order", 0.0, 2.0, 1.9, ""),),
    nonnegative=True,
    mistaken_for=("inertia", "viscous-damping", "stiffness"),
    harmonic=True,
)

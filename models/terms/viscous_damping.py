"""Viscous damping: laminar resistance, in proportion to speed."""

from models.checks import Array
from models.motion import Motion
from models.terms.term import Shape, Term


def column(motion: Motion, shape: Shape) -> Array:
    """Return the velocity, m/s."""
    return motion.velocity


TERM = Term(
    "viscous-damping",
    "N s/m",
    "c times velocity",
    column,
    nonnegative=True,
    mistaken_for=("fractional-derivative", "power-law-damping", "time-delay"),
    harmonic=True,
    derivative=1.0,
)

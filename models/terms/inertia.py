"""Inertance: force in proportion to the relative acceleration of the ends."""

from models.checks import Array
from models.motion import Motion
from models.terms.term import Shape, Term


def column(motion: Motion, shape: Shape) -> Array:
    """Return the acceleration, m/s^2."""
    return motion.acceleration


TERM = Term(
    "inertia",
    "kg",
    "inertance b times acceleration",
    column,
    nonnegative=True,
    mistaken_for=("fractional-derivative", "stiffness", "series-compliance"),
    harmonic=True,
    derivative=2.0,
)

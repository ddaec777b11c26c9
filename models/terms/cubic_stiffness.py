"""Cubic stiffness: a spring that hardens or softens."""

from models.checks import Array
from models.motion import Motion
from models.terms.term import Shape, Term


def column(motion: Motion, shape: Shape) -> Array:
    """Return the cube of the displacement, m^3."""
    return motion.displacement**3


TERM = Term(
    "cubic-stiffness",
    "N/m^3",
    "k3 times displacement cubed",
    column,
    mistaken_for=("end-stop", "stiffness"),
)

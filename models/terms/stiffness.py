"""Linear stiffness: force in proportion to displacement."""

from models.checks import Array
from models.motion import Motion
from models.terms.term import Shape, Term


def column(motion: Motion, shape: Shape) -> Array:
    """Return the displacement, m."""
    return motion.displacement


TERM = Term(
    "stiffness",
    "N/m",
    "k times displacement",
    column,
    mistaken_for=("inertia", "hysteresis", "fractional-derivative"),
    harmonic=True,
    derivative=0.0,
)

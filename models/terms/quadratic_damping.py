"""Quadratic damping: entrance, exit and rough-wall losses, with the square of speed."""

import numpy as np

from models.checks import Array
from models.motion import Motion
from models.terms.term import Shape, Term


def column(motion: Motion, shape: Shape) -> Array:
    """Return v|v|, m^2/s^2."""
    return motion.velocity * np.abs(motion.velocity)


TERM = Term(
    "quadratic-damping",
    "N s^2/m^2",
    "c times v|v|",
    column,
    nonnegative=True,
    mistaken_for=("power-law-damping", "viscous-damping"),
)

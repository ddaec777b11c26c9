"""Damping that differs between extension and compression."""

import numpy as np

from models.checks import Array
from models.motion import Motion
from models.terms.term import Shape, Term


def column(motion: Motion, shape: Shape) -> Array:
    """Return |v|, m/s: half the difference of the two directions' viscous forces."""
    return np.abs(motion.velocity)


TERM = Term(
    "asymmetric-damping",
    "N s/m",
    "c times |v|: viscous damping c_v + c in extension, c_v - c in compression",
    column,
    mistaken_for=("force-offset", "cavitation"),
)

"""Constant force: weight, preload, gas pressure, or the zero of the load cell."""

import numpy as np

from models.checks import Array
from models.motion import Motion
from models.terms.term import Shape, Term


def column(motion: Motion, shape: Shape) -> Array:
    """Return ones."""
    return np.ones_like(motion.displacement)


TERM = Term(
    "force-offset",
    "N",
    "a constant force",
    column,
    mistaken_for=("sensor-drift", "asymmetric-damping"),
)

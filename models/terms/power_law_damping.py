"""Power-law damping: turbulent friction, with a power of speed between one and two."""

import numpy as np

from models.checks import Array
from models.motion import Motion
from models.terms.term import Parameter, Shape, Term


def column(motion: Motion, shape: Shape) -> Array:
    """Return |v|^p sign v, (m/s)^p."""
    return np.sign(motion.velocity) * np.abs(motion.velocity) ** shape["exponent"]


TERM = Term(
    "power-law-damping",
    "N (s/m)^{exponent}",
    "c times |v|^p sign v",
    column,
    parameters=(Parameter("exponent", 0.25, 3.0, 1.75, ""),),
    nonnegative=True,
    mistaken_for=("quadratic-damping", "viscous-damping", "coulomb-friction"),
)

"""Power-law damping: turbulent friction, or a damper whose orifices make another power of speed."""

import numpy as np

from models.checks import Array
from models.motion import Motion
from models.terms.scales import Scales
from models.terms.term import Parameter, Shape, Start, Term


def column(motion: Motion, shape: Shape) -> Array:
    """Return |v|^p sign v, (m/s)^p."""
    return np.sign(motion.velocity) * np.abs(motion.velocity) ** shape["exponent"]


def starts(scales: Scales) -> list[Start]:
    """Return powers of speed between and beyond the whole ones."""
    powers = (0.25, 0.35, 0.5, 0.65, 0.8, 1.2, 1.35, 1.5, 1.65, 1.75, 1.9, 2.3, 2.6, 3.0)
    return [Start.one(exponent=p) for p in powers]


TERM = Term(
    "power-law-damping",
    "N (s/m)^{exponent}",
    "c times |v|^p sign v",
    column,
    parameters=(Parameter("exponent", 0.25, 3.0, 1.75, ""),),
    nonnegative=True,
    mistaken_for=("quadratic-damping", "viscous-damping", "coulomb-friction"),
    starts=starts,
)

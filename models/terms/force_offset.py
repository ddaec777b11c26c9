"""Constant force: weight, preload, gas pressure, or the zero of the load cell."""

import numpy as np

from models.checks import Array
from models.motion import Motion
from models.terms.between_tests import ONLY, numbered, share
from models.terms.scales import Scales
from models.terms.term import Shape, Start, Term


def column(motion: Motion, shape: Shape) -> Array:
    """Return ones, in all tests or in one only."""
    return np.full_like(motion.displacement, share(motion, shape))


def starts(scales: Scales) -> list[Start]:
    """Return one offset in all tests, and one of its own in each."""
    own = tuple({"only": n} for n in numbered(scales))
    return [Start.one(), *([Start(own)] if own else [])]


TERM = Term(
    "force-offset",
    "N",
    "a constant force",
    column,
    mistaken_for=("sensor-drift", "asymmetric-damping"),
    parameters=(ONLY,),
    starts=starts,
    of_channel=True,
    common=0.5,  # by plain fits 9 of 22 devices that others measured have one
)

"""Relaxation: a spring and a dashpot in series, a Maxwell element beside the device."""

import numpy as np

from models.checks import Array
from models.motion import Motion
from models.terms.low_pass import low_passed
from models.terms.scales import Scales
from models.terms.term import Parameter, Shape, Start, Term


def column(motion: Motion, shape: Shape) -> Array:
    """Return what the spring is stretched by, m: a held displacement relaxes as exp(-t/tau).

    Fast motion feels the spring, slow motion the dashpot, of the stiffness times tau. It begins
    relaxed where the motion does not repeat.
    """
    x = motion.displacement
    return x - low_passed(x, motion, shape["relaxation_time"])


def starts(scales: Scales) -> list[Start]:
    """Return times between those that make a dashpot of it and those that make a spring."""
    fastest, slowest = 0.3 / scales.omega, 10.0 / scales.least_omega
    return [Start.one(relaxation_time=float(t)) for t in np.geomspace(fastest, slowest, 8)]


TERM = Term(
    "relaxation",
    "N/m",
    "k times what a spring is stretched by that a dashpot in series lets go",
    column,
    parameters=(Parameter("relaxation_time", 1e-4, 1e5, 1.0, "s", spacing="log"),),
    nonnegative=True,
    follows="path",
    harmonic=True,
    mistaken_for=("fractional-derivative", "stiffness", "viscous-damping", "time-delay"),
    starts=starts,
)

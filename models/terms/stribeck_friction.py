"""Stribeck friction: the fall of seal friction from its static to its sliding value."""

import numpy as np

from models.checks import Array
from models.motion import Motion
from models.terms.term import Parameter, Shape, Term


def column(motion: Motion, shape: Shape) -> Array:
    """Return exp(-(v/v_s)^2) sign v."""
    v = motion.velocity
    return np.exp(-((v / shape["stribeck_velocity"]) ** 2)) * np.sign(v)


TERM = Term(
    "stribeck-friction",
    "N",
    "f_s exp(-(v/v_s)^2) sign v, in addition to Coulomb friction",
    column,
    parameters=(Parameter("stribeck_velocity", 0.01, 0.5, 0.1, "m/s", "speed", "log"),),
    nonnegative=True,
    mistaken_for=("coulomb-friction", "hysteresis"),
)

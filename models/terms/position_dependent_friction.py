"""Friction that differs along the stroke: a tapered or worn bore, a bent rod."""

import numpy as np

from models.checks import Array
from models.motion import Motion
from models.terms.term import Parameter, Shape, Term


def column(motion: Motion, shape: Shape) -> Array:
    """Return sign v times x to a whole `power`, reversing as friction does."""
    speed = shape["transition_speed"]
    v, x = motion.velocity, motion.displacement
    direction = np.sign(v) if speed == 0.0 else np.tanh(v / speed)
    return np.asarray(direction * x ** int(shape["power"]))


TERM = Term(
    "position-dependent-friction",
    "N/m^{power}",
    "f times x (or its square) times sign v",
    column,
    parameters=(
        Parameter("power", 1.0, 4.0, 1.0, ""),
        Parameter("transition_speed", 0.001, 0.3, 0.0, "m/s", "speed", "log"),
    ),
    mistaken_for=("hysteresis", "coulomb-friction"),
)

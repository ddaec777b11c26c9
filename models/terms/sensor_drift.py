"""Sensor drift: the force channel's zero wanders during a record."""

import numpy as np

from models.checks import Array
from models.motion import Motion
from models.terms.term import Parameter, Shape, Term


def column(motion: Motion, shape: Shape) -> Array:
    """Return 1 - exp(-t/T); `settling_time` 0 stands for a straight drift, t in s."""
    elapsed = motion.time - motion.time[0]
    constant = shape["settling_time"]
    return np.asarray(elapsed if constant == 0.0 else -np.expm1(-elapsed / constant))


TERM = Term(
    "sensor-drift",
    "N",
    "f times 1 - exp(-t/T), t from the record's start (N/s where straight)",
    column,
    parameters=(Parameter("settling_time", 0.1, 1e5, 0.0, "s", "", "log"),),
    mistaken_for=("force-offset",),
    follows="time",
)

"""Sensor drift: the force channel's zero wanders during a record, or from test to test."""

import numpy as np

from models.checks import Array
from models.motion import Motion
from models.terms.term import Parameter, Shape, Term


def column(motion: Motion, shape: Shape) -> Array:
    """Return 1 - exp(-t/T), or t to a whole `power` where `settling_time` is 0, t in s.

    Several powers together make a zero that wanders. With `over` above 0 it moves over that many
    of a campaign's tests from `from_test` on and hardly within one: 1, and who knows the test
    scales it. With `only` it is there in that test and no other.
    """
    if shape["over"] > 0.0:
        return np.ones_like(motion.time)
    elapsed = motion.time - motion.time[0]
    constant = shape["settling_time"]
    if constant == 0.0:
        return np.asarray(elapsed ** int(shape["power"]))
    return np.asarray(-np.expm1(-elapsed / constant))


TERM = Term(
    "sensor-drift",
    "N",
    "f times 1 - exp(-t/T), t from the record's start, or its powers (N/s, N/s^2, ...)",
    column,
    parameters=(
        Parameter("settling_time", 0.1, 1e5, 0.0, "s", "", "log"),
        Parameter("power", 1.0, 3.0, 1.0, ""),
        Parameter("from_test", 0.0, 1e6, 0.0, ""),
        Parameter("over", 0.0, 1e6, 0.0, ""),
        Parameter("only", 0.0, 1e6, 0.0, ""),
    ),
    mistaken_for=("force-offset",),
    follows="time",
)

"""Thermal drift: damping that falls, or rises, as the oil warms during a record."""

import numpy as np

from models.checks import Array
from models.motion import Motion
from models.terms.term import Parameter, Shape, Term


def column(motion: Motion, shape: Shape) -> Array:
    """Return velocity times 1 - exp(-t/T), m/s: the change of viscous damping with time.

    `warming_time` 0 stands for a straight change, v t. With `heating` above 0 the change grows
    with the record's mean square speed, in (m/s)^2, to that power: dissipation warms the oil.
    """
    elapsed = motion.time - motion.time[0]
    constant = shape["warming_time"]
    change = elapsed if constant == 0.0 else -np.expm1(-elapsed / constant)
    warming = float(np.mean(motion.velocity**2)) ** shape["heating"]
    return np.asarray(motion.velocity * change * warming)


TERM = Term(
    "thermal-drift",
    "N s/m",
    "c times velocity times 1 - exp(-t/T), t from the record's start",
    column,
    parameters=(
        Parameter("warming_time", 0.1, 1e5, 0.0, "s", "", "log"),
        Parameter("heating", 0.0, 2.0, 0.0, ""),
    ),
    mistaken_for=("sensor-gain", "viscous-damping"),
    follows="time",
)

"""Thermal drift: damping changes as the oil warms, during a record or from test to test."""

import numpy as np

from models.checks import Array
from models.motion import Motion
from models.terms.term import Parameter, Shape, Term


def column(motion: Motion, shape: Shape) -> Array:
    """Return velocity times w = 1 - exp(-t/T), m/s: the change of viscous damping with time.

    `warming_time` 0 stands for a straight change, w = t. With `heating` above 0 w grows with the
    record's mean square speed, in (m/s)^2, to that power: dissipation warms the oil. With
    `saturation` s above 0 the change is w / (1 + s w): viscosity falls exponentially with
    temperature, and with it the heat that it makes (the closed form without cooling). `saturation`
    is per unit of w.

    With `over` above 0 the oil warms over that many of a campaign's tests from `from_test` on, and
    hardly within one: w is 1, and who knows the test scales it.
    """
    if shape["over"] > 0.0:
        return motion.velocity
    elapsed = motion.time - motion.time[0]
    constant = shape["warming_time"]
    change = elapsed if constant == 0.0 else -np.expm1(-elapsed / constant)
    warmed = change * float(np.mean(motion.velocity**2)) ** shape["heating"]
    rate = shape["saturation"]
    return np.asarray(motion.velocity * warmed / (1.0 + rate * warmed))


TERM = Term(
    "thermal-drift",
    "N s/m",
    "c times velocity times 1 - exp(-t/T), t from the record's start",
    column,
    parameters=(
        Parameter("warming_time", 0.1, 1e5, 0.0, "s", "", "log"),
        Parameter("heating", 0.0, 2.0, 0.0, ""),
        Parameter("saturation", 1e-6, 1e9, 0.0, "", "", "log"),
        Parameter("from_test", 0.0, 1e6, 0.0, ""),
        Parameter("over", 0.0, 1e6, 0.0, ""),
    ),
    mistaken_for=("sensor-gain", "viscous-damping"),
    follows="time",
)

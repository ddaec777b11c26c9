"""Thermal drift: damping changes as the oil warms, during a record or from test to test."""

import numpy as np

from models.checks import Array
from models.motion import Motion
from models.terms.between_tests import FROM_TEST, OVER, growing, share
from models.terms.scales import Scales
from models.terms.term import Parameter, Shape, Start, Term


def column(motion: Motion, shape: Shape) -> Array:
    """Return |v|^p sign v times w = 1 - exp(-t/T): the change of damping with time.

    `power` p is 1 for the oil's viscous damping, 0 for the friction of seals, which then reverses
    over `transition_speed` (a jump where that is 0).
    `warming_time` 0 stands for a straight change, w = t. With `heating` above 0 w grows with the
    record's mean square speed, in (m/s)^2, to that power: dissipation warms the oil. With
    `saturation` s above 0 the change is w / (1 + s w): viscosity falls exponentially with
    temperature, and with it the heat that it makes (the closed form without cooling). `saturation`
    is per unit of w.

    With `over` above 0 the oil warms over that many of a campaign's tests from `from_test` on, and
    hardly within one: w is then the share of it in the motion's test.
    """
    damping = _damping(motion.velocity, shape)
    if shape["over"] > 0.0:
        return share(motion, shape) * damping
    elapsed = motion.time - motion.time[0]
    constant = shape["warming_time"]
    change = elapsed if constant == 0.0 else -np.expm1(-elapsed / constant)
    warmed = change * float(np.mean(motion.velocity**2)) ** shape["heating"]
    rate = shape["saturation"]
    return np.asarray(damping * warmed / (1.0 + rate * warmed))


def _damping(velocity: Array, shape: Shape) -> Array:
    """Return what the oil's temperature changes, (m/s)^p."""
    if shape["power"] == 1.0:
        return velocity
    speed = shape["transition_speed"]
    direction = np.sign(velocity) if speed == 0.0 else np.tanh(velocity / speed)
    return np.asarray(direction * np.abs(velocity) ** shape["power"])


def starts(scales: Scales) -> list[Start]:
    """Return oil or seals that warm, with time or with the loss, within tests or between."""
    times = (0.0, *np.geomspace(0.02, 1.0, 5) * scales.duration)
    straight = [
        Start.one(warming_time=float(t), heating=heating) for t in times for heating in (0.0, 1.0)
    ]
    most = 0.5 * scales.speed**2
    saturated = [
        Start.one(warming_time=float(t), heating=1.0, saturation=k / (most * whole))
        for t, whole in ((0.0, scales.duration), (0.3 * scales.duration, 1.0))
        for k in (2.0, 8.0, 30.0)
    ]
    seal = {"power": 0.0, "transition_speed": scales.reversal}
    seals = [Start.one(warming_time=float(t), **seal) for t in times]
    return straight + saturated + seals + growing(scales) + growing(scales, **seal)


TERM = Term(
    "thermal-drift",
    "N (s/m)^{power}",
    "c times velocity, or the sign of it, times 1 - exp(-t/T), t from the record's start",
    column,
    parameters=(
        Parameter("warming_time", 0.1, 1e5, 0.0, "s", "", "log"),
        Parameter("heating", 0.0, 2.0, 0.0, ""),
        Parameter("saturation", 1e-6, 1e9, 0.0, "", "", "log"),
        Parameter("power", 0.0, 2.0, 1.0, "", fitted=False),
        Parameter("transition_speed", 0.001, 0.3, 0.0, "m/s", "speed", "log"),
        FROM_TEST,
        OVER,
    ),
    mistaken_for=("sensor-gain", "viscous-damping"),
    follows=lambda shape: "motion" if shape["over"] > 0.0 else "time",
    starts=starts,
)

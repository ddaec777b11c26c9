"""Sensor gain: the force channel reads too much or too little.

Throughout, in a range of the amplifier, one way, with load, behind a filter, from a test on, more
with every test, or more and more during a record; or it loses what lasts.
"""

import numpy as np

from models.checks import Array
from models.motion import Motion
from models.terms.low_pass import low_passed
from models.terms.term import ForceOf, Parameter, Shape, Term


def transform(force_of: ForceOf, motion: Motion, coefficient: float, shape: Shape) -> Array:
    """Return the force times 1 + g, where the record's peak lies in the amplifier's range.

    The range reaches from a peak force of `threshold` (N) upwards, or up to it where `side` is
    negative. With `one_way` 1 the gain is that of tension (`side` 1) or compression (-1) only.
    With `filter_time` T (s) above 0 the part g passes a low-pass of first order with that time
    constant: slow forces read 1 + g times themselves, fast ones less of g, and late; with
    `digital` 1 it works on the samples.
    With `droop_time` T (s) above 0 it does so too, and g is a loss, as of a charge amplifier or an
    AC-coupled channel (g = -1): slow forces read too little and early.
    With `load_power` p above 0 the part g is that at a force of `load` (N; 0 for 1 N), and goes
    with the force's size to the power p: a cell that is not linear.
    A gain that is there from a campaign's test number `from_test` on, and grows for `over` tests
    until it is whole, can't be told from the motion: who knows the test scales it. With
    `settling_time` T (s) above 0 it is 1 - exp(-t/T) of itself, t from the record's start.
    """
    force = force_of(motion)
    if shape["settling_time"] > 0.0:
        elapsed = motion.time - motion.time[0]
        settled = -np.expm1(-elapsed / shape["settling_time"])
        return np.asarray(force * (1.0 + coefficient * settled))
    slow = shape["filter_time"] or shape["droop_time"]
    if slow > 0.0:
        digital = shape["digital"] > 0.0 and shape["filter_time"] > 0.0
        return force + coefficient * low_passed(force, motion, slow, digital=digital)
    if shape["load_power"] > 0.0:
        loaded = (np.abs(force) / (shape["load"] or 1.0)) ** shape["load_power"]
        return np.asarray(force * (1.0 + coefficient * loaded))
    if shape["one_way"] > 0.0:
        return np.where(shape["side"] * force > 0.0, 1.0 + coefficient, 1.0) * force
    peak = float(np.abs(force).max())
    inside = peak >= shape["threshold"] if shape["side"] >= 0.0 else peak < shape["threshold"]
    return force * (1.0 + coefficient) if inside else force


TERM = Term(
    "sensor-gain",
    "1",
    "the force channel reads 1 + g times the force",
    transform=transform,
    acts="output",
    parameters=(
        Parameter("threshold", 0.0, 1e9, 0.0, "N"),
        Parameter("side", -1.0, 1.0, 1.0, ""),
        Parameter("one_way", 0.0, 1.0, 0.0, ""),
        Parameter("from_test", 0.0, 1e6, 0.0, ""),
        Parameter("over", 0.0, 1e6, 0.0, ""),
        Parameter("settling_time", 0.1, 1e5, 0.0, "s", "", "log"),
        Parameter("filter_time", 1e-6, 10.0, 0.0, "s", "", "log"),
        Parameter("digital", 0.0, 1.0, 0.0, ""),
        Parameter("droop_time", 1e-6, 1e5, 0.0, "s", "", "log"),
        Parameter("load", 1e-9, 1e9, 0.0, "N"),
        Parameter("load_power", 0.0, 4.0, 0.0, ""),
    ),
    mistaken_for=("inertia", "viscous-damping"),
)

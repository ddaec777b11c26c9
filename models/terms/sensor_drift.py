"""Sensor drift: the force channel's zero wanders during a record, or from test to test."""

import numpy as np

from models.checks import Array
from models.motion import Motion
from models.terms.between_tests import FROM_TEST, ONLY, OVER, growing, numbered, share
from models.terms.scales import Scales
from models.terms.term import Parameter, Shape, Start, Term

_EXPONENTS = 0.5, 3.0
"""Stretching exponents tried first: of heat that comes by conduction, of what gives way late."""


def column(motion: Motion, shape: Shape) -> Array:
    """Return 1 - exp(-(t/T)^q), or t to a whole `power` where `settling_time` is 0, t in s.

    `stretching_exponent` is q, 0 for 1: below 1 the zero moves with a root of time at first, as
    heat does, above 1 it settles late (Kohlrausch, *Ann. Phys.* 167 (1854) 56-82). Several powers
    together make a zero that wanders. With `over` above 0 it moves over that many of a campaign's
    tests from `from_test` on and hardly within one: the share of it in the motion's test. With
    `only` it is there in that test and no other.
    """
    there = share(motion, shape)
    if shape["over"] > 0.0:
        return np.full_like(motion.time, there)
    elapsed = np.maximum(motion.time - motion.time[0], 0.0)
    constant = shape["settling_time"]
    if constant == 0.0:
        return np.asarray(there * elapsed ** int(shape["power"]))
    slow = (elapsed / constant) ** (shape["stretching_exponent"] or 1.0)
    return np.asarray(-there * np.expm1(-slow))


def starts(scales: Scales) -> list[Start]:
    """Return a zero that settles, wanders, moves from test to test, or wanders in each its way."""
    times = [float(t) for t in np.geomspace(0.02, 1.0, 5) * scales.duration]
    settling = [Start.one(settling_time=t) for t in (0.0, *times)]
    settling += [
        Start.one(settling_time=t, stretching_exponent=q) for q in _EXPONENTS for t in times
    ]
    powers: list[Shape] = [{"power": p} for p in (1.0, 2.0, 3.0)]
    wandering = [Start(tuple(powers[:n])) for n in (2, 3)]
    numbers = numbered(scales)
    zeros: list[Shape] = [{"over": 1.0, "only": n} for n in numbers]
    slopes: list[Shape] = [{"power": 1.0, "only": n} for n in numbers]
    bends: list[Shape] = [{"power": 2.0, "only": n} for n in numbers]
    own = [Start((*zeros, *slopes)), Start((*zeros, *slopes, *bends))] if numbers else []
    return settling + wandering + growing(scales) + own


TERM = Term(
    "sensor-drift",
    "N",
    "f times 1 - exp(-(t/T)^q), t from the record's start, or its powers (N/s, N/s^2, ...)",
    column,
    parameters=(
        Parameter("settling_time", 0.1, 1e5, 0.0, "s", "", "log"),
        Parameter("stretching_exponent", 0.3, 5.0, 0.0, ""),
        Parameter("power", 1.0, 3.0, 1.0, "", fitted=False),
        FROM_TEST,
        OVER,
        ONLY,
    ),
    mistaken_for=("force-offset",),
    follows=lambda shape: "motion" if shape["over"] > 0.0 else "time",
    starts=starts,
    of_channel=True,
)

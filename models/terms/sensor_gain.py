"""Sensor gain: the force channel reads too much or too little.

Throughout, in a range of the amplifier, one way, with load, behind a filter, from a test on, more
with every test, or more and more during a record; or it loses what lasts.
"""

import numpy as np

from models.checks import Array
from models.motion import Motion
from models.terms.between_tests import FROM_TEST, OVER, growing, share
from models.terms.low_pass import low_passed
from models.terms.scales import Scales
from models.terms.term import ForceOf, Parameter, Shape, Start, Term

_PROBE = 1e-3
_MOST_FILTERED = 0.3  # with its filter a greater gain is any delay, or memory of a flow


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
    until it is whole, goes by the motion's test.
    With `settling_time` T (s) above 0 it is 1 - exp(-t/T) of itself, t from the record's start.
    """
    force = force_of(motion)
    coefficient = coefficient * share(motion, shape)
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


def starts(scales: Scales) -> list[Start]:
    """Return a gain throughout or of a range, a side, later tests, a filter, a droop, a load."""
    peaks = np.array(scales.peaks)
    between = np.sqrt(peaks[1:] * peaks[:-1])[peaks[1:] > 1.05 * peaks[:-1]]
    chosen = between[:: max(between.size // 16, 1)]
    ranges = [
        Start.one(probe, threshold=float(t / np.sqrt(1.0 + probe)))
        for t in chosen
        for probe in (0.1, -0.1)  # as measured, peaks in the range have the gain
    ]
    last = max(scales.tests, default=0)
    later = range(2, last + 1, max(last // 32, 1))
    changed = [Start.one(_PROBE, from_test=float(test)) for test in later]
    settling = [
        Start.one(_PROBE, settling_time=t * scales.duration) for t in (0.03, 0.1, 0.3, 1.0, 10.0)
    ]
    filtered = [
        Start.one(_PROBE, filter_time=float(t / scales.omega)) for t in np.geomspace(0.01, 1.0, 8)
    ]
    drooping = [
        Start.one(-_PROBE, droop_time=float(t / scales.least_omega))
        for t in np.geomspace(0.3, 12.0, 10)
    ]
    loaded = [Start.one(_PROBE, load=scales.force, load_power=p) for p in (1.0, 2.0)]
    whole = [Start.one(_PROBE), Start.one(_PROBE, one_way=1.0)]
    grown = growing(scales, _PROBE)
    return whole + ranges + filtered + drooping + loaded + changed + settling + grown


def _bounds(shape: Shape) -> tuple[float, float]:
    if shape["droop_time"] > 0.0:
        return -1.0, 0.0
    limit = _MOST_FILTERED if shape["filter_time"] > 0.0 else 1.0
    return -limit, limit


def described(shape: Shape) -> str:
    """Return in which part of the force the gain is there."""
    if power := shape.get("load_power", 0.0):
        load = shape.get("load", 0.0) or 1.0
        return f"at a force of {load:.3g} N, with the force's size to the power {power:g}"
    side = shape.get("side", 1.0)
    if shape.get("one_way", 0.0):
        return "in tension only" if side > 0.0 else "in compression only"
    if threshold := shape.get("threshold", 0.0):
        return f"where the peak force is {'above' if side >= 0.0 else 'below'} {threshold:.3g} N"
    return "of the samples, after recording" if shape.get("digital", 0.0) else ""


TERM = Term(
    "sensor-gain",
    "1",
    "the force channel reads 1 + g times the force, g the coefficient",
    transform=transform,
    acts="output",
    parameters=(
        Parameter("threshold", 0.0, 1e9, 0.0, "N", fitted=False),
        Parameter("side", -1.0, 1.0, 1.0, "", fitted=False),
        Parameter("one_way", 0.0, 1.0, 0.0, "", fitted=False),
        FROM_TEST,
        OVER,
        Parameter("settling_time", 0.1, 1e5, 0.0, "s", "", "log"),
        Parameter("filter_time", 1e-6, 10.0, 0.0, "s", "", "log"),
        Parameter("digital", 0.0, 1.0, 0.0, "", fitted=False),
        Parameter("droop_time", 0.1, 1e5, 0.0, "s", "", "log"),  # a charge amplifier leaks slowly
        Parameter("load", 1e-9, 1e9, 0.0, "N", fitted=False),
        Parameter("load_power", 0.0, 4.0, 0.0, "", fitted=False),
    ),
    mistaken_for=("inertia", "viscous-damping"),
    follows=lambda shape: "time" if shape["settling_time"] > 0.0 else "motion",
    bounds=_bounds,
    starts=starts,
    of_channel=True,
    described=described,
)

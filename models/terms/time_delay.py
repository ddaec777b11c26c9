"""Delay of the force channel behind the displacement channel (channel skew)."""

from collections.abc import Callable

import numpy as np
from scipy.interpolate import make_interp_spline

from models.checks import Array
from models.motion import Motion
from models.terms.between_tests import ONLY, numbered, share
from models.terms.low_pass import low_passed
from models.terms.scales import Scales
from models.terms.term import ForceOf, Parameter, Shape, Start, Term

_PROBES = (2e-4, 1e-2, 1e-1)
"""rad of the fastest motion, by which a force is tried late and early: one that jumps changes in
steps, on one side of its jump or on the other."""

Late = Callable[[float], Array]


def transform(force_of: ForceOf, motion: Motion, coefficient: float, shape: Shape) -> Array:
    """Return the force as recorded `coefficient` seconds late.

    With `sampling` (Hz) the delay is a number of samples, as of a converter that takes channels in
    turn: `coefficient` at that rate, more at a lower one.
    With `only` it is that of one test of a campaign.
    `resampled` 0 is a channel that samples later; 1 or 3 one whose samples were aligned by lines
    or a cubic spline between them, which rounds a jump of the force, or rings beside it.
    `filter_order` 1 to 4 is a (Butterworth) low-pass in the force channel, that slow forces pass
    with that delay; `digital` 1 one that works on the samples.
    """
    step = motion.sampling or motion.step
    force = force_of(motion)
    delay = share(motion, shape) * delay_at(step, coefficient, shape)
    if delay == 0.0:  # as of any other test with `only`
        return force
    if shape.get("resampled", 0.0) > 0.0:
        return read_late(force, motion.time, int(shape["resampled"]))(delay)
    if shape.get("filter_order", 0.0) > 0.0 and delay > 0.0:
        digital = shape.get("digital", 0.0) > 0.0
        return low_passed(force, motion, delay, int(shape["filter_order"]), digital=digital)
    if motion.periodic:
        lines = np.fft.rfft(force)
        omega = 2.0 * np.pi * np.fft.rfftfreq(force.size, motion.step)
        return np.fft.irfft(lines * np.exp(-1j * omega * delay), n=force.size)
    return np.interp(motion.time - delay, motion.time, force)


def delay_at(step: float, coefficient: float, shape: Shape) -> float:
    """Return the delay in a record of this sampling interval, both in s."""
    sampling = shape.get("sampling", 0.0)
    return coefficient * step * sampling if sampling > 0.0 else coefficient


def read_late(force: Array, time: Array, degree: int) -> Late:
    """Return what gives samples (N,) some seconds late, by a spline of this degree through them."""
    if not np.all(np.isfinite(force)):
        return lambda delay: np.full_like(force, np.nan)
    if degree == 1:
        return lambda delay: np.interp(time - delay, time, force)
    spline = make_interp_spline(time, force, k=degree)
    return lambda delay: np.asarray(spline(np.clip(time - delay, time[0], time[-1])))


def starts(scales: Scales) -> list[Start]:
    """Return a later or earlier sample, a low-pass, a number of samples, one value a test."""
    probe = _PROBES[0] / scales.omega
    sampled = [Start.one(side * p / scales.omega) for p in _PROBES for side in (1.0, -1.0)]
    if scales.sampling:
        sampled.append(Start.one(probe, sampling=scales.sampling))
    filtered = [Start.one(probe, filter_order=order) for order in (1.0, 2.0, 4.0)]
    own = tuple({"only": n} for n in numbered(scales))
    return sampled + filtered + ([Start(own, probe)] if own else [])


def described(shape: Shape) -> str:
    """Return what makes the delay, where it is not a channel that samples later."""
    if order := shape.get("filter_order", 0.0):
        digital = ", of the samples" if shape.get("digital", 0.0) else ""
        return f"by a low-pass of order {order:g}{digital}"
    if degree := shape.get("resampled", 0.0):
        return "resampled by lines" if degree == 1.0 else "resampled by a spline"
    sampling = shape.get("sampling", 0.0)
    return f"as a number of samples, at {sampling:.4g} Hz" if sampling else ""


TERM = Term(
    "time-delay",
    "s",
    "the force channel runs late by the coefficient",
    transform=transform,
    acts="output",
    parameters=(
        Parameter("resampled", 0.0, 3.0, 0.0, "", fitted=False),
        Parameter("filter_order", 0.0, 4.0, 0.0, "", fitted=False),
        Parameter("digital", 0.0, 1.0, 0.0, "", fitted=False),
        Parameter("sampling", 0.0, 1e9, 0.0, "Hz", fitted=False),
        ONLY,
    ),
    mistaken_for=("viscous-damping", "fractional-derivative", "series-compliance"),
    bounds=lambda shape: (0.0 if shape["filter_order"] > 0.0 else -np.inf, np.inf),
    starts=starts,
    of_channel=True,
    described=described,
)

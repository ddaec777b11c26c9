"""Sensor gain: the force channel's sensitivity is wrong: in one range, with force, or frequency."""

import numpy as np
from scipy.signal import bilinear, lfilter

from models.checks import Array
from models.motion import Motion
from models.terms.term import ForceOf, Parameter, Shape, Term

RANGE, GROWS, ONE_WAY, BANDWIDTH = 0, 1, 2, 3


def transform(force_of: ForceOf, motion: Motion, coefficient: float, shape: Shape) -> Array:
    """Return the force times 1 + g, where the sensitivity is wrong.

    `form` 0: in records whose peak lies in the amplifier's range, from `threshold` (N) upwards, or
    up to it where `side` is negative. 1: g grows with force over `threshold`. 2: on one side of
    zero only. 3: above the `corner` (rad/s) of the amplifier, first order, lagging.
    """
    force, form = force_of(motion), int(shape["form"])
    if form == GROWS:
        return np.asarray(force * (1.0 + coefficient * np.abs(force) / shape["threshold"]))
    if form == ONE_WAY:
        return np.where(shape["side"] * force > 0.0, 1.0 + coefficient, 1.0) * force
    if form == BANDWIDTH:
        return np.asarray(force + coefficient * (force - _slow(force, motion, shape["corner"])))
    peak = float(np.abs(force).max())
    inside = peak >= shape["threshold"] if shape["side"] >= 0.0 else peak < shape["threshold"]
    return force * (1.0 + coefficient) if inside else force


def _slow(force: Array, motion: Motion, corner: float) -> Array:
    """Return what of a force (N,) passes a first-order low-pass."""
    if motion.periodic:
        omega = 2.0 * np.pi * np.fft.rfftfreq(force.size, motion.step)
        return np.fft.irfft(np.fft.rfft(force) / (1.0 + 1j * omega / corner), n=force.size)
    above, below = bilinear([1.0], [1.0 / corner, 1.0], 1.0 / motion.step)
    begun = [force[0] * (1.0 - above[0] / below[0])]
    return np.asarray(lfilter(above / below[0], below / below[0], force, zi=begun)[0])


TERM = Term(
    "sensor-gain",
    "1",
    "the force channel reads 1 + g times the force: always, in a range, with force or frequency",
    transform=transform,
    acts="output",
    parameters=(
        Parameter("threshold", 0.0, 1e9, 0.0, "N"),
        Parameter("side", -1.0, 1.0, 1.0, ""),
        Parameter("form", 0.0, 3.0, 0.0, ""),
        Parameter("corner", 0.0, 1e6, 0.0, "rad/s"),
    ),
    mistaken_for=("inertia", "viscous-damping"),
)

"""Delay of the force channel behind the displacement channel (channel skew)."""

import numpy as np
from scipy.interpolate import make_interp_spline

from models.checks import Array
from models.motion import Motion
from models.terms.term import ForceOf, Parameter, Shape, Term


def transform(force_of: ForceOf, motion: Motion, coefficient: float, shape: Shape) -> Array:
    """Return the force as recorded `coefficient` seconds late.

    `resampled` 0 is a channel that samples later; 1 or 3 one whose samples were aligned by lines
    or a cubic spline between them, which rounds a jump of the force, or rings beside it.
    """
    force = force_of(motion)
    if shape.get("resampled", 0.0) > 0.0:
        return between_samples(force, motion.time, coefficient, int(shape["resampled"]))
    if motion.periodic:
        lines = np.fft.rfft(force)
        omega = 2.0 * np.pi * np.fft.rfftfreq(force.size, motion.step)
        return np.fft.irfft(lines * np.exp(-1j * omega * coefficient), n=force.size)
    return np.interp(motion.time - coefficient, motion.time, force)


def between_samples(force: Array, time: Array, delay: float, degree: int) -> Array:
    """Return samples (N,) some seconds late by a spline of this degree through them."""
    if not np.all(np.isfinite(force)):
        return np.full_like(force, np.nan)
    spline = make_interp_spline(time, force, k=degree)
    return np.asarray(spline(np.clip(time - delay, time[0], time[-1])))


TERM = Term(
    "time-delay",
    "s",
    "the force channel runs late by the coefficient",
    transform=transform,
    acts="output",
    parameters=(Parameter("resampled", 0.0, 3.0, 0.0, ""),),
    mistaken_for=("viscous-damping", "fractional-derivative", "series-compliance"),
)

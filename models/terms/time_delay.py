"""Delay of the force channel behind the displacement channel (channel skew)."""

import numpy as np

from models.checks import Array
from models.motion import Motion
from models.terms.term import ForceOf, Shape, Term


def transform(force_of: ForceOf, motion: Motion, coefficient: float, shape: Shape) -> Array:
    """Return the force as recorded `coefficient` seconds late."""
    force = force_of(motion)
    if motion.periodic:
        lines = np.fft.rfft(force)
        omega = 2.0 * np.pi * np.fft.rfftfreq(force.size, motion.step)
        return np.fft.irfft(lines * np.exp(-1j * omega * coefficient), n=force.size)
    return np.interp(motion.time - coefficient, motion.time, force)


TERM = Term(
    "time-delay",
    "s",
    "the force channel runs late by the coefficient",
    transform=transform,
    acts="output",
    mistaken_for=("viscous-damping", "fractional-derivative", "series-compliance"),
)

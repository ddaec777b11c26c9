"""Measured velocity and acceleration against the measured displacement."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from discover.record_checks.by_parts import windowed_derivatives
from models.checks import Array

GAIN_TOLERANCE = 0.05
"""Relative error of gain up to which a measured derivative replaces a computed one."""
PHASE_TOLERANCE = 0.05
"""Likewise of phase, rad."""
_RESIDUAL_TOLERANCE = 0.1  # of the amplitude, where the displacement has its power


@dataclass(frozen=True)
class Agreement:
    """How a measured derivative compares with the displacement's."""

    gain: float
    """Measured over computed."""
    phase: float
    """rad, measured ahead of computed."""
    residual: float
    """What gain and phase leave, over the measured signal, in the band of the motion."""
    uncertainty: float
    """Standard error of gain and phase, by the measured signal's own noise."""

    @property
    def is_hidden(self) -> bool:
        """Return whether the measured signal's noise leaves gain and phase open."""
        return not self.accepted and self.uncertainty > GAIN_TOLERANCE

    @property
    def accepted(self) -> bool:
        """Return whether the measurement can stand for the derivative."""
        return (
            abs(self.gain - 1.0) <= GAIN_TOLERANCE
            and abs(self.phase) <= PHASE_TOLERANCE
            and self.residual <= _RESIDUAL_TOLERANCE
        )

    @property
    def reason(self) -> str:
        """Return the likeliest reason in words where it is not accepted, else an empty string."""
        if self.accepted:
            return ""
        if self.residual > 0.5:
            return "it is unrelated to the displacement"
        if abs(abs(self.phase) - np.pi) < 0.3:
            return "its sign is opposite"
        for power in (3, -3):
            if abs(self.gain / 10.0**power - 1.0) < 0.1:
                return f"it is off by a factor of {10.0**power:g}: its unit?"
        if abs(self.phase) > PHASE_TOLERANCE:
            return f"its phase is off by {np.degrees(self.phase):.1f} degrees"
        if abs(self.gain - 1.0) > GAIN_TOLERANCE:
            return f"it is {100.0 * (self.gain - 1.0):+.1f} % off"
        return f"{100.0 * self.residual:.0f} % of it does not follow the displacement"


def derivative_agreement(
    displacement: Array, measured: Array, step: float, *, order: int
) -> Agreement:
    """Compare a measured derivative with the displacement without differentiating.

    Only a window is differentiated. The bins that hold the motion's power are compared.

    Parameters
    ----------
    displacement : ndarray, shape (N,)
        m.
    measured : ndarray, shape (N,)
        m/s or m/s^2.
    step : float
        Sampling interval, s.
    order : int
        1 for velocity, 2 for acceleration.

    Returns
    -------
    Agreement

    Examples
    --------
    >>> t = np.arange(1000) / 200.0
    >>> found = derivative_agreement(np.sin(3.0 * t), 3.3 * np.cos(3.0 * t), 0.005, order=1)
    >>> round(found.gain, 4), found.accepted
    (1.1, False)
    """
    window, transforms = windowed_derivatives(displacement, step)
    plain, computed, found = transforms[0], transforms[order], np.fft.rfft(window * measured)
    # Noise of a differentiated displacement grows with frequency: judge where x itself is strong.
    power = np.abs(plain) ** 2
    strong = power > 0.01 * power[1:].max()
    strong[0] = False
    # What is left of the measured signal at high frequencies is taken for noise, alike at all.
    noise = float(np.sqrt(np.median(np.abs(found[found.size // 2 :]) ** 2) / np.log(2.0)))
    offset = np.fft.rfft(window)[strong]  # a sensor's constant offset is no disagreement
    offset = offset / np.linalg.norm(offset)
    computed, found = (c[strong] - offset * np.vdot(offset, c[strong]) for c in (computed, found))
    size_there = float(np.linalg.norm(computed))
    if not size_there:  # a line that an offset would make as well
        return Agreement(0.0, 0.0, 1.0, np.inf)
    ratio = complex(np.vdot(computed, found) / size_there**2)
    total = float(np.linalg.norm(found))
    rest = float(np.linalg.norm(found - ratio * computed)) / total if total else 1.0
    return Agreement(abs(ratio), float(np.angle(ratio)), rest, noise / size_there)

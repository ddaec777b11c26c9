"""A device behind a spring with a little loss: the steady state solved by harmonic balance."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy import fft, optimize
from scipy.optimize import NoConvergence

from tests.calibration.structures.devices import Redraw
from tests.calibration.structures.friction import whole
from tests.calibration.structures.motion import Motion, at_times, lines_of
from tests.calibration.structures.specimen import Specimen

Array = np.ndarray
POINTS = 4096
LINES = 700
TOLERANCE = 2e-4
"""Of the lines, over the greatest give of the link."""


@dataclass(frozen=True)
class Link:
    """What gives way between the measured motion and the device: a spring beside a damper."""

    compliance: float
    """m/N."""
    lag: float = 0.0
    """Of the give behind the force, s: the damper over the spring."""

    def give(self, rates: Array) -> Array:
        """Return the give over the force (K,) at angular frequencies, m/N."""
        return self.compliance / (1.0 + 1j * rates * self.lag)


def behind(specimen: Specimen, i: int, link: Link) -> Array:
    """Return the force (N,) at a record's samples with a link in series, N.

    The measured motion is the record's, the device moves by x less the give. Solved for the lines
    of the device's motion by Newton-Krylov, preconditioned with the linear device behind the link.

    Raises
    ------
    Redraw
        Where it doesn't converge.
    """
    driven = specimen.runs[i].motion
    count = min(LINES, POINTS // 4)
    target = np.zeros(count, dtype=complex)
    target[: driven.lines.size] = driven.lines
    rates = 2.0 * np.pi / driven.period * np.arange(count)
    give = link.give(rates)
    stiff = 1.0 + give * _impedance(specimen, i, rates)
    scale = link.compliance * float(np.max(np.abs(specimen.force(i))))

    def force_of(lines: Array) -> Array:
        moved = Motion(driven.period, lines, POINTS, driven.time)
        return lines_of(specimen.force(i, whole(moved)), count)

    def residual(vector: Array) -> Array:
        lines = target + scale * _complex(vector)
        return _real((target - lines - give * force_of(lines)) / stiff) / scale

    found = _solve(residual, np.zeros(2 * count))
    return _sampled(force_of(target + scale * _complex(found)), driven)


def _sampled(lines: Array, motion: Motion) -> Array:
    """Return a periodic signal of many lines at a motion's samples (N,)."""
    size = fft.next_fast_len(max(32 * lines.size, 8192), real=True)
    kept = Motion(motion.period, lines, size, motion.time)
    if motion.time.size * lines.size < 400_000:
        return at_times(lines, kept.rates, motion.time)
    return kept.sampled(kept.grid(0.0))


def _impedance(specimen: Specimen, i: int, rates: Array) -> Array:
    """Return force over displacement (K,) of the linear part of a record's device, N/m."""
    total = np.zeros(rates.size, dtype=complex)
    s = 1j * rates
    for law, weight in zip(specimen.bands.laws, specimen.weights(i), strict=True):
        if law.core == "FOIM":
            total += weight * law.fractional * np.power(s, law.order)
        else:
            speed = 0.6 * specimen.runs[i].motion.top_speed
            drag = law.viscous + law.quadratic * speed
            drag += law.power * speed ** (law.exponent - 1.0)
            total += weight * (law.inertance * s**2 + drag * s)
    return total


def _solve(residual: Callable[[Array], Array], start: Array) -> Array:
    try:
        return np.asarray(
            optimize.newton_krylov(
                residual, start, f_tol=TOLERANCE, maxiter=40, method="lgmres", inner_maxiter=40
            )
        )
    except (NoConvergence, ValueError, FloatingPointError) as error:
        raise Redraw("no steady state found") from error


def _real(lines: Array) -> Array:
    return np.concatenate([lines.real, lines.imag])


def _complex(vector: Array) -> Array:
    half = vector.size // 2
    return vector[:half] + 1j * vector[half:]

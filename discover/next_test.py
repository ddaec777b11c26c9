"""The test that would tell most: where the open structures' predictions differ, all told.

For a sine test that the rig can do, each structure predicts the force's lines with what is still
uncertain of its numbers. The expected log Bayes factor between two structures is the
Kullback-Leibler divergence of these predictions, averaged over which of the two is true.

Box, G. E. P. and Hill, W. J., Technometrics 9 (1967) 57: discrimination among mechanistic models.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from discover.motion_fit.observation import real_rows
from discover.posterior.model import Composite, Number
from discover.records import RigLimits
from models.checks import Array
from models.constitutive import ForceModel
from models.motion import Motion, sine_motion

_FREQUENCIES = 25  # of tests that are weighed, even in the logarithm
_AMPLITUDES = 9  # likewise
_LINES = 8  # the mean and seven harmonics carry what tells structures apart
_SAMPLES = 128  # of one cycle
_WIDER = 2.0  # beyond the tested frequencies, where the rig's limits leave it open
_ROUNDING = 1e-10
"""Of the variance of a test's lines, below which none of their directions is told apart."""
_LEAST_NOISE = 1e-3  # of the force: no new test is taken for better than this
_STEP = 1e-4  # of a number, for its slope


@dataclass(frozen=True)
class NextTest:
    """A proposed sine test."""

    frequency_hz: float
    """Frequency, Hz."""
    amplitude_m: float
    """Displacement amplitude, m."""
    separates: tuple[str, str]
    """The two structures that it would tell apart."""
    gain: float
    """Expected log Bayes factor, or what a narrower boundary is worth, nats."""

    def to_dict(self) -> dict[str, Any]:
        """Return the document's entry."""
        return {
            "frequency_hz": self.frequency_hz,
            "amplitude_m": self.amplitude_m,
            "separates": list(self.separates),
            "gain": self.gain,
        }


@dataclass(frozen=True)
class Rival:
    """A structure as it is known so far."""

    name: str
    """Of the structure."""
    probability: float
    """So far."""
    model: Composite
    """All that it holds."""
    unit: int
    """A unit of the band in question."""
    numbers: tuple[Number, ...]
    """P of them that are uncertain."""
    covariance: Array
    """(P, P)."""

    def force(self, motion: Motion) -> Array:
        """Return its force on a motion, (N,) N."""
        return self.model.in_unit(self.unit).force(motion)

    def lines(self, frequency: float, amplitude: float) -> tuple[Array, Array]:
        """Return the mean (2 L,) and covariance (2 L, 2 L) of the lines in a sine test."""
        motion = sine_motion(amplitude, frequency, samples=_SAMPLES)
        forces = [self.force(motion)]
        for n in self.numbers:
            value = self.model.value(n)
            step = _STEP * abs(value) or _STEP
            other = self.model.with_values([n], [value - step])
            moved: ForceModel = other.in_unit(self.unit)
            forces.append((forces[0] - moved.force(motion)) / step)
        rows = _rows(np.array(forces))
        return rows[0], rows[1:].T @ self.covariance @ rows[1:]


def _rows(forces: Array) -> Array:
    """Return the lowest lines (K, 2 L) of forces (K, N) over one cycle."""
    found = np.fft.rfft(forces, axis=-1)[:, :_LINES] * (np.sqrt(2.0) / forces.shape[-1])
    found[:, 0] /= np.sqrt(2.0)
    return real_rows(found)


def admissible_tests(
    frequency: Array, amplitude: Array, limits: RigLimits | None
) -> tuple[Array, Array]:
    """Return frequencies (Hz) and amplitudes (m) of the tests that the rig can do, (T,) each.

    Limits that are not stated are those that the tests so far have reached.

    Parameters
    ----------
    frequency, amplitude : ndarray, shape (W,)
        Of the tests so far, Hz and m.
    limits : RigLimits or None
        The rig's.
    """
    given = limits or RigLimits()
    omega = 2.0 * np.pi * frequency
    stroke = given.max_stroke or float(amplitude.max())
    speed = given.max_speed or float((amplitude * omega).max())
    acceleration = given.max_acceleration or float((amplitude * omega**2).max())
    f, a = np.meshgrid(
        np.geomspace(frequency.min() / _WIDER, frequency.max() * _WIDER, _FREQUENCIES),
        np.geomspace(min(amplitude.min(), stroke), stroke, _AMPLITUDES),
    )
    w = 2.0 * np.pi * f
    fits = (a * w <= 1.0001 * speed) & (a * w**2 <= 1.0001 * acceleration)
    return f[fits], a[fits]


def propose(
    rivals: Sequence[Rival],
    frequencies: Array,
    amplitudes: Array,
    *,
    noise: float,
    max_force: float | None = None,
) -> NextTest | None:
    """Return the test that best separates two structures.

    Parameters
    ----------
    rivals : sequence of Rival
        The two.
    frequencies, amplitudes : ndarray, shape (T,)
        Tests that may be run, Hz and m.
    noise : float
        Standard deviation of a line over the force's root mean square.
    max_force : float, optional
        N, that the rig can take.

    Returns
    -------
    NextTest or None
        None where no test may be run.
    """
    first, second = rivals
    weight = first.probability / max(first.probability + second.probability, 1e-300)
    best, most = None, -np.inf
    for f, a in zip(frequencies, amplitudes, strict=True):
        if max_force is not None:
            force = first.force(sine_motion(a, f, samples=_SAMPLES))
            if float(np.abs(force).max()) > max_force:
                continue
        gain = expected_gain(first, second, float(f), float(a), weight=weight, noise=noise)
        if gain > most:
            best, most = (float(f), float(a)), gain
    if best is None:
        return None
    return NextTest(*best, (first.name, second.name), float(most))


def expected_gain(
    first: Rival, second: Rival, frequency: float, amplitude: float, *, weight: float, noise: float
) -> float:
    """Return the expected log Bayes factor between two structures in one test, nats.

    Parameters
    ----------
    first, second : Rival
        The structures.
    frequency, amplitude : float
        Of the sine test, Hz and m.
    weight : float
        Probability of the first against the second.
    noise : float
        Standard deviation of a line over the force's root mean square.
    """
    lines = [r.lines(frequency, amplitude) for r in (first, second)]
    level = max(noise, _LEAST_NOISE) * max(float(np.linalg.norm(m)) for m, _ in lines)
    known = _ROUNDING * max(float(np.trace(c)) for _, c in lines)  # what rounding leaves of it
    floor = max(level**2, known) * np.eye(lines[0][0].size)
    means = [m for m, _ in lines]
    covariances = [floor + c for _, c in lines]
    return weight * _divergence(means, covariances) + (1.0 - weight) * _divergence(
        means[::-1], covariances[::-1]
    )


def _divergence(means: Sequence[Array], covariances: Sequence[Array]) -> float:
    """Return the Kullback-Leibler divergence of the first normal law from the second."""
    inverse = np.linalg.inv(covariances[1])
    shift = means[1] - means[0]
    logs = [np.linalg.slogdet(c)[1] for c in covariances]
    trace = float(np.trace(inverse @ covariances[0]))
    return 0.5 * float(trace - shift.size + shift @ inverse @ shift + logs[1] - logs[0])

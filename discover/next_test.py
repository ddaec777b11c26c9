"""The test that would tell most: where the open structures' predictions differ, all told.

For a sine test that the rig can do, each structure predicts the force's lines with what is still
uncertain of its parameters. The expected log Bayes factor between two structures is the
Kullback-Leibler divergence of these predictions, averaged over which of the two is true; it is
evaluated on the library's columns, so a test costs a few small matrices.

Box, G. E. P. and Hill, W. J., Technometrics 9 (1967) 57: discrimination among mechanistic models.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from discover.library.dictionary import DELAY, Dictionary
from discover.motion_fit.observation import real_rows
from discover.records import RigLimits
from discover.regression.covariance import jacobian_of
from discover.regression.support import ProfiledFit, SupportFit
from discover.selection.judge import Judgement
from discover.triangle import WindowRows
from models.checks import Array
from models.motion import sine_motion

_FREQUENCIES = 25
_AMPLITUDES = 9
_LINES = 8  # the mean and seven harmonics carry what tells structures apart
_SAMPLES = 128
_WIDER = 2.0  # beyond the tested frequencies, where the rig's limits leave it open
_LEAST_NOISE = 1e-3  # of the force: no new test is taken for better than this


@dataclass(frozen=True)
class NextTest:
    """A proposed sine test."""

    frequency_hz: float
    """Hz."""
    amplitude_m: float
    """m."""
    separates: tuple[str, str]
    """What it would tell apart."""
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


def admissible_tests(
    windows: Sequence[WindowRows], limits: RigLimits | None
) -> tuple[Array, Array]:
    """Return frequencies (Hz) and amplitudes (m) of the tests that the rig can do, (T,) each.

    Limits that are not stated are those that the tests so far have reached.
    """
    given = limits or RigLimits()
    amplitude = np.array([w.amplitude for w in windows])
    frequency = np.array([w.frequency for w in windows])
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
    judgement: Judgement,
    dictionary: Dictionary,
    limits: RigLimits | None,
    *,
    inside: tuple[float, float] = (0.0, np.inf),
    per_speed: float | None = None,
) -> NextTest | None:
    """Return the test that best separates a band's two leading structures.

    Parameters
    ----------
    judgement : Judgement
        Of the band.
    dictionary : Dictionary
        Of its columns.
    limits : RigLimits or None
        The rig's.
    inside : tuple of float
        Range of the coordinate in which the band holds; tests outside are left out.
    per_speed : float, optional
        Coordinate per m/s of speed amplitude; None where the coordinate is frequency.

    Returns
    -------
    NextTest or None
        None where only one structure stands, or no admissible test lies in the band.
    """
    ranked = sorted(judgement.probabilities.items(), key=lambda item: -item[1])[:2]
    pair = [(name, judgement.contest.best(name), p) for name, p in ranked]
    if len(pair) < 2 or pair[0][1] is None or pair[1][1] is None:
        return None
    frequencies, amplitudes = admissible_tests(judgement.windows, limits)
    coordinate = frequencies if per_speed is None else (
        2.0 * np.pi * frequencies * amplitudes * per_speed
    )
    kept = (coordinate > inside[0]) & (coordinate < inside[1])
    if not kept.any():
        return None
    frequencies, amplitudes = frequencies[kept], amplitudes[kept]
    fits = [judgement.engine.fit(s.fit.support) for _, s, _ in pair if s is not None]
    spreads = [_spread(judgement.engine, fit, dictionary) for fit in fits]
    weight = pair[0][2] / max(pair[0][2] + pair[1][2], 1e-300)
    noise = relative_noise(judgement.windows)
    gains = np.array(
        [
            expected_gain(f, a, fits, spreads, dictionary, weight=weight, noise=noise)
            for f, a in zip(frequencies, amplitudes, strict=True)
        ]
    )
    limit = limits.max_force if limits is not None else None
    if limit is not None:
        peaks = _peaks(frequencies, amplitudes, fits[0], dictionary)
        gains = np.where(peaks <= limit, gains, -np.inf)
    best = int(gains.argmax())
    if not np.isfinite(gains[best]):
        return None
    return NextTest(
        float(frequencies[best]),
        float(amplitudes[best]),
        (pair[0][0], pair[1][0]),
        float(gains[best]),
    )


def expected_gain(
    frequency: float,
    amplitude: float,
    fits: Sequence[SupportFit],
    spreads: Sequence[Array],
    dictionary: Dictionary,
    *,
    weight: float,
    noise: float,
) -> float:
    """Return the expected log Bayes factor between two fits in one test, nats.

    Parameters
    ----------
    frequency, amplitude : float
        Of the sine test, Hz and m.
    fits : sequence of SupportFit
        Two.
    spreads : sequence of ndarray
        Square roots of their parameters' covariances on the dictionary's columns, (K, p).
    dictionary : Dictionary
        Of the columns.
    weight : float
        Probability of the first against the second.
    noise : float
        Standard deviation of a line over the force's root mean square.
    """
    rows = sine_rows(frequency, amplitude, dictionary)
    means = [rows @ fit.combined for fit in fits]
    roots = [rows @ spread for spread in spreads]
    level = max(noise, _LEAST_NOISE) * max(float(np.linalg.norm(m)) for m in means)
    floor = level**2 * np.eye(rows.shape[0])
    covariances = [floor + root @ root.T for root in roots]
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


def sine_rows(
    frequency: float, amplitude: float, dictionary: Dictionary, *, lines: int = _LINES
) -> Array:
    """Return (2 L, K) rows of the columns' lowest L lines in a sine test; the delay's are zero.

    Parameters
    ----------
    frequency, amplitude : float
        Of the test, Hz and m.
    dictionary : Dictionary
        Of the columns.
    lines : int
        L, the mean included; at most 65.
    """
    motion = sine_motion(amplitude, frequency, samples=_SAMPLES)
    columns = dictionary.evaluate(motion)
    found = np.fft.rfft(columns, axis=-1)[:, :lines] * (np.sqrt(2.0) / _SAMPLES)
    found[:, 0] /= np.sqrt(2.0)
    rows = real_rows(found).T
    return np.column_stack([rows, np.zeros(rows.shape[0])]) if dictionary.has(DELAY) else rows


def _spread(engine: ProfiledFit, fit: SupportFit, dictionary: Dictionary) -> Array:
    """Return (K, p) whose product with its transpose is the covariance on the columns."""
    jacobian = jacobian_of(fit, dictionary)
    columns = engine.triangle.columns @ jacobian
    norms = np.linalg.norm(columns, axis=0)
    norms[norms == 0.0] = 1.0
    _, values, right = np.linalg.svd(columns / norms, full_matrices=False)
    scale = np.sqrt(max(fit.chi2 / max(engine.triangle.rows - fit.support.parameters, 1), 1.0))
    inverse = np.where(values > 1e-9 * values[0], 1.0 / np.maximum(values, 1e-300), 0.0)
    return np.asarray(jacobian @ ((right.T * inverse) / norms[:, None]) * scale)


def relative_noise(windows: Sequence[WindowRows]) -> float:
    """Return a line's standard deviation over its record's rms force, the median of `windows`."""
    levels = [np.sqrt(np.median(w.total_variance) / max(w.power, 1e-300)) for w in windows]
    return float(np.median(levels))


def _peaks(
    frequencies: Array, amplitudes: Array, fit: SupportFit, dictionary: Dictionary
) -> Array:
    combined = fit.combined[:-1] if dictionary.has(DELAY) else fit.combined
    return np.array(
        [
            np.abs(combined @ dictionary.evaluate(sine_motion(a, f, samples=_SAMPLES))).max()
            for f, a in zip(frequencies, amplitudes, strict=True)
        ]
    )

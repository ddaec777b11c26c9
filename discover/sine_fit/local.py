"""Amplitude and phase of a sine cycle by cycle, beside those of its fit."""

from __future__ import annotations

import numpy as np

from discover.sine_fit.design import ComplexArray
from discover.sine_fit.harmonic_sums import Harmonics
from discover.sine_fit.moments import Moments, moments
from discover.sine_fit.solution import SineFit
from models.checks import Array, Indices

_PARTS = 4  # of a window, by which the next one is later


def local_phasors(time: Array, x: Array, fit: SineFit) -> tuple[Indices, ComplexArray]:
    """Return fits of the fundamental over one cycle at a time.

    Parameters
    ----------
    time, x : ndarray, shape (N,)
        s, and the signal that was fitted.
    fit : SineFit
        Of the signal.

    Returns
    -------
    starts : ndarray, shape (W,)
        First sample of each window.
    relative : ndarray of complex, shape (W,)
        The phasor in it over the fit's.

    Examples
    --------
    >>> from discover.sine_fit import fit_sine
    >>> t = np.arange(400) / 100.0
    >>> x = np.sin(2 * np.pi * 2.0 * t)
    >>> _, relative = local_phasors(t, 1.1 * x, fit_sine(t, x))
    >>> bool(np.allclose(relative, 1.1))
    True
    """
    step = float(time[-1] - time[0]) / (time.size - 1)
    length = min(max(round(1.0 / (fit.frequency * step)), _PARTS), x.size)
    starts = np.arange(0, x.size - length + 1, max(length // _PARTS, 1))
    plain = x - fit.coefficients[0].real - fit.trend * (time - time.mean())
    at = moments(time)
    if at.step is None or at.places is not None:
        phasors = _one_by_one(at, plain, fit.frequency, starts, length)
    else:
        phasors = _alike(at, plain, fit.frequency, starts, length)
    return starts, np.asarray(phasors / fit.coefficients[1])


def _alike(
    at: Moments, plain: Array, frequency: float, starts: Indices, length: int
) -> ComplexArray:
    """Return phasors (W,) of windows in equal steps: in its own time each has the same columns.

    Windows overlap, and their sums are those of the parts between their starts.
    """
    hop = max(length // _PARTS, 1)
    wave = np.exp(2j * np.pi * frequency * (at.step or 0.0) * np.arange(length))
    columns = np.column_stack([np.ones(length), wave.real, -wave.imag])
    whole = plain.size // hop
    parts = plain[: whole * hop].reshape(whole, hop) @ columns[:hop]
    mean, around = np.zeros(starts.size), np.zeros(starts.size, dtype=np.complex128)
    for part in range(_PARTS):
        some = parts[part : part + starts.size]
        mean += some[:, 0]
        around += wave[part * hop] * (some[:, 1] - 1j * some[:, 2])
    for place in range(_PARTS * hop, length):
        some_samples = plain[starts + place]
        mean += some_samples
        around += wave[place] * some_samples
    goal = np.stack([mean, around.real, -around.imag])
    found = np.linalg.pinv(columns.T @ columns, hermitian=True) @ goal
    turns = np.exp(-2j * np.pi * frequency * at.time[starts])
    return np.asarray((found[1] + 1j * found[2]) * turns)


def _one_by_one(
    at: Moments, plain: Array, frequency: float, starts: Indices, length: int
) -> ComplexArray:
    """Return phasors (W,) of windows at any times."""
    cosine, minus_sine = Harmonics(at, frequency).series(np.array([[0.0, 1.0], [0.0, 1j]]))
    columns = (np.ones(1), cosine, minus_sine)

    def over_windows(values: Array) -> Array:
        total = np.concatenate([[0.0], np.cumsum(np.broadcast_to(values, plain.shape))])
        return np.asarray(total[starts + length] - total[starts])

    gram = np.empty((3, 3, starts.size))
    for i, one in enumerate(columns):
        for j, other in enumerate(columns[: i + 1]):
            gram[i, j] = gram[j, i] = over_windows(one * other)
    goal = np.array([over_windows(plain * c) for c in columns])
    found = np.linalg.pinv(np.moveaxis(gram, 2, 0), hermitian=True) @ goal.T[:, :, None]
    return np.asarray(found[:, 1, 0] + 1j * found[:, 2, 0])

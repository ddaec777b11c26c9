"""Least squares of harmonics over many samples, a block of them at a time.

The columns of the fit are never there as a whole: at 31 harmonics they would take half a kilobyte
for each sample. Their products are sums of harmonics of twice the number, so that no matrix of
columns is multiplied by itself either.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.linalg import cho_factor, cho_solve

from discover.motion_fit.observation import Lines
from models.checks import Array

_BLOCK = 4096  # samples: with their harmonics they stay in the processor's cache


@dataclass(frozen=True)
class HarmonicLines:
    """A fit of mean, harmonics and a drift to columns of samples."""

    time: Array
    """(N,) s."""
    frequency: float
    """Hz, of the fundamental."""
    count: int
    """Number of harmonics, H."""
    middle: float | None
    """s, where the drift is zero; None for a fit without one."""
    factor: Any
    """Of the normal matrix, as `scipy.linalg.cho_factor` gives it."""

    def solve(self, columns: Array) -> Array:
        """Return coefficients of columns (K, N): (K, 1 + 2 H), or one more with a drift.

        In the order of `discover.sine_fit.harmonic_design`.
        """
        phasors = np.zeros((columns.shape[0], self.count + 1), dtype=np.complex128)
        drift = np.zeros(columns.shape[0])
        for inside, waves in _blocks(self.time, self.frequency, self.count):
            phasors += columns[:, inside] @ waves.T
            if self.middle is not None:
                drift += columns[:, inside] @ (self.time[inside] - self.middle)
        sums = _flat(phasors)
        if self.middle is not None:
            sums = np.column_stack([sums, drift])
        return np.asarray(cho_solve(self.factor, sums.T).T)

    def fitted(self, solution: Array) -> Array:
        """Return what coefficients (P,) give at the samples, (N,)."""
        size = 2 * self.count + 1
        weights = solution[1:size:2] + 1j * solution[2:size:2]
        result = np.empty(self.time.size)
        for inside, waves in _blocks(self.time, self.frequency, self.count):
            result[inside] = (weights @ waves[1:]).real
        result += solution[0]
        if self.middle is not None:
            result += solution[-1] * (self.time - self.middle)
        return result

    def lines(self, columns: Array) -> Lines:
        """Return the lines of columns (..., N): (..., H + 1), with their mean square."""
        found = lines_of(self.solve(columns.reshape(-1, self.time.size)), self.count)
        return found.reshape((*columns.shape[:-1], self.count + 1))


def harmonic_lines(
    time: Array, frequency: float, count: int, *, middle: float | None
) -> HarmonicLines:
    """Return the fit at samples.

    Parameters
    ----------
    time : ndarray, shape (N,)
        s.
    frequency : float
        Hz.
    count : int
        Harmonics.
    middle : float or None
        s, where the drift is zero; None for a fit without one.

    Examples
    --------
    >>> t = np.arange(50) / 20.0
    >>> fit = harmonic_lines(t, 1.3, 2, middle=1.0)
    >>> columns = np.stack([3.0 + 2.0 * np.cos(2 * np.pi * 1.3 * t), t - 1.0])
    >>> (fit.solve(columns).round(9) + 0.0).tolist()
    [[3.0, 2.0, 0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0, 0.0, 1.0]]
    """
    products = _Products(count, middle)
    for inside, waves in _blocks(time, frequency, count):
        products.add(time[inside], waves)
    return HarmonicLines(time, frequency, count, middle, cho_factor(products.normal()))


class _Products:
    """Sums of harmonics over samples, of which the products of all columns are made."""

    def __init__(self, count: int, middle: float | None) -> None:
        self.count, self.middle = count, middle
        self.sums = np.zeros(2 * count + 1, dtype=np.complex128)  # of exp(i k w t)
        self.drifts = np.zeros(count + 1, dtype=np.complex128)  # of (t - middle) exp(i k w t)
        self.late = 0.0

    def add(self, time: Array, waves: Lines) -> None:
        """Add a block of samples (B,) with its harmonics (H + 1, B)."""
        self.sums[: self.count + 1] += waves.sum(axis=1)
        self.sums[self.count + 1 :] += waves[1:] @ waves[-1]
        if self.middle is not None:
            moment = time - self.middle
            self.drifts += waves @ moment
            self.late += float(moment @ moment)

    def normal(self) -> Array:
        """Return the normal matrix."""
        return _normal(self.sums, self.drifts if self.middle is not None else None, self.late)


def _normal(sums: Lines, drifts: Lines | None, late: float) -> Array:
    """Return the normal matrix from sums (2 H + 1,), and with a drift from its own (H + 1,)."""
    count = sums.size // 2
    k = np.arange(count + 1)
    difference = k[:, None] - k
    apart = np.where(difference >= 0, sums[np.abs(difference)], sums[np.abs(difference)].conj())
    together = sums[k[:, None] + k]
    size = 2 * count + 1
    normal = np.empty((size + int(drifts is not None),) * 2)
    cosine, sine = [0, *range(1, size, 2)], list(range(2, size, 2))
    normal[np.ix_(cosine, cosine)] = 0.5 * (apart + together).real
    normal[np.ix_(sine, sine)] = 0.5 * (apart - together).real[1:, 1:]
    mixed = 0.5 * (apart - together).imag[:, 1:]
    normal[np.ix_(cosine, sine)], normal[np.ix_(sine, cosine)] = mixed, mixed.T
    if drifts is not None:
        normal[-1, :-1] = normal[:-1, -1] = _flat(drifts[None])[0]
        normal[-1, -1] = late
    return normal


class LineSums:
    """A fit of mean, harmonics and a drift to a force of which a piece at a time is there.

    Examples
    --------
    >>> t = np.arange(50) / 20.0
    >>> force = 3.0 + 2.0 * np.cos(2 * np.pi * 1.3 * t)
    >>> sums = LineSums(1.3, 1, middle=1.0)
    >>> sums.add(t[:20], force[:20])
    >>> sums.add(t[20:], force[20:])
    >>> found, left = sums.solve()
    >>> (found.round(9) + 0.0).tolist(), round(left, 9)
    ([3.0, 2.0, 0.0, 0.0], 0.0)
    """

    def __init__(self, frequency: float, count: int, *, middle: float) -> None:
        self.frequency, self.middle = frequency, middle
        self._products = _Products(count, middle)
        self._phasors = np.zeros(count + 1, dtype=np.complex128)
        self._drift = self._power = 0.0

    def add(self, time: Array, force: Array) -> None:
        """Add samples (B,), s and N."""
        for inside, waves in _blocks(time, self.frequency, self._phasors.size - 1):
            self._products.add(time[inside], waves)
            self._phasors += waves @ force[inside]
        self._drift += float((time - self.middle) @ force)
        self._power += float(force @ force)

    def solve(self) -> tuple[Array, float]:
        """Return coefficients (P,) as `HarmonicLines.solve`, and the misfit's square sum, N^2."""
        sums = np.append(_flat(self._phasors[None])[0], self._drift)
        solution = np.asarray(cho_solve(cho_factor(self._products.normal()), sums))
        return solution, max(self._power - float(solution @ sums), 0.0)


def lines_of(solution: Array, count: int) -> Lines:
    """Return the lines (K, H + 1) of coefficients (K, P), with their mean square."""
    size = 2 * count + 1
    phasors = (solution[:, 1:size:2] + 1j * solution[:, 2:size:2]) / np.sqrt(2.0)
    return np.column_stack([solution[:, :1].astype(np.complex128), phasors])


def _flat(phasors: Lines) -> Array:
    """Return sums over cosines and negative sines (K, 1 + 2 H) from those over exp(i k w t)."""
    pairs = np.stack([phasors[:, 1:].real, -phasors[:, 1:].imag], axis=-1)
    return np.column_stack([phasors[:, 0].real, pairs.reshape(phasors.shape[0], -1)])


def _blocks(time: Array, frequency: float, count: int) -> Iterator[tuple[slice, Lines]]:
    """Yield blocks of samples, each with its harmonics exp(i k w t), (H + 1, B)."""
    for first in range(0, time.size, _BLOCK):
        inside = slice(first, min(first + _BLOCK, time.size))
        base = np.exp(2j * np.pi * frequency * time[inside])
        waves = np.empty((count + 1, base.size), dtype=np.complex128)
        waves[0] = 1.0
        for k in range(1, count + 1):
            np.multiply(waves[k - 1], base, out=waves[k])
        yield inside, waves

"""Least squares of harmonics over many samples.

The columns of the fit are never there as a whole: at 31 harmonics they would take half a kilobyte
for each sample. Their products are sums of harmonics of twice the number, so that no matrix of
columns is multiplied by itself either.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.linalg import cho_factor, cho_solve

from discover.sine_fit import ComplexArray, Harmonics, Moments, columns_of, moments
from models.checks import Array


@dataclass(frozen=True)
class HarmonicLines:
    """A fit of mean, harmonics and a drift to columns of samples."""

    harmonics: Harmonics
    """At N samples."""
    count: int
    """Number of harmonics, H."""
    middle: float | None
    """s, where the drift is zero; None for a fit without one."""
    factor: Any
    """Of the normal matrix, as `scipy.linalg.cho_factor` gives it."""

    @property
    def time(self) -> Array:
        """(N,) s."""
        return self.harmonics.at.time

    def solve(self, columns: Array) -> Array:
        """Return coefficients of columns (K, N): (K, 1 + 2 H), or one more with a drift.

        In the order of `discover.sine_fit.harmonic_design`.
        """
        sums = _flat(self.harmonics.sums(columns, self.count)[0])
        if self.middle is not None:
            sums = np.column_stack([sums, columns @ (self.time - self.middle)])
        return np.asarray(cho_solve(self.factor, sums.T).T)

    def fitted(self, solution: Array) -> Array:
        """Return what coefficients (P,) give at the samples, (N,)."""
        size = 2 * self.count + 1
        weights = solution[1:size:2] + 1j * solution[2:size:2]
        result = self.harmonics.series(np.concatenate([solution[:1], weights]))
        if self.middle is not None:
            result += solution[-1] * (self.time - self.middle)
        return result

    def lines(self, columns: Array) -> ComplexArray:
        """Return the lines of columns (..., N): (..., H + 1), with their mean square."""
        found = lines_of(self.solve(columns.reshape(-1, self.time.size)), self.count)
        return found.reshape((*columns.shape[:-1], self.count + 1))


def harmonic_lines(
    at: Moments, frequency: float, count: int, *, middle: float | None
) -> HarmonicLines:
    """Return the fit at samples.

    Parameters
    ----------
    at : Moments
        Of the N samples, s.
    frequency : float
        Hz.
    count : int
        Harmonics.
    middle : float or None
        s, where the drift is zero; None for a fit without one.

    Examples
    --------
    >>> t = np.arange(50) / 20.0
    >>> fit = harmonic_lines(moments(t), 1.3, 2, middle=1.0)
    >>> columns = np.stack([3.0 + 2.0 * np.cos(2 * np.pi * 1.3 * t), t - 1.0])
    >>> (fit.solve(columns).round(9) + 0.0).tolist()
    [[3.0, 2.0, 0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0, 0.0, 1.0]]
    """
    harmonics = Harmonics(at, frequency)
    products = _Products(count, middle)
    products.add(harmonics)
    return HarmonicLines(harmonics, count, middle, cho_factor(products.normal()))


class _Products:
    """Sums of harmonics over samples, of which the products of all columns are made."""

    def __init__(self, count: int, middle: float | None) -> None:
        self.middle = middle
        self.columns = columns_of(tuple(range(1, count + 1)), trend=middle is not None)
        self.powers = 1 if middle is None else 3
        self.sums = np.zeros((self.powers, 2 * count + 1), dtype=np.complex128)

    def add(self, harmonics: Harmonics) -> None:
        """Add samples."""
        own = harmonics.own(self.sums.shape[1] - 1, powers=self.powers)
        if self.middle is not None:  # time counts from the middle, harmonics from zero
            own[2] += self.middle * (self.middle * own[0] - 2.0 * own[1])
            own[1] -= self.middle * own[0]
        self.sums += own

    def normal(self) -> Array:
        """Return the normal matrix."""
        return self.columns.products(self.sums)


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
        harmonics = Harmonics(moments(time), self.frequency)
        self._products.add(harmonics)
        self._phasors += harmonics.sums(force[None], self._phasors.size - 1)[0, 0]
        self._drift += float((time - self.middle) @ force)
        self._power += float(force @ force)

    def solve(self) -> tuple[Array, float]:
        """Return coefficients (P,) as `HarmonicLines.solve`, and the misfit's square sum, N^2."""
        sums = np.append(_flat(self._phasors[None])[0], self._drift)
        solution = np.asarray(cho_solve(cho_factor(self._products.normal()), sums))
        return solution, max(self._power - float(solution @ sums), 0.0)


def lines_of(solution: Array, count: int) -> ComplexArray:
    """Return the lines (K, H + 1) of coefficients (K, P), with their mean square."""
    size = 2 * count + 1
    phasors = (solution[:, 1:size:2] + 1j * solution[:, 2:size:2]) / np.sqrt(2.0)
    return np.column_stack([solution[:, :1].astype(np.complex128), phasors])


def _flat(phasors: ComplexArray) -> Array:
    """Return sums over cosines and negative sines (K, 1 + 2 H) from those over exp(i k w t)."""
    pairs = np.stack([phasors[:, 1:].real, -phasors[:, 1:].imag], axis=-1)
    return np.column_stack([phasors[:, 0].real, pairs.reshape(phasors.shape[0], -1)])

"""Sums over samples of harmonics, and series of harmonics at samples.

Samples in equal steps, of which some may be missing, are cut into blocks: the harmonics of one
block are those of the next but for a turn. So both are products of small matrices, and no
exponential is evaluated at a sample.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from math import comb

import numpy as np
from numpy.typing import NDArray

from discover.sine_fit.design import ComplexArray
from models.checks import Array, Indices

_BLOCK = 1024  # samples: with their harmonics they stay in the processor's cache
_ROUNDING = 16.0  # times the last bit of the time, by which equal steps may differ
_SPARSEST = 2.0  # places of equal steps for each sample


@dataclass(frozen=True)
class Moments:
    """Times of samples; in equal steps, where they are."""

    time: Array
    """(N,) s; rising where they are in equal steps."""
    step: float | None
    """s, of equal steps; None where times do not lie on any, or do not rise."""
    places: Indices | None
    """(N,) steps since the first sample; None where none is missing."""

    @property
    def steps(self) -> int:
        """Number of equal steps, with those whose sample is missing."""
        return self.time.size if self.places is None else int(self.places[-1]) + 1

    def since(self, origin: float) -> Moments:
        """Return the same with times counted from another origin, s."""
        return Moments(self.time - origin, self.step, self.places)

    def of(self, kept: NDArray[np.bool_]) -> Moments:
        """Return some of the samples, (N,) true where they are kept."""
        if self.step is None:
            return Moments(self.time[kept], None, None)
        places = np.flatnonzero(kept) if self.places is None else self.places[kept]
        return Moments(self.time[kept], self.step, places - places[0])


def moments(time: Array) -> Moments:
    """Return times (N,), s, with the equal steps that they lie on but for rounding.

    Examples
    --------
    >>> moments(np.array([0.1, 0.2, 0.3, 0.5])).places.tolist()
    [0, 1, 2, 4]
    >>> moments(np.array([0.1, 0.2, 0.33])).step is None
    True

    Mean times of cells of a cycle lie on a grid too, but do not rise:

    >>> moments(np.array([0.2, 0.1, 0.3])).step is None
    True
    """
    size = time.size
    steps = np.diff(time)
    if size < 2 or not float(steps.min()) > 0.0:
        return Moments(time, None, None)
    usual = float(np.median(steps[:_BLOCK]))
    span = float(time[-1] - time[0])
    count = round(span / usual)
    if not size - 1 <= count < _SPARSEST * size:
        return Moments(time, None, None)
    step = span / count
    tolerance = _ROUNDING * np.finfo(float).eps * float(max(abs(time[0]), abs(time[-1]), span))
    if count == size - 1:
        apart = time - (time[0] + step * np.arange(size))
        places = None
    else:
        places = np.rint((time - time[0]) / step).astype(np.intp)
        apart = time - (time[0] + step * places)
    if float(np.abs(apart).max()) > tolerance:
        return Moments(time, None, None)
    return Moments(time, step, places)


@dataclass(frozen=True)
class Harmonics:
    """Harmonics ``exp(i k w t)`` at samples, which are never all there at once."""

    at: Moments
    """Of N samples."""
    frequency: float
    """Hz, of the fundamental."""

    def sums(self, columns: Array, count: int, *, powers: int = 1) -> ComplexArray:
        """Return sums of columns (K, N), times powers of time, over harmonics 0 to `count`.

        Returns
        -------
        ndarray of complex, shape (powers, K, count + 1)
            For the powers of time from 0 on.

        Examples
        --------
        >>> time = np.arange(4) / 4.0
        >>> sums = Harmonics(moments(time), 1.0).sums(np.cos(2 * np.pi * time)[None], 1)
        >>> np.allclose(sums, [[[0.0, 2.0]]])
        True
        """
        found = np.zeros((powers, columns.shape[0], count + 1), dtype=np.complex128)
        if self.at.step is None:
            for inside, waves in self._blocks(count):
                power_of_time = np.ones(waves.shape[1])
                for m in range(powers):
                    found[m] += (columns[:, inside] * power_of_time) @ waves.T
                    power_of_time = power_of_time * self.at.time[inside]
            return found
        pairs = self._pairs(count, powers)
        for place, column in enumerate(columns):
            found[:, place] = self._joined(self._on_steps(column) @ pairs, count, powers)
        return found

    def own(self, count: int, *, powers: int = 1) -> ComplexArray:
        """Return sums of powers of time over harmonics, (powers, count + 1): of the samples alone.

        Examples
        --------
        >>> own = Harmonics(moments(np.arange(4) / 4.0), 1.0).own(1, powers=2)
        >>> np.allclose(own, [[4.0, 0.0], [1.5, -0.5 - 0.5j]])
        True
        """
        if self.at.step is None or self.at.places is not None:
            return self.sums(np.ones((1, self.at.time.size)), count, powers=powers)[:, 0]
        pairs = self._pairs(count, powers)
        each = np.tile(pairs.sum(axis=0), (self._starts.size, 1))
        each[-1] = pairs[: self.at.steps - (self._starts.size - 1) * _BLOCK].sum(axis=0)
        return self._joined(each, count, powers)

    def series(self, phasors: ComplexArray) -> Array:
        """Return ``Re sum_k c_k exp(i k w t)`` at the samples for phasors (..., H + 1), (..., N).

        Examples
        --------
        >>> Harmonics(moments(np.array([0.0, 0.25])), 1.0).series(np.array([1.0, 2.0, 0.5]) + 0j)
        array([3.5, 0.5])
        """
        count = phasors.shape[-1] - 1
        rows = phasors.reshape(-1, count + 1)
        result = np.empty((rows.shape[0], self.at.time.size))
        if self.at.step is None:
            for inside, waves in self._blocks(count):
                result[:, inside] = (rows @ waves).real
        else:
            waves, turns = self._block(count), self._turns(count)
            pairs = np.concatenate([waves.real, -waves.imag])
            for place, row in enumerate(rows):
                turned = row * turns
                whole = np.concatenate([turned.real, turned.imag], axis=1) @ pairs
                steps = whole.reshape(-1)[: self.at.steps]
                result[place] = steps if self.at.places is None else steps[self.at.places]
        return result.reshape(*phasors.shape[:-1], -1)

    def _pairs(self, count: int, powers: int) -> Array:
        """Return a block's harmonics times powers of the time in it, (B, powers 2 (H + 1))."""
        waves = self._block(count)
        pairs = np.concatenate([waves.real, waves.imag])
        inside = (self.at.step or 0.0) * np.arange(_BLOCK)
        return np.concatenate([pairs * inside**m for m in range(powers)]).T

    def _joined(self, each: Array, count: int, powers: int) -> ComplexArray:
        """Return sums over all blocks, (powers, H + 1), from those of each in its own time."""
        parts = each.reshape(each.shape[0], powers, 2, count + 1)
        turned = (parts[:, :, 0] + 1j * parts[:, :, 1]) * self._turns(count)[:, None]
        found = np.zeros((powers, count + 1), dtype=np.complex128)
        for m in range(powers):
            for p in range(m + 1):
                found[m] += comb(m, p) * (self._starts ** (m - p) @ turned[:, p])
        return found

    def _on_steps(self, column: Array) -> Array:
        """Return a column (N,) in blocks of steps, zero where there is no sample."""
        whole = np.zeros((self._starts.size, _BLOCK))
        flat = whole.reshape(-1)
        if self.at.places is None:
            flat[: column.size] = column
        else:
            flat[self.at.places] = column
        return whole

    @cached_property
    def _starts(self) -> Array:
        """Times at which blocks begin, s."""
        step = self.at.step or 0.0
        return np.asarray(self.at.time[0] + step * np.arange(0, self.at.steps, _BLOCK))

    def _turns(self, count: int) -> ComplexArray:
        return _powers(np.exp(2j * np.pi * self.frequency * self._starts), count).T

    def _block(self, count: int) -> ComplexArray:
        step = self.at.step or 0.0
        return _powers(np.exp(2j * np.pi * self.frequency * step * np.arange(_BLOCK)), count)

    def _blocks(self, count: int) -> Iterator[tuple[slice, ComplexArray]]:
        """Yield blocks of samples, each with its harmonics, (H + 1, B)."""
        time = self.at.time
        for first in range(0, time.size, _BLOCK):
            inside = slice(first, min(first + _BLOCK, time.size))
            yield inside, _powers(np.exp(2j * np.pi * self.frequency * time[inside]), count)


def _powers(base: ComplexArray, count: int) -> ComplexArray:
    """Return powers 0 to `count` of unit phasors (B,), by repeated products, (count + 1, B)."""
    waves = np.empty((count + 1, base.size), dtype=np.complex128)
    waves[0] = 1.0
    for k in range(1, count + 1):
        np.multiply(waves[k - 1], base, out=waves[k])
    return waves


@dataclass(frozen=True)
class Columns:
    """Real columns ``Re(a t^m exp(i k w t))`` at samples, by what makes them."""

    harmonic: Indices
    """(C,) k."""
    power: Indices
    """(C,) m: 0 or 1."""
    factor: ComplexArray
    """(C,) a."""

    @property
    def size(self) -> int:
        """Number of columns."""
        return self.harmonic.size

    def followed_by(self, other: Columns) -> Columns:
        """Return these columns and others after them."""
        return Columns(
            np.concatenate([self.harmonic, other.harmonic]),
            np.concatenate([self.power, other.power]),
            np.concatenate([self.factor, other.factor]),
        )

    def products(self, sums: ComplexArray) -> Array:
        """Return the sums over samples of products of columns, (C, C).

        Parameters
        ----------
        sums : ndarray of complex, shape (3, 2 H + 1)
            Of ``t^m exp(i k w t)`` over samples; as many m as products need.
        """
        k, m, a = self.harmonic, self.power[:, None] + self.power, self.factor
        apart = k[:, None] - k
        behind = sums[m, np.abs(apart)]
        behind = np.where(apart < 0, behind.conj(), behind)
        ahead = sums[m, k[:, None] + k]
        return np.asarray(0.5 * (a[:, None] * (a * ahead + a.conj() * behind)).real)

    def along(self, sums: ComplexArray) -> Array:
        """Return products with columns of samples, (K, C), from their sums (M, K, H + 1)."""
        return np.asarray((self.factor * sums[self.power, :, self.harmonic].T).real)


def columns_of(orders: tuple[int, ...], *, trend: bool) -> Columns:
    """Return the mean, cosines and negative sines of harmonics, and a trend.

    Examples
    --------
    >>> columns_of((1, 3), trend=True).harmonic.tolist()
    [0, 1, 1, 3, 3, 0]
    """
    harmonic = [0, *(k for k in orders for _ in range(2)), *([0] if trend else [])]
    factor = [1.0, *(a for _ in orders for a in (1.0, 1j)), *([1.0] if trend else [])]
    power = [0] * (1 + 2 * len(orders)) + [1] * int(trend)
    return Columns(np.array(harmonic), np.array(power), np.array(factor, dtype=np.complex128))

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
from discover.sine_fit.moments import Moments
from models.checks import Array

_FEW = 16  # samples for each missing one, from which those are taken out of the sums of all
_SHORTEST, _LONGEST = 64, 1024  # samples of a block: with their harmonics they stay in the cache



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
        >>> from discover.sine_fit import moments
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
        for place, column in enumerate(columns):
            found[:, place] = self._joined(self._in_blocks(column, count, powers), count, powers)
        return found

    def own(self, count: int, *, powers: int = 1) -> ComplexArray:
        """Return sums of powers of time over harmonics, (powers, count + 1): of the samples alone.

        Examples
        --------
        >>> from discover.sine_fit import moments
        >>> own = Harmonics(moments(np.arange(4) / 4.0), 1.0).own(1, powers=2)
        >>> np.allclose(own, [[4.0, 0.0], [1.5, -0.5 - 0.5j]])
        True
        """
        missing = self.at.missing
        if self.at.step is None or missing.size > self.at.time.size // _FEW:
            return self.sums(np.ones((1, self.at.time.size)), count, powers=powers)[:, 0]
        pairs = self._pairs(count, powers)
        each = np.tile(pairs.sum(axis=0), (self._starts.size, 1))
        each[-1] = pairs[: self.at.steps - (self._starts.size - 1) * self._length].sum(axis=0)
        found = self._joined(each, count, powers)
        if missing.size:
            waves = _powers(self._wave(missing), count)
            found -= np.stack([waves @ missing**m for m in range(powers)])
        return found

    def series(self, phasors: ComplexArray) -> Array:
        """Return ``Re sum_k c_k exp(i k w t)`` at the samples for phasors (..., H + 1), (..., N).

        Examples
        --------
        >>> from discover.sine_fit import moments
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
            for row, series in zip(rows, result, strict=True):
                turned = row * turns
                self._by_blocks(np.concatenate([turned.real, turned.imag], axis=1), pairs, series)
        return result.reshape(*phasors.shape[:-1], -1)

    def _pairs(self, count: int, powers: int) -> Array:
        """Return a block's harmonics times powers of the time in it, (B, powers 2 (H + 1))."""
        waves = self._block(count)
        pairs = np.concatenate([waves.real, waves.imag])
        inside = (self.at.step or 0.0) * np.arange(self._length)
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

    def _in_blocks(self, column: Array, count: int, powers: int) -> Array:
        """Return each block's sums of a column (N,) times pairs, (S, powers 2 (H + 1))."""
        pairs, steps = self._pairs(count, powers), column
        if self.at.places is not None:
            steps = np.zeros(self.at.steps)
            steps[self.at.places] = column
        blocks, rest = self._cut(steps)
        each = np.empty((self._starts.size, pairs.shape[1]))
        np.matmul(blocks, pairs, out=each[: blocks.shape[0]])
        if rest.size:
            each[-1] = rest @ pairs[: rest.size]
        return each

    def _by_blocks(self, turned: Array, pairs: Array, series: Array) -> None:
        """Put products of blocks' phasors (S, C) and waves (C, B) into a series (N,)."""
        if self.at.places is not None:
            series[:] = (turned @ pairs).reshape(-1)[self.at.places]
            return
        blocks, rest = self._cut(series)
        np.matmul(turned[: blocks.shape[0]], pairs, out=blocks)
        if rest.size:
            rest[:] = turned[-1] @ pairs[:, : rest.size]

    def _cut(self, steps: Array) -> tuple[Array, Array]:
        """Return the whole blocks (S, B) of a column in equal steps, and the samples after them."""
        whole = steps.size // self._length
        after = whole * self._length
        return steps[:after].reshape(whole, self._length), steps[after:]

    @cached_property
    def _length(self) -> int:
        """Samples of a block: about as many as there are blocks."""
        return int(np.clip(2 ** round(0.5 * np.log2(self.at.steps)), _SHORTEST, _LONGEST))

    @cached_property
    def _starts(self) -> Array:
        """Times at which blocks begin, s."""
        step = self.at.step or 0.0
        return np.asarray(self.at.time[0] + step * np.arange(0, self.at.steps, self._length))

    @cached_property
    def _kept(self) -> dict[tuple[str, int], ComplexArray]:
        return {}

    def _turns(self, count: int) -> ComplexArray:
        """Return what turns a block's harmonics to each block, (S, H + 1)."""
        key = ("turns", count)
        if key not in self._kept:
            self._kept[key] = _powers(self._wave(self._starts), count).T
        return self._kept[key]

    def _block(self, count: int) -> ComplexArray:
        """Return the harmonics in a block's own time, (H + 1, B)."""
        key = ("block", count)
        if key not in self._kept:
            inside = (self.at.step or 0.0) * np.arange(self._length)
            self._kept[key] = _powers(self._wave(inside), count)
        return self._kept[key]

    def _wave(self, time: NDArray[np.floating]) -> ComplexArray:
        return np.asarray(np.exp(2j * np.pi * self.frequency * time))

    def _blocks(self, count: int) -> Iterator[tuple[slice, ComplexArray]]:
        """Yield blocks of samples, each with its harmonics, (H + 1, B)."""
        time = self.at.time
        for first in range(0, time.size, _LONGEST):
            inside = slice(first, min(first + _LONGEST, time.size))
            yield inside, _powers(self._wave(time[inside]), count)


def _powers(base: ComplexArray, count: int) -> ComplexArray:
    """Return powers 0 to `count` of unit phasors (B,), by repeated products, (count + 1, B)."""
    waves = np.empty((count + 1, base.size), dtype=np.complex128)
    waves[0] = 1.0
    for k in range(1, count + 1):
        np.multiply(waves[k - 1], base, out=waves[k])
    return waves

"""A sine test's samples compared with those that other cycles measured at the same phase."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from models.checks import Array, Indices
from models.compiled import compiled

_LEAST_WEIGHT = 1e-3  # of a neighbour in phase, against one at the same phase
_SLOPED = 1e-3  # of the weights' square, by which their phases have to differ for a slope
_NEAREST = 8  # samples in phase, to either side, that one is compared with at most


@dataclass(frozen=True)
class SamePhase:
    """For each of N samples a straight line in phase through those beside it: what repeats."""

    begin: Indices
    """(N + 1,) where the weights of each sample's comparison begin."""
    places: Indices
    """(E,) samples that are compared."""
    weights: Array
    """(E,) of each."""

    @property
    def own(self) -> Array:
        """(N,) weight of each sample in its own comparison."""
        samples = np.repeat(np.arange(self.begin.size - 1), np.diff(self.begin))
        return np.asarray(self.weights[self.places == samples])

    def left(self, columns: Array) -> Array:
        """Return what repeats not of columns (N, C)."""
        return np.asarray(_left(self.begin, self.places, self.weights, columns))

    def spread(self, columns: Array) -> Array:
        """Return columns (N, C) mapped by the transpose of `left`."""
        return np.asarray(_spread(self.begin, self.places, self.weights, columns))

    def lag_products(self, at: Indices, rows: Indices, size: int) -> Array:
        """Return products of a sample's and its comparison's weights, summed by lag, (size,).

        Of some `rows`; lags count in steps between places (N,) in time, in a circle of `size`.
        """
        most = int(np.diff(self.begin).max())
        return np.asarray(
            _lag_products(self.begin, self.places, self.weights, at, rows, size, most)
        )


def same_phase(phase: Array, order: Indices, half: float) -> SamePhase:
    """Return the comparison of samples.

    Parameters
    ----------
    phase : ndarray, shape (N,)
        In cycles, from 0 to 1, rising.
    order : ndarray, shape (N,)
        Which sample each phase belongs to.
    half : float
        Cycles, up to which samples are compared, to either side.

    Examples
    --------
    >>> found = same_phase(np.array([0.0, 0.0, 0.5, 0.5]), np.array([0, 2, 1, 3]), 0.1)
    >>> found.left(np.array([[1.0], [2.0], [3.0], [2.0]]))[:, 0].tolist()
    [-1.0, 0.0, 1.0, 0.0]
    """
    size = phase.size
    around = np.concatenate([phase - 1.0, phase, phase + 1.0])
    here = np.arange(size, 2 * size)
    first = np.maximum(np.searchsorted(around, phase - half, side="left"), here - _NEAREST)
    last = np.minimum(np.searchsorted(around, phase + half, side="right"), here + _NEAREST + 1)
    count = np.empty(size, dtype=np.intp)
    count[order] = last - first
    begin = np.concatenate(([0], np.cumsum(count)))
    return SamePhase(begin, *_lines_through(around, order, first, last, begin, half))


@compiled(cache=True)
def _lines_through(
    around: Array, order: NDArray[np.intp], first: NDArray[np.intp], last: NDArray[np.intp],
    begin: NDArray[np.intp], half: float,
) -> tuple[NDArray[np.intp], Array]:
    """Return samples (E,) and weights (E,) of the line at each sample's phase, in their order."""
    size = order.size
    places, weights = np.empty(begin[-1], dtype=np.intp), np.empty(begin[-1])
    for i in range(size):
        own, at = around[size + i], begin[order[i]]
        zeroth = one = two = 0.0
        for k in range(first[i], last[i]):
            away = (around[k] - own) / half
            weight = max(1.0 - away * away, _LEAST_WEIGHT)
            zeroth += weight
            one += weight * away
            two += weight * away * away
        spread = zeroth * two - one * one
        sloped = spread > _SLOPED * zeroth * zeroth
        for k in range(first[i], last[i]):
            away = (around[k] - own) / half
            weight = max(1.0 - away * away, _LEAST_WEIGHT)
            if sloped:
                weights[at] = weight * (two - one * away) / spread
            else:
                weights[at] = weight / zeroth
            places[at] = order[k % size]
            at += 1
    return places, weights


@compiled(cache=True)
def _left(begin: Indices, places: Indices, weights: Array, columns: Array) -> Array:
    """Return columns (N, C) less their comparison."""
    found = columns.copy()
    for i in range(columns.shape[0]):
        own = found[i]
        for e in range(begin[i], begin[i + 1]):
            other, weight = columns[places[e]], weights[e]
            for k in range(own.size):
                own[k] -= weight * other[k]
    return found


@compiled(cache=True)
def _spread(begin: Indices, places: Indices, weights: Array, columns: Array) -> Array:
    """Return columns (N, C) less what comparisons with them give back."""
    found = columns.copy()
    for i in range(columns.shape[0]):
        own = columns[i]
        for e in range(begin[i], begin[i + 1]):
            other, weight = found[places[e]], weights[e]
            for k in range(own.size):
                other[k] -= weight * own[k]
    return found


@compiled(cache=True)
def _lag_products(
    begin: Indices, places: Indices, weights: Array, at: Indices, rows: Indices, size: int,
    most: int,
) -> Array:
    """Return as `SamePhase.lag_products`; no sample is compared with more than `most`."""
    found = np.zeros(size)
    times, sizes = np.empty(most + 1, dtype=np.intp), np.empty(most + 1)
    for i in rows:
        times[0], sizes[0] = at[i], 1.0
        count = begin[i + 1] - begin[i]
        for k in range(count):
            times[k + 1], sizes[k + 1] = at[places[begin[i] + k]], -weights[begin[i] + k]
        for k in range(count + 1):
            found[0] += sizes[k] * sizes[k]
            for j in range(k):
                found[abs(times[k] - times[j])] += 2.0 * sizes[k] * sizes[j]
    return found

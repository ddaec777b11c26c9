"""Sums of a sine test's samples that are near in phase and time."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.sparse import csr_array

from models.checks import Array, Indices
from models.compiled import compiled

POINTS = 2048
"""Of the grid over one cycle, on which terms are evaluated; samples are told apart by it."""
STRETCHES = 16
"""Of the record's time, which are told apart."""
PHASES = 256
"""Cells of a cycle in each stretch, whose samples are averaged."""

_EACH = POINTS // PHASES
_HALF = 0.5 + 1e-6  # of a cycle: mean times lie in the middle of two, and round-off chose one


@dataclass(frozen=True)
class CycleSums:
    """What samples add up to, by stretch of time and by phase between two points of a cycle.

    A sample is between the point below its phase and the next one, at a share of the way u from
    one to the other. A force that is straight between points differs from the measured one by
    what these sums tell exactly.
    """

    frequency: float
    """Hz."""
    first: float
    """s, of the first sample."""
    last: float
    """s, of the last one."""
    count: Array
    """(S, P) samples."""
    share: Array
    """(S, P) of u."""
    square: Array
    """(S, P) of u^2."""
    time: Array
    """(S, P) s, of the time since the first sample."""
    force: Array
    """(S, P) N."""
    force_share: Array
    """(S, P) N, of the force times u."""
    power: float
    """N^2, of all forces squared."""

    @property
    def samples(self) -> int:
        """Number of samples."""
        return int(self.count.sum())

    @cached_property
    def _filled(self) -> Indices:
        return np.flatnonzero(_cells(self.count).ravel() > 0.0)

    @cached_property
    def counts(self) -> Array:
        """(M,) samples of each cell that has any."""
        return np.asarray(_cells(self.count).ravel()[self._filled])

    @cached_property
    def means(self) -> Array:
        """(M,) N, the mean force of each cell."""
        return np.asarray(_cells(self.force).ravel()[self._filled] / self.counts)

    @cached_property
    def moments(self) -> Array:
        """(M,) s: the middle of each cell in phase, in a cycle near its mean time."""
        place = (np.arange(POINTS) * self.count + self.share) / POINTS
        phase = _cells(place).ravel()[self._filled] / self.counts
        time = self.first + _cells(self.time).ravel()[self._filled] / self.counts
        cycles = np.floor(time * self.frequency - phase + _HALF)
        return np.asarray((cycles + phase) / self.frequency)

    @cached_property
    def on_cycle(self) -> csr_array:
        """(P, M): what each point of a cycle is of each cell's mean."""
        stretch, point = np.nonzero(self.count)
        cell = np.searchsorted(self._filled, stretch * PHASES + point // _EACH)
        after = self.share[stretch, point]
        before = self.count[stretch, point] - after
        return csr_array(
            (
                np.concatenate([before, after]) / np.tile(self.counts[cell], 2),
                (np.concatenate([point, (point + 1) % POINTS]), np.tile(cell, 2)),
            ),
            shape=(POINTS, self.counts.size),
        )

    @cached_property
    def middles(self) -> Array:
        """(S, P) s: the time at each point of a cycle in the middle of each stretch."""
        middle = (np.arange(STRETCHES) + 0.5) / STRETCHES * (self.last - self.first) + self.first
        phase = np.arange(POINTS) / POINTS
        cycles = np.floor(middle[:, None] * self.frequency - phase + _HALF)
        return np.asarray((cycles + phase) / self.frequency)

    def misfit(self, force: Array) -> float:
        """Return the sum of squares (N^2) of the samples less a force (S, P) at the points."""
        rise = np.roll(force, -1, axis=1) - force
        along = np.sum(force * self.force + rise * self.force_share)
        own = force**2 * self.count + 2.0 * force * rise * self.share + rise**2 * self.square
        return max(float(self.power - 2.0 * along + np.sum(own)), 0.0)


def cycle_sums(
    pieces: Iterable[tuple[Array, Array]], frequency: float, first: float, last: float
) -> CycleSums:
    """Return the sums of samples.

    Parameters
    ----------
    pieces : iterable of (ndarray, ndarray), each (B,)
        Times, s, and forces, N.
    frequency : float
        Hz.
    first, last : float
        s, of the first and the last sample.

    Examples
    --------
    >>> t = np.arange(1000) / 100.0
    >>> found = cycle_sums([(t[:300], t[:300]), (t[300:], t[300:])], 1.0, t[0], t[-1])
    >>> found.samples, float(found.means @ found.counts), round(found.misfit(0.0 * found.count))
    (1000, 4995.0, 33283)
    """
    totals = np.zeros((STRETCHES * POINTS, 6))
    power = 0.0
    for time, force in pieces:
        _add(totals, time, force, frequency, first, STRETCHES / (last - first))
        power += float(force @ force)
    count, shares, squares, times, forces, turned = totals.T.reshape(6, STRETCHES, POINTS)
    return CycleSums(
        frequency=frequency,
        first=first,
        last=last,
        count=count,
        share=shares,
        square=squares,
        time=times,
        force=forces,
        force_share=turned,
        power=power,
    )


@compiled(cache=True)
def _add(
    totals: Array, time: Array, force: Array, frequency: float, first: float, density: float
) -> None:
    """Add samples to the sums of their cells; `density` is in stretches for each second."""
    for i in range(time.size):
        since = time[i] - first
        stretch = min(int(since * density), STRETCHES - 1)
        place = ((time[i] * frequency) % 1.0) * POINTS
        point = min(int(place), POINTS - 1)
        share = place - point
        total = totals[stretch * POINTS + point]
        total[0] += 1.0
        total[1] += share
        total[2] += share * share
        total[3] += since
        total[4] += force[i]
        total[5] += force[i] * share


def _cells(values: Array) -> Array:
    """Return sums (S, P) over the cells, (S, C)."""
    return np.asarray(values.reshape(STRETCHES, PHASES, _EACH).sum(axis=2))

"""The work over closed loops of the displacement: whether a device takes or gives energy.

Over a loop that returns to its displacement no spring of any shape and no constant force does
work. What the kinetic energy keeps follows the change of speed squared, and is fitted beside the
mean. So the mean work is what the device takes, whatever its law.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.special import ndtri, stdtrit

from models.checks import Array

_LEVELS = np.linspace(0.1, 0.9, 9)  # of the stroke, at which loops may begin
_PASSES = 0.02  # of the stroke: a crossing is one that goes that far to either side
_ENOUGH_LOOPS = 5  # for the kinetic energy to be fitted
_SURE = 0.995  # probability, from which the sign of the work is sure
_SLOPE_PART = 0.02  # of a loop's samples, to either side, over which its speed is taken
_ROUND_OFF = 1e-9  # of the work that the force could have done


@dataclass(frozen=True)
class LoopWork:
    """The mean work over a record's closed loops."""

    mean: float
    """J a loop; positive where the device takes energy."""
    doubt: float
    """J: half the width of its 99 % interval, and what a shift by one sample would change."""
    share: float
    """Of the work that the same force would do if it were in phase with the velocity; -1 to 1."""
    loops: int
    """Number of loops."""

    @property
    def takes(self) -> bool:
        """Return whether the device surely takes energy."""
        return self.mean > self.doubt

    @property
    def gives(self) -> bool:
        """Return whether the device surely gives energy."""
        return self.mean < -self.doubt


def loop_work(displacement: Array, force: Array) -> LoopWork | None:
    """Return the mean work over closed loops; None where no loop closes.

    Parameters
    ----------
    displacement, force : ndarray, shape (N,)
        m and N, uniformly sampled.

    Returns
    -------
    LoopWork or None

    Examples
    --------
    A damper of 300 N s/m beside a spring takes pi c w A^2 a cycle.

    >>> t = np.arange(8000) / 1000.0
    >>> x = 0.01 * np.sin(5.0 * t)
    >>> found = loop_work(x, 15.0 * np.cos(5.0 * t) + 2e4 * x)
    >>> found.takes, bool(abs(found.mean - np.pi * 15.0 * 0.01) < 1e-3)
    (True, True)
    """
    if not np.ptp(displacement) > 0.0:
        return None
    ends = _closed(displacement)
    if ends is None:
        return None
    force = force - force.mean()
    work, doubt = _mean_work(displacement, force, ends)
    later, _ = _mean_work(displacement[:-1], force[1:], ends)
    earlier, _ = _mean_work(displacement[1:], force[:-1], ends - 1.0)
    inside = slice(int(ends[0]), int(np.ceil(ends[-1])) + 1)
    moved = np.diff(displacement[inside])
    load = 0.5 * (force[inside][1:] + force[inside][:-1])
    could = float(np.linalg.norm(moved) * np.linalg.norm(load)) / (ends.size - 1)
    doubt += 0.5 * abs(later - earlier) + _ROUND_OFF * could
    return LoopWork(work, doubt, work / could if could > 0.0 else 0.0, ends.size - 1)


def _closed(x: Array) -> Array | None:
    """Return places (fractions of samples) between which x closes, at the level that covers most.

    Whole cycles where there are any; otherwise one stretch that begins and ends at one level.
    """
    low, stroke = float(np.min(x)), float(np.ptp(x))
    whole, single = list[Array](), list[Array]()
    for part in _LEVELS:
        level = low + part * stroke
        rising = _rising(x, level, _PASSES * stroke)
        crossing = _places(x, np.flatnonzero((x[1:-2] >= level) != (x[2:-1] >= level)) + 1, level)
        if rising.size >= 2:
            whole.append(rising)
        if crossing.size >= 2:
            single.append(crossing[[0, -1]])
    found = whole or single
    return max(found, key=lambda ends: _path(x, ends)) if found else None


def _path(x: Array, ends: Array) -> float:
    return float(np.sum(np.abs(np.diff(x[int(ends[0]) : int(np.ceil(ends[-1])) + 1]))))


def _rising(x: Array, level: float, pass_: float) -> Array:
    """Return where x rises through a level, once for every time that it was well below."""
    side = np.where(x > level + pass_, 1, np.where(x < level - pass_, -1, 0))
    known = np.flatnonzero(side)
    turns = np.flatnonzero((side[known][:-1] < 0) & (side[known][1:] > 0))
    first, last = known[turns], known[turns + 1]
    stretches = zip(first, last, strict=True)
    at = [int(b) + int(np.flatnonzero(x[b:e] <= level)[-1]) for b, e in stretches]
    inner = [i for i in at if 1 <= i < x.size - 2]  # a shift by one sample stays within
    return _places(x, np.array(inner, dtype=np.intp), level)


def _places(x: Array, before: NDArray[np.intp], level: float) -> Array:
    return np.asarray(before + (level - x[before]) / (x[before + 1] - x[before]))


def _mean_work(x: Array, force: Array, ends: Array) -> tuple[float, float]:
    """Return the mean work a loop and the half width of its interval, J."""
    total = np.concatenate(([0.0], np.cumsum(0.5 * (force[1:] + force[:-1]) * np.diff(x))))
    at = np.interp(ends, np.arange(x.size), total)
    work = np.diff(at)
    noise = np.diff(force, 2) / np.sqrt(6.0)  # what a smooth force leaves: white noise
    moved = np.diff(x[int(ends[0]) : int(np.ceil(ends[-1])) + 1])
    if work.size == 1:
        return float(work[0]), float(ndtri(_SURE) * np.std(noise) * np.linalg.norm(moved))
    columns = np.ones((work.size, 1))
    if work.size >= _ENOUGH_LOOPS:
        change = np.diff(_speed(x, ends) ** 2)
        size = float(np.std(change))
        if size > 0.0:
            columns = np.column_stack([columns, change / size])
    found, *_ = np.linalg.lstsq(columns, work, rcond=1e-10)
    left = work - columns @ found
    freedom = work.size - columns.shape[1]
    spread = float(left @ left) / freedom * np.linalg.pinv(columns.T @ columns)[0, 0]
    return float(found[0]), float(stdtrit(freedom, _SURE) * np.sqrt(spread))


def _speed(x: Array, ends: Array) -> Array:
    """Return the slope at each place, a sample, over a small part of a loop."""
    reach = max(1.0, _SLOPE_PART * float(np.mean(np.diff(ends))))
    index = np.arange(x.size)
    after, before = np.minimum(ends + reach, x.size - 1.0), np.maximum(ends - reach, 0.0)
    return np.asarray((np.interp(after, index, x) - np.interp(before, index, x)) / (after - before))

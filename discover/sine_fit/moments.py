"""Times of samples, and the equal steps that they lie on."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from models.checks import Array, Indices

_FIRST = 1024  # samples, whose median step is the usual one
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

    @property
    def missing(self) -> Array:
        """(M,) s, of equal steps whose sample is missing."""
        if self.places is None or self.step is None:
            return np.zeros(0)
        gone = np.ones(self.steps, dtype=np.bool_)
        gone[self.places] = False
        return np.asarray(self.time[0] + self.step * np.flatnonzero(gone))

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
    usual = float(np.median(steps[:_FIRST]))
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

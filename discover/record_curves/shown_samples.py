"""Which samples of a record its picture shows: a few turns of the motion, decimated."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from discover.motion_fit import Observation

_POINTS = 600  # of a record as drawn
_CYCLES = 2.0  # of a sine test as drawn
_TURNS = 4.0  # of other motion in a stretch: more can't be told apart in a picture
_STRETCHES = 3  # of other records as drawn


def shown_samples(observation: Observation) -> NDArray[np.intp]:
    """Return the indices that a picture shows, rising.

    Two cycles of a sine test. Of other records three stretches of four turns at the mean frequency
    there: from the first third, about the greatest force, and from the last third; all of the
    record where it is shorter than they are.

    Parameters
    ----------
    observation : Observation
        The record.
    """
    time = observation.time
    step = float((time[-1] - time[0]) / (time.size - 1))
    if observation.kind == "sine":
        length = int(np.ceil(_CYCLES / (observation.frequency * step))) + 1
        return _thinned(0, min(time.size, length), _POINTS)
    peak = int(np.argmax(np.abs(observation.measured)))
    middles = sorted({time.size // 6, peak, time.size - time.size // 6})
    stretches = [_stretch(observation, middle, step) for middle in middles]
    if sum(last - first for first, last in stretches) >= time.size:
        return _thinned(0, time.size, _POINTS)
    shares = [_thinned(first, last, _POINTS // _STRETCHES) for first, last in stretches]
    return np.unique(np.concatenate(shares))


def _stretch(observation: Observation, middle: int, step: float) -> tuple[int, int]:
    """Return the first and one past the last sample of a few turns about a sample."""
    size = observation.time.size
    ends = np.cumsum([w.share for w in observation.windows])
    window = int(np.searchsorted(ends / ends[-1], middle / size))
    frequency = observation.windows[min(window, len(ends) - 1)].frequency
    turns = _TURNS / frequency if frequency else np.inf  # of rest there are none
    length = int(min(size, np.ceil(turns / step) + 1))
    first = min(max(middle - length // 2, 0), size - length)
    return first, first + length


def _thinned(first: int, last: int, points: int) -> NDArray[np.intp]:
    places = np.linspace(first, last - 1, min(points, last - first))
    return np.unique(places.astype(np.intp))

"""Which samples of a record its picture shows: a few turns of the motion, decimated."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from discover.motion_fit import Observation

_POINTS = 600
_CYCLES = 2.0
_TURNS = 12.0  # of other motion: more can't be told apart in a picture


def shown_samples(observation: Observation) -> NDArray[np.intp]:
    """Return the indices that a picture shows.

    Two cycles of a sine test; of other records a stretch of twelve turns at their mean frequency
    about the greatest force, or all where they are shorter.

    Parameters
    ----------
    observation : Observation
        The record.
    """
    time = observation.time
    step = float((time[-1] - time[0]) / (time.size - 1))
    sine = observation.kind == "sine"
    turns = _CYCLES if sine else _TURNS
    length = min(time.size, int(np.ceil(turns / (observation.frequency * step))) + 1)
    first = 0
    if not sine:
        middle = int(np.argmax(np.abs(observation.measured)))
        first = min(max(middle - length // 2, 0), time.size - length)
    places = np.linspace(first, first + length - 1, min(_POINTS, length))
    return np.unique(places.astype(np.intp))

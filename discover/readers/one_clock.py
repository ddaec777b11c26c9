"""Whether channels with times of their own are sampled together."""

from __future__ import annotations

import numpy as np

from models.checks import Array, Indices

NEAR = 0.05
"""Of a sampling interval, to which times of one sample agree."""


def off_clock(clock: Array, times: Array) -> Indices:
    """Return the places at which times are not those of a clock; one that is no number is not.

    Parameters
    ----------
    clock, times : ndarray, shape (N,)
        s.

    Examples
    --------
    >>> import numpy as np
    >>> off_clock(np.arange(4.0), np.array([0.0, 1.01, 2.3, 3.0]))
    array([2])
    """
    step = abs(float(clock[-1] - clock[0])) / max(clock.size - 1, 1)
    return np.asarray(np.flatnonzero(~(np.abs(times - clock) <= NEAR * step)))

"""The fastest motion in a record: what its samples have to be close enough for."""

from __future__ import annotations

import numpy as np
from scipy.fft import next_fast_len, rfft

from models.checks import Array

SHARE = 0.999
"""Of the displacement's variance, that lies at or below the fastest motion."""
_MOST = 2**22  # samples of the grid that the spectrum is taken on


def fastest_motion(time: Array, displacement: Array) -> float:
    """Return the frequency below which nearly all of a displacement's variance lies, Hz.

    Unevenly sampled displacement is joined by straight lines on a grid of its usual step: a gap
    then adds nothing fast.

    Parameters
    ----------
    time : ndarray, shape (N,)
        s, rising.
    displacement : ndarray, shape (N,)
        m.

    Examples
    --------
    >>> t = np.r_[np.arange(0.0, 4.0, 0.005), np.arange(4.0, 8.0, 0.01)]
    >>> 1.4 < fastest_motion(t, np.sin(2.0 * np.pi * 1.5 * t)) < 2.0
    True
    """
    duration = float(time[-1] - time[0])
    count = int(min(duration / float(np.median(np.diff(time))) + 1.0, _MOST))
    grid = np.linspace(time[0], time[-1], max(count, time.size))
    x = np.interp(grid, time, displacement)
    ramp = np.linspace(-1.0, 1.0, x.size)
    x = x - x.mean()
    x = x - ramp * (ramp @ x) / (ramp @ ramp)
    padded = next_fast_len(x.size, real=True)
    power = np.cumsum(np.abs(rfft(x * np.hanning(x.size), padded)) ** 2)
    bins = max(int(np.searchsorted(power, SHARE * power[-1])), 1)
    return bins * (grid.size - 1) / (duration * padded)

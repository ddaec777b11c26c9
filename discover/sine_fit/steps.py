"""The steps of a stepped sine: stretches of one record in which frequency and amplitude stay."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from models.checks import Array

_ALIKE = 0.02  # of a cycle's length and amplitude, by which those of one step differ at most
_APART = 0.05  # of either, by which neighbouring steps differ at least: a sweep changes by less
_FEWEST = 3  # crossings in a row that begin a cycle: two whole cycles
_SETTLED = 6  # likewise, from which the first cycle is left out: the device settles in it
_MOST_OF_IT = 0.6  # of the motion's time, that the steps have to cover
_BESIDE_ZERO = 0.02  # of the greatest excursion, within which noise may cross


def sine_steps(time: Array, displacement: Array) -> list[tuple[float, float]]:
    """Return where the steps of a stepped sine begin and end, s; none of any other motion.

    Cycles are told by their crossings of the middle, up and down. Those that follow each other
    with one length and one amplitude are a step; neighbouring steps differ plainly in one of them.
    Of a step of three cycles and more the first one is left out.

    Parameters
    ----------
    time, displacement : ndarray, shape (N,)
        s, and m.

    Examples
    --------
    >>> t = np.arange(4000) / 500.0
    >>> x = np.where(t < 4.0, np.sin(2 * np.pi * t), np.sin(4 * np.pi * t))
    >>> [(round(a, 1), round(b, 1)) for a, b in sine_steps(t, x)]
    [(1.5, 4.0), (4.5, 7.8)]
    """
    x = displacement - 0.5 * (displacement.max() + displacement.min())
    crossings = _crossings(time, x)
    if crossings.size < 2 * (_FEWEST + 2):
        return []
    lengths = crossings[2:] - crossings[:-2]
    places = np.searchsorted(time, crossings)
    peaks = np.maximum.reduceat(np.abs(x), places[:-1])
    amplitudes = 0.5 * (peaks[1:] + peaks[:-1])
    steps = _runs(np.log(lengths), np.log(amplitudes))
    means = [(np.median(lengths[s]), np.median(amplitudes[s])) for s in steps]
    apart = [
        max(abs(np.log(b[0] / a[0])), abs(np.log(b[1] / a[1]))) > _APART for a, b in pairwise(means)
    ]
    if len(steps) < 2 or not all(apart):
        return []
    covered = sum(crossings[s.stop + 1] - crossings[s.start] for s in steps)
    if covered < _MOST_OF_IT * (crossings[-1] - crossings[0]):
        return []
    ends = [(s.start + 2 * (s.stop - s.start >= _SETTLED), s.stop + 1) for s in steps]
    return [(float(crossings[a]), float(crossings[b])) for a, b in ends]


def _crossings(time: Array, x: Array) -> Array:
    """Return when x passes zero, s, by straight lines past what noise does beside it."""
    beside = _BESIDE_ZERO * float(np.abs(x).max())
    far = np.flatnonzero(np.abs(x) > beside)
    turned = np.flatnonzero(np.diff(np.sign(x[far])) != 0.0)
    before, after = far[turned], far[turned + 1]
    share = x[before] / (x[before] - x[after])
    return np.asarray(time[before] + share * (time[after] - time[before]))


def _runs(*logs: Array) -> list[slice]:
    """Return the stretches in which none of some logarithms leaves that of the stretch's first."""
    found, start = list[slice](), 0
    for stop in range(1, logs[0].size + 1):
        same = stop < logs[0].size and all(abs(v[stop] - v[start]) < _ALIKE for v in logs)
        if not same:
            if stop - start >= _FEWEST:
                found.append(slice(start, stop))
            start = stop
    return found

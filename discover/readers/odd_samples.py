"""Samples that no motion explains: short spikes, and stretches in which a channel stands still."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from discover.readers.time_text import time_text
from models.checks import Array

_APART = 5.0  # times the largest other step, from which a sample is a spike
_LENGTHS = (1, 2)  # samples of a spike: a converter may hold one over two
_MOST = 5  # spikes: more are the signal's own
_LONGEST = 8  # samples of one value in a row, from which a channel may be frozen
_LONGER = 5  # times as long as every other such row: a coarse channel has many
_ABRUPT = 0.2  # of the top speed: a motion that rests has slowed down before
_JUMP = 2.0  # times the top speed: what a channel that was frozen catches up by
_MOVES = 0.05  # of its range, that the other channel covers meanwhile

Place = Callable[[int], str]
"""Names a row's place in its file."""


def spikes(values: Array) -> list[slice]:
    """Return the samples, one or two in a row, that jump away from both of their neighbours.

    They do so farther than any others by far. An impact lasts longer: its rise or its fall is as
    steep as its peak.

    Examples
    --------
    >>> x = np.sin(np.arange(2000) / 50.0)
    >>> spikes(x)
    []
    >>> x[333] += 5.0
    >>> x[1200:1202] -= 5.0
    >>> spikes(x)
    [slice(333, 334, None), slice(1200, 1202, None)]
    """
    step = np.diff(values)
    candidates = [found for length in _LENGTHS for found in _excursions(step, length)]
    candidates.sort(key=lambda found: -found[0])
    rest = np.abs(step)
    count = 0
    for number, (height, at) in enumerate(candidates[:_MOST], start=1):
        rest[at.start - 1 : at.stop] = 0.0
        if height > _APART * rest.max():
            count = number
    return sorted((at for _, at in candidates[:count]), key=lambda at: at.start)


def _excursions(step: Array, length: int) -> list[tuple[float, slice]]:
    """Return the highest runs of so many samples that leave and come back, with their heights."""
    ahead, behind = step[: step.size - length], -step[length:]
    height = np.where(ahead * behind > 0.0, np.minimum(np.abs(ahead), np.abs(behind)), 0.0)
    highest = np.argsort(height)[::-1][:_MOST]
    return [(float(height[at]), slice(int(at) + 1, int(at) + 1 + length)) for at in highest]


def frozen(values: Array, other: Array) -> slice | None:
    """Return where a channel stays on one value amid motion while the other moves on, or None.

    Examples
    --------
    >>> t = np.arange(2000) / 50.0
    >>> x = np.sin(t)
    >>> frozen(x, np.cos(t)) is None
    True
    >>> x[300:340] = x[300]
    >>> frozen(x, np.cos(t))
    slice(300, 340, None)
    """
    step = np.abs(np.diff(values))
    edges = np.flatnonzero(np.diff(np.r_[0, (step == 0.0).astype(np.int8), 0]))
    begins, lengths = edges[::2], edges[1::2] - edges[::2] + 1
    if not lengths.size:
        return None
    longest = int(np.argmax(lengths))
    first, length = int(begins[longest]), int(lengths[longest])
    others = np.delete(lengths, longest)
    if length < max(_LONGEST, _LONGER * int(others.max(initial=1))):
        return None
    inside = slice(first, first + length)
    if first == 0 or inside.stop >= values.size:
        return None
    top = float(np.quantile(step, 0.99))
    ends = sorted((step[first - 1], step[inside.stop - 1]))
    slow = ends[0] < _ABRUPT * top and ends[1] < _JUMP * top
    if slow or np.ptp(other[inside]) < _MOVES * np.ptp(other):
        return None
    return inside


def odd_samples(time: Array, force: Array, displacement: Array | None, place: Place) -> list[str]:
    """Return what to tell about short spikes and frozen stretches of a record's channels.

    Parameters
    ----------
    time, force : ndarray, shape (N,)
        s, N.
    displacement : ndarray, shape (N,), or None
        m.
    place : callable
        Names a row's place in the file.
    """
    told: list[str] = []
    step = float(time[-1] - time[0]) / (time.size - 1)
    channels = [("force", "N", force, displacement)]
    if displacement is not None:
        channels.append(("displacement", "m", displacement, force))
    for name, unit, values, other in channels:
        for at in spikes(values):
            first = time_text(float(time[at.start]), step)
            last = time_text(float(time[at.stop - 1]), step)
            times = first if first == last else f"{first} to {last}"
            told.append(_spike(name, unit, values, at, place) + _left_out(times))
        still = None if other is None else frozen(values, other)
        if still is not None:
            first, last = (time_text(float(time[i]), step) for i in (still.start, still.stop - 1))
            told.append(
                f"the {name} stays at {values[still.start]:.6g} {unit} for"
                f" {still.stop - still.start} samples from {place(still.start)} on, while the rest"
                f" moves: the channel looks frozen; leave {first} s to {last} s out by"
                " `range` in [[records]]"
            )
    return told


def _spike(name: str, unit: str, values: Array, at: slice, place: Place) -> str:
    """Return what one spike of a channel is, and where."""
    first, last = at.start, at.stop - 1
    size = f"{values[first]:.4g}" + (f" and {values[last]:.4g}" if last > first else "")
    many = "one sample," if last == first else f"{last - first + 1} samples from"
    return (
        f"the {name} is {size} {unit} for {many} {place(first)}, between"
        f" {values[first - 1]:.4g} and {values[last + 1]:.4g} {unit}"
    )


def _left_out(times: str) -> str:
    return (
        f": if that is no event of the device, leave {times} s out by `range` in [[records]], or"
        " mend the file"
    )

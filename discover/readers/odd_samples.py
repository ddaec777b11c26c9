"""Samples that no motion explains: single spikes, and stretches in which a channel stands still."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from models.checks import Array

_APART = 5.0  # times the largest other step, from which a sample is a spike
_MOST = 5  # spikes: more are the signal's own
_LONGEST = 8  # samples of one value in a row, from which a channel may be frozen
_LONGER = 5  # times as long as every other such row: a coarse channel has many
_ABRUPT = 0.2  # of the top speed: a motion that rests has slowed down before
_JUMP = 2.0  # times the top speed: what a channel that was frozen catches up by
_MOVES = 0.05  # of its range, that the other channel covers meanwhile

Place = Callable[[int], str]
"""Names a row's place in its file."""


def spikes(values: Array) -> list[int]:
    """Return the samples that jump away from both neighbours, farther than any others by far.

    An impact lasts several samples: its rise or its fall is as steep as its peak.

    Examples
    --------
    >>> x = np.sin(np.arange(2000) / 50.0)
    >>> x[333] += 5.0
    >>> spikes(x), spikes(np.sin(np.arange(2000) / 50.0))
    ([333], [])
    """
    step = np.diff(values)
    ahead, behind = step[1:], -step[:-1]  # away from the next, from the one before
    height = np.where(ahead * behind > 0.0, np.minimum(np.abs(ahead), np.abs(behind)), 0.0)
    highest = np.argsort(height)[::-1][:_MOST]
    rest = np.abs(step)
    found: list[int] = []
    for count, at in enumerate(highest, start=1):
        rest[at : at + 2] = 0.0
        if height[at] > _APART * rest.max():
            found = sorted(int(i) + 1 for i in highest[:count])
    return found


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
    """Return what to tell about single spikes and frozen stretches of a record's channels.

    Parameters
    ----------
    time, force : ndarray, shape (N,)
        s, N.
    displacement : ndarray, shape (N,), or None
        m.
    place : callable
        Names a row's place in the file.
    """
    told = []
    channels = [("force", "N", force, displacement)]
    if displacement is not None:
        channels.append(("displacement", "m", displacement, force))
    for name, unit, values, other in channels:
        for at in spikes(values):
            told.append(
                f"the {name} is {values[at]:.4g} {unit} for one sample, {place(at)}, between"
                f" {values[at - 1]:.4g} and {values[at + 1]:.4g} {unit}: if that is no event of the"
                f" device, leave {time[at]:.6g} s out by `range` in [[records]], or mend the file"
            )
        still = None if other is None else frozen(values, other)
        if still is not None:
            first, last = time[still.start], time[still.stop - 1]
            told.append(
                f"the {name} stays at {values[still.start]:.6g} {unit} for"
                f" {still.stop - still.start} samples from {place(still.start)} on, while the rest"
                f" moves: the channel looks frozen; leave {first:.6g} s to {last:.6g} s out by"
                " `range` in [[records]]"
            )
    return told

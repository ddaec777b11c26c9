"""Channels of one record with times of their own, brought onto one clock."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from discover.readers.columns import (
    QUANTITIES,
    check_finite,
    find_column,
    split_header,
    stated_unit,
)
from discover.readers.fastest_motion import fastest_motion
from discover.readers.names import LETTER, name_score
from discover.readers.one_clock import off_clock
from discover.readers.sampling import FEWEST_SAMPLES, LONGEST_GAP
from discover.readers.source import Source
from discover.readers.units import measures, to_si
from discover.records import on_grid
from models.checks import Array, InputError, shown

_BY_PLACE = "; where all are of the same samples, take out the columns of time but one"
_ROUND = 1e-6  # of a sampling interval, by which a float may miss the end of another clock


@dataclass(frozen=True)
class _Channel:
    """One column of a record."""

    quantity: str
    """What it is."""
    header: str
    """As in the file."""
    index: int
    """Of the header."""
    times: Array
    """(N,) s, of its samples."""
    values: Array
    """(N,) in the file's unit."""


def on_one_clock(source: Source, names: Mapping[str, str], units: Mapping[str, str]) -> Source:
    """Return a table whose channels are on one clock: resampled, where their own times differ.

    A format may tell each channel's times. In a table a column of time that stands before
    channels is theirs, as in ``Time A, Force, Time B, Displacement``. The finest clock is taken,
    over the time in which all channels have samples; the others follow by cubic splines.

    Parameters
    ----------
    source : Source
        The table.
    names, units : mapping
        Headers and units by quantity, as of ``[columns]`` and ``[units]``.

    Returns
    -------
    Source
        The table as it is where its channels have the same times, or where some have none.

    Raises
    ------
    InputError
        Where the times do not overlap, or one clock is too coarse for the motion.
    """
    found = {q: find_column(source, q, names.get(q, q)) for q in QUANTITIES if q != "time"}
    needed = {quantity: index for quantity, index in found.items() if index is not None}
    clocks = _clock_columns(source)
    if "force" not in needed or (source.times is None and len(set(clocks.values())) < 2):
        return source
    channels = _channels(source, needed, clocks, units.get("time"))
    if len(channels) < len(needed):
        return source
    place = _time_column(source, names)
    differ = _differ([c.times for c in channels])
    made = place is None and source.step is not None
    if not differ and (place is not None or (made and _are_made(source, channels[0].times))):
        return source
    base = min(channels, key=lambda c: float(np.median(np.diff(c.times))))
    grid = base.times
    if differ:
        grid = _shared(source, channels, base)
        _check_fine(source, channels)
        text = _told(channels, base, grid) + (_BY_PLACE if source.times is None else "")
        source = replace(source, told=(*source.told, text))
    values = {c.index: _on(c, base, grid) if differ else c.values for c in channels}
    hidden = set(clocks.values()) - {place}
    if place is None:
        place, source = _with_time(source, names.get("time", "time"))
    unit = stated_unit(source, place) or units.get("time") or "s"
    values[place] = grid / float(to_si(np.ones(1), unit, "time")[0])
    headers = tuple("" if i in hidden else header for i, header in enumerate(source.headers))
    return replace(
        source, headers=headers, read=lambda indices: [values[i].copy() for i in indices],
        times=None, step=None, cell=None, rows=None, pieces=None,
        place=(lambda row: f"resampled row {row + 1}") if differ else source.place,
    )  # fmt: skip


def _time_column(source: Source, names: Mapping[str, str]) -> int | None:
    try:
        return find_column(source, "time", names.get("time", "time"))
    except InputError:  # several, none of which is the one
        return None


def _with_time(source: Source, header: str) -> tuple[int, Source]:
    """Return the place of one more column, of time in seconds, and the table with it."""
    place = len(source.headers)
    units = {**source.units, place: "s"}
    return place, replace(source, headers=(*source.headers, header), units=units)


def _on(channel: _Channel, base: _Channel, grid: Array) -> Array:
    """Return a channel's values on the grid, which are some of the base's times."""
    if channel is base:
        return channel.values[np.isin(channel.times, grid)]
    return on_grid(channel.times, {"": channel.values}, grid)[""]


def _clock_columns(source: Source) -> dict[int, int]:
    """Return the column of time that stands before each column of a table, where one does."""
    named = [
        index
        for index, header in enumerate(source.headers)
        if _is_called_time(header, stated_unit(source, index))
    ]
    found: dict[int, int] = {}
    clock, before = None, False
    for index in range(len(source.headers) if len(named) > 1 else 0):
        if index in named and _rises(source, index):
            clock = clock if before else index  # of some beside each other the first
            before = True
            continue
        before = False
        if clock is not None:
            found[index] = clock
    return found


def _is_called_time(header: str, unit: str | None) -> bool:
    """Return whether a column is called time; a letter alone is one where it is small, as t1.

    T1 is a temperature.
    """
    name = split_header(header)[0].strip()
    score = name_score(name, "time")
    said = score > LETTER or unit is not None or name[:1] != "T"
    return score > 0.0 and said and measures(unit or "s", "time")


def _rises(source: Source, index: int) -> bool:
    try:
        (column,) = source.read([index])
    except InputError:
        return False
    times = column[: _filled(column)]
    return times.size >= FEWEST_SAMPLES and bool((np.diff(times) > 0.0).all())


def _filled(*columns: Array) -> int:
    """Return how many rows there are before all columns end in empty ones."""
    rows = np.flatnonzero(~np.logical_and.reduce([np.isnan(column) for column in columns]))
    return int(rows[-1]) + 1 if rows.size else 0


def _channels(
    source: Source, needed: Mapping[str, int], clocks: Mapping[int, int], unit: str | None
) -> list[_Channel]:
    """Return the columns whose times are known."""
    found = []
    for quantity, index in needed.items():
        times = None if source.times is None else source.times(index, slice(None))
        (values,) = source.read([index])
        if times is None and index in clocks:
            (raw,) = source.read([clocks[index]])
            own = stated_unit(source, clocks[index]) or unit or "s"
            times = to_si(raw, own, "time")
        if times is None or times.size != values.size:
            continue
        size = _filled(times, values)
        check_finite(source, index, values, np.arange(values.size) < size)
        times, values = times[:size], values[:size]
        if size >= FEWEST_SAMPLES and (np.diff(times) > 0.0).all():
            found.append(_Channel(quantity, source.headers[index], index, times, values))
    return found


def _differ(clocks: Sequence[Array]) -> bool:
    """Return whether some times are not the first ones."""
    first = clocks[0]
    return any(t.size != first.size or off_clock(first, t).size > 0 for t in clocks[1:])


def _are_made(source: Source, times: Array) -> bool:
    """Return whether times are those that a table's step makes."""
    step = source.step or 1.0
    return not _differ([source.start + step * np.arange(float(times.size)), times])


def _shared(source: Source, channels: Sequence[_Channel], base: _Channel) -> Array:
    """Return the times of the base at which all channels have samples before and after."""
    slack = _ROUND * float(np.median(np.diff(base.times)))
    first = max(float(c.times[0]) for c in channels) - slack
    last = min(float(c.times[-1]) for c in channels) + slack
    grid = base.times[(base.times >= first) & (base.times <= last)]
    if grid.size >= FEWEST_SAMPLES:
        return grid
    spans = [f"{c.quantity} from {c.times[0]:.9g} to {c.times[-1]:.9g} s" for c in channels]
    raise InputError(
        "time", expected=f"of all channels over at least {FEWEST_SAMPLES} samples that they share",
        found=", ".join(spans) + "; save the channels of a test with one clock", where=source.name,
    )  # fmt: skip


def _check_fine(source: Source, channels: Sequence[_Channel]) -> None:
    """Refuse a channel that is sampled too seldom to be joined by a spline."""
    motion = next((c for c in channels if c.quantity == "displacement"), None)
    if motion is None:
        return
    fastest = fastest_motion(motion.times, to_si(motion.values, "m", "length"))
    for channel in channels:
        longest = float(np.diff(channel.times).max())
        if channel.quantity != "temperature" and longest > LONGEST_GAP / fastest:
            raise InputError(
                channel.header,
                expected=f"sampled every {LONGEST_GAP / fastest:.4g} s or faster, a quarter of a"
                f" cycle of its fastest motion ({fastest:.3g} Hz), as its times are its own",
                found=f"steps of up to {longest:.6g} s; save the channels of a test at one rate",
                where=source.name,
            )


def _told(channels: Sequence[_Channel], base: _Channel, grid: Array) -> str:
    """Return what to tell of channels that were resampled."""
    steps = [
        f"{c.quantity} every {np.median(np.diff(c.times)):.4g} s from {c.times[0]:.6g} s on"
        for c in channels
    ]
    return (
        f"channels have times of their own ({', '.join(steps)}), taken to be of one clock: all are"
        f" resampled to the times of {shown(base.header)} by a cubic spline,"
        f" from {grid[0]:.6g} to {grid[-1]:.6g} s"
    )

"""LabVIEW measurement files (.lvm, and .txt that LabVIEW wrote) as sources of columns."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from discover.readers.content import content_error
from discover.readers.cut_row import BEFORE, cut_text, is_cut
from discover.readers.numerals import value
from discover.readers.source import Book, Source, column_reader
from models.checks import Array, InputError, shown

_UNEVEN = 0.5  # of a step, by which the next segment may begin off the grid
_MARK = "***End_of_Header***"
_TITLE = b"LabVIEW Measurement"


def is_lvm(data: bytes) -> bool:
    """Return whether text begins as LabVIEW begins its measurement files."""
    return data[:200].removeprefix(b"\xef\xbb\xbf").lstrip().startswith(_TITLE)


def open_lvm(data: bytes, name: str) -> Book:
    """Open a LabVIEW measurement file: its segments are tests, those that go on in time one.

    Notes
    -----
    National Instruments, *Specification for the LabVIEW Measurement File (.lvm)*: a header of the
    file, then for each segment a header with one column a channel, a line of names that begins
    with ``X_Value``, and samples. ``X_Columns`` says whether the file holds times at all (``No``:
    they follow from ``X0`` and ``Delta_X``), once (``One``) or beside every channel (``Multi``).

    Raises
    ------
    InputError
        Where it is no such file or a field is no number, with its line.
    """
    try:
        text = data.removeprefix(b"\xef\xbb\xbf").decode("utf-8")
    except UnicodeDecodeError:
        text = data.decode("latin-1")
    lines = text.splitlines()
    commas = any(line.startswith("Separator,") for line in lines[:40])
    separator = "," if commas else "\t"
    general, segments = _segments([line.split(separator) for line in lines])
    if not segments:
        raise content_error("a LabVIEW file with samples", "none", name)
    cut = _cut_line(segments[-1], unended=not text.endswith(("\n", "\r")))
    decimal = (general.get("Decimal_Separator") or ["."])[0] or "."
    if (general.get("X_Columns") or ["One"])[0] != "No":
        segments = _gone_on(segments, decimal)
    many = len(segments) > 1
    parts = []
    for number, segment in enumerate(segments, start=1):
        part = f"segment {number}" if many else ""
        inside = f"{name} [{part}]" if many else name
        parts.append(_source(segment, general, decimal, inside, part))
    if cut is not None:
        parts[-1] = replace(parts[-1], told=(cut_text(cut, lines[cut - 1]),))
    return Book(name, tuple(parts))


def _cut_line(segment: _Segment, *, unended: bool) -> int | None:
    """Take out a segment's last row where it was not written to its end; return its line."""
    width = sum(name != "Comment" for name in segment.names)
    rows = [fields for _, fields in segment.rows[-BEFORE - 1 :]]
    if len(rows) < 2 or not is_cut(rows[-1], rows[:-1], width, unended=unended):
        return None
    return segment.rows.pop()[0]


def _gone_on(segments: Sequence[_Segment], decimal: str) -> list[_Segment]:
    """Return the segments, with those joined that go on in time."""
    found: list[_Segment] = []
    for segment in segments:
        if found and _goes_on(found[-1], segment, decimal):
            found[-1].rows += segment.rows
        else:
            found.append(segment)
    return found


def _goes_on(first: _Segment, second: _Segment, decimal: str) -> bool:
    """Return whether a segment has the channels of the one before and begins a step after it."""
    units = [segment.notes.get("Y_Unit_Label") for segment in (first, second)]
    if first.names != second.names or units[0] != units[1] or len(first.rows) < 2:
        return False
    rows = (*first.rows[-2:], second.rows[0])
    before, last, begin = (value(fields[0], decimal) or 0.0 for _, fields in rows)
    return 0.0 < last - before and abs(begin - last - (last - before)) < _UNEVEN * (last - before)


@dataclass
class _Segment:
    """What one segment of the file holds."""

    notes: dict[str, list[str]] = field(default_factory=dict)
    """Values by key, one a channel."""
    names: list[str] = field(default_factory=list)
    """Of the columns."""
    rows: list[tuple[int, list[str]]] = field(default_factory=list)
    """Line numbers and fields of the samples."""


def _segments(lines: Sequence[list[str]]) -> tuple[dict[str, list[str]], list[_Segment]]:
    """Return the file's own header and its segments."""
    general: dict[str, list[str]] = {}
    segments: list[_Segment] = []
    notes: dict[str, list[str]] = general
    heading, named = True, False
    for number, fields in enumerate(lines, start=1):
        first = fields[0].strip()
        if not any(f.strip() for f in fields):
            continue
        if first == _MARK:
            named, heading = notes is general, False
            if notes is not general:
                segments.append(_Segment(notes))
            notes = {}
        elif not heading and first == "Channels":
            heading, notes = True, {"Channels": fields[1:]}
        elif heading:
            notes[first] = [f.strip() for f in fields[1:]]
        elif not named and first == "X_Value":
            if not segments:
                segments.append(_Segment())
            segments[-1].names, named = [f.strip() for f in fields], True
        elif segments:
            segments[-1].rows.append((number, fields))
    return general, [s for s in segments if s.names and s.rows]


def _source(
    segment: _Segment, general: Mapping[str, list[str]], decimal: str, name: str, part: str
) -> Source:
    style = (general.get("X_Columns") or ["One"])[0]
    names = [n for n in segment.names if n != "Comment"]
    channels = [i for i, n in enumerate(names) if n != "X_Value"]
    units = segment.notes.get("Y_Unit_Label", [])
    timed = style != "No"
    wanted = ([0] if timed else []) + channels
    columns = list(_columns(segment, wanted, decimal, name))
    headers = tuple(names[i] for i in wanted)
    # Values in a segment's header stand in the columns of the channels, the first one left out.
    stated = {i: unit for i, unit in enumerate(units, start=1) if unit}
    known = {place: stated[i] for place, i in enumerate(wanted) if i in stated}
    if timed:
        known[0] = "s"
    return Source(
        name,
        headers,
        column_reader(name, headers, columns),
        lambda row: f"line {segment.rows[row][0]}",
        part,
        units=known,
        roles={"time": 0} if timed else {},
        step=None if timed else _number(segment.notes, "Delta_X", decimal),
        start=0.0 if timed else _number(segment.notes, "X0", decimal) or 0.0,
        times=_own_times(segment, wanted, decimal, name, timed=timed) if style != "One" else None,
    )


def _own_times(
    segment: _Segment, wanted: Sequence[int], decimal: str, name: str, *, timed: bool
) -> Callable[[int, slice], Array | None]:
    """Return what tells the times of a channel: those to its left, or of its own increment."""
    clocks = [i for i, own in enumerate(segment.names) if own == "X_Value"]

    def times(index: int, part: slice) -> Array | None:
        at = wanted[index]
        if timed:
            before = [clock for clock in clocks if clock < at]
            return next(_columns(segment, before[-1:], decimal, name))[part] if before else None
        step = _number(segment.notes, "Delta_X", decimal, at - 1)
        start = _number(segment.notes, "X0", decimal, at - 1) or 0.0
        rows = range(len(segment.rows))[part]
        return None if step is None else start + step * np.asarray(rows, dtype=np.float64)

    return times


def _columns(segment: _Segment, wanted: Sequence[int], decimal: str, name: str) -> Iterator[Array]:
    for index in wanted:
        column = np.full(len(segment.rows), np.nan)
        for row, (line, fields) in enumerate(segment.rows):
            text = fields[index] if index < len(fields) else ""
            found = value(text, decimal)
            if found is None:
                raise InputError(
                    segment.names[index], expected="a number", found=shown(text.strip()),
                    where=f"{name} line {line}",
                )  # fmt: skip
            column[row] = found
        yield column


def _number(
    notes: Mapping[str, list[str]], key: str, decimal: str, at: int = 0
) -> float | None:
    text = [*notes.get(key, []), *[""] * (at + 1)][at]
    found = value(text, decimal) if text else None
    return found if found is not None and np.isfinite(found) and found != 0.0 else None

"""A record that is too long to be held: its first samples, and all of them in pieces."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial

import numpy as np

from discover.readers.columns import find_column, read_columns
from discover.readers.entries import Entry
from discover.readers.own_clocks import on_one_clock
from discover.readers.record import MAY_LACK, read_record
from discover.readers.source import LONG, Source, some_times
from discover.record_kind import classify
from discover.records import Finding, LongRecord, Piece, Record
from models.checks import Array, InputError

FIRST = 2**20
"""Samples that are held of a sine test that is read in pieces."""

_MEMORY = 250.0  # bytes a sample that the work on a whole record takes, about
_QUANTITIES = ("time", "displacement", "force")


def read_record_of_any_length(
    source: Source,
    entry: Entry,
    *,
    names: Mapping[str, str],
    units: Mapping[str, str],
    part: str = "",
) -> tuple[Record, list[Finding], Mapping[str, str | None]]:
    """Read one record, a long sine test in pieces; else as `read_record`, whose arguments it has.

    A file whose pieces can be read and that has more than `LONG` samples is judged by its first
    `FIRST` ones. Where they are a sine test with a displacement, the record keeps these, and all
    samples as pieces. Any other is read whole.
    """
    whole = partial(read_record, names=names, units=units, part=part)
    if source.pieces is None or source.rows is None or source.rows <= LONG:
        return whole(source, entry)
    if entry.span != (None, None):
        source, entry = _spanned(source, entry, names, units), replace(entry, span=(None, None))
    rows = source.rows or 0
    if rows <= LONG:
        return whole(source, entry)
    begin = first_part(source)
    if entry.step is None and on_one_clock(begin, names, units) is not begin:
        return whole(source, entry)
    record, findings, read = whole(begin, entry)
    file = record.file
    sine = record.displacement is not None and classify(record).kind == "sine"
    if not sine:
        record, findings, read = whole(source, entry)
        text = (
            f"it has {rows:,} samples and its first {FIRST:,} are no sine test: it is held whole,"
            f" which takes about {_MEMORY * rows / 1e9:.2g} GB; [[records]] range reads less of it"
        )
        return record, [*findings, Finding("warning", text, file)], read
    pieces = partial(_pieces, source, names=names, units=units, step=entry.step, where=file)
    if record.time[0] == 0.0:  # the record's times may count from its first sample
        pieces = partial(pieces, origin=float(next(pieces()).time[0]))
    text = (
        f"it has {rows:,} samples, read in pieces: its frequency, rows and errors are of all of"
        f" them; its kind, what is odd in it, its noise and its pictures of the first {FIRST:,}"
    )
    findings.append(Finding("note", text, file))
    return replace(record, long=LongRecord(rows, pieces)), findings, read


def first_part(source: Source) -> Source:
    """Return what is held of a source: its first rows where it is long, else all."""
    if source.pieces is None or source.rows is None or source.rows <= LONG:
        return source
    return _part(source, 0, FIRST)


def _part(source: Source, first: int, last: int) -> Source:
    """Return a source of some rows of one that is read in pieces."""
    if source.pieces is None:
        raise ValueError("the source is read whole")
    original, place = source.pieces, source.place

    def pieces(indices: Sequence[int]) -> Iterator[list[Array]]:
        begin = 0
        for columns in original(indices):
            size = columns[0].size
            inside = slice(max(first - begin, 0), max(last - begin, 0))
            begin += size
            if begin > first:
                yield [column[inside] for column in columns]
            if begin >= last:
                return

    def read(indices: Sequence[int]) -> list[Array]:
        return [np.concatenate(parts) for parts in zip(*pieces(indices), strict=True)]

    return replace(
        source, read=read, pieces=pieces, rows=last - first, place=lambda row: place(row + first),
        times=source.times and some_times(source, first, last),
    )  # fmt: skip


def _in_memory(source: Source, columns: Sequence[Array], begin: int) -> Source:
    """Return a source of columns (B,) that begin at a row of the file."""
    return replace(
        source,
        read=lambda indices: [columns[i] for i in indices],
        place=lambda row: source.place(row + begin),
    )


def _spanned(
    source: Source, entry: Entry, names: Mapping[str, str], units: Mapping[str, str]
) -> Source:
    """Return a source of the rows whose time is in the entry's span.

    Raises
    ------
    InputError
        Where there are none, or they do not follow each other.
    """
    low, high = (np.inf * s if v is None else v for v, s in zip(entry.span, (-1, 1), strict=True))
    first, count, last, begin = 0, 0, 0, 0
    for piece in _pieces(source, names=names, units=units, step=entry.step, where=entry.file):
        inside = np.flatnonzero((piece.time >= low) & (piece.time <= high))
        if inside.size:
            first = begin + int(inside[0]) if not count else first
            last = begin + int(inside[-1]) + 1
            count += inside.size
        begin += piece.time.size
    if not count:
        raise InputError(
            "range", expected="inside the record", found=entry.span_text, where=entry.file
        )
    return _part(source, first, last)


def _pieces(
    source: Source,
    *,
    names: Mapping[str, str],
    units: Mapping[str, str],
    step: float | None,
    where: str,
    origin: float = 0.0,
) -> Iterator[Piece]:
    """Yield the pieces of a record in SI; times count from `origin` (s).

    Raises
    ------
    InputError
        Where a value is not finite or time does not rise.
    """
    if source.pieces is None:
        raise ValueError("the source is read whole")
    found = {q: find_column(source, q, names.get(q, q)) for q in _QUANTITIES}
    used = {q: i for q, i in found.items() if i is not None and not (q == "time" and step)}
    own = {q: place for place, q in enumerate(used)}
    few = replace(
        source,
        headers=tuple(source.headers[i] for i in used.values()),
        units={own[q]: source.units[i] for q, i in used.items() if i in source.units},
        roles={q: own[q] for q, i in used.items() if source.roles.get(q) == i},
    )
    begin, before = 0, -np.inf
    for columns in source.pieces(list(used.values())):
        here = _in_memory(few, columns, begin)
        read = read_columns(here, names=names, units=units, may_lack=MAY_LACK, step=step)
        time = read.values["time"]
        if read.step is not None:
            time = time + begin * read.step
        if not np.diff(time, prepend=before).min() > 0.0:
            row = int(np.flatnonzero(np.diff(time, prepend=before) <= 0.0)[0])
            raise InputError(
                "time", expected="rising", found=f"{time[row]:.9g} s after one that is not less",
                where=f"{where} {here.place(row)}",
            )
        displacement = read.values.get("displacement", np.empty(0))
        yield Piece(time - origin, displacement, read.values["force"])
        begin, before = begin + time.size, float(time[-1])

"""Where the tables of a text file or a sheet lie: preamble, header, unit row, samples, footer."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise, takewhile

import numpy as np
from numpy.typing import NDArray

from discover.readers.columns import split_header
from discover.readers.cut_row import BEFORE, is_cut
from discover.readers.leading_numbers import SHOWN_BY, leading_numbers
from discover.readers.names import known_name
from discover.readers.numerals import is_number
from discover.readers.units import is_unit
from models.checks import shown

Mask = NDArray[np.bool_]

_LONGEST_PREAMBLE = 2000  # rows before the samples that are looked at
_LONGEST_LIST = 12  # rows of texts between the names and the samples
_SHOWN = 60  # characters of a line
_UNIT_ROW = re.compile(r"\b(units?|einheit(en)?|unités?)\b", re.IGNORECASE)
_UNIT_MARKS = ("[", "(")


@dataclass(frozen=True)
class Rows:
    """A text's lines or a sheet's rows."""

    numeric: Mask
    """(N,) where a row holds numbers and nothing else."""
    blank: Mask
    """(N,) where it holds nothing."""
    comment: Mask
    """(N,) where it is marked as a comment."""
    fields: Callable[[int], list[str]]
    """A row's fields as text; of a comment without its mark."""
    unended: bool = False
    """Whether the last row has no end, as where writing stopped in the middle of it."""

    @property
    def count(self) -> int:
        """Number of rows."""
        return int(self.numeric.size)


@dataclass(frozen=True)
class Layout:
    """One table."""

    headers: tuple[str, ...]
    """As written; "column 1" and so on where there is no header."""
    units: dict[int, str]
    """By column, from a row of units below the header."""
    header: int | None
    """Row of the header; None where there is none."""
    first: int
    """Row of the first sample."""
    last: int
    """One past the row of the last sample."""
    title: str
    """What stands alone above the header, "" for none."""
    notes: tuple[tuple[str, str], ...]
    """Names and values of the preamble."""
    cut: int | None = None
    """The row after the last sample, where it is one that was not written to its end."""
    above: tuple[int, ...] = ()
    """Rows of numbers above columns without names that are no samples."""


def find_tables(rows: Rows) -> list[Layout]:
    """Return the tables in order: each a run of samples with what stands above it.

    A row of samples begins with a number and has two numbers or more, or is one number; the next
    row has as many fields. What stands above is a header of as many texts, perhaps with a row of
    units below it, or a comment that is such a header; rows further up are the preamble.
    """
    tables: list[Layout] = []
    begin = 0
    while begin < rows.count:
        first = _first_sample(rows, begin)
        if first is None:
            break
        header, units, start = _heading(rows, begin, first)
        last = _end(rows, start if header is None else max(start, header + 1))
        tables.append(_layout(rows, begin, header, units, start, last))
        begin = last
    if tables:
        tables[-1] = _without_cut_row(rows, tables[-1])
    return [_without_leading_numbers(rows, table) for table in tables]


def _without_cut_row(rows: Rows, table: Layout) -> Layout:
    """Return a table without a row of samples that ends the file and is not whole as those above.

    A row that is not whole anywhere else is for reading to complain of.
    """
    filled = np.flatnonzero(~rows.blank[table.first :])[-BEFORE - 1 :] + table.first
    if filled.size < 2 or filled[-1] >= table.last or rows.comment[filled[-2:]].any():
        return table
    *before, last = filled.tolist()
    width = len(_trimmed(table.headers))
    above = [_trimmed(rows.fields(row)) for row in before if not rows.comment[row]]
    if not is_cut(rows.fields(last), above, width, unended=rows.unended):
        return table
    return replace(table, last=last, cut=last)


def _without_leading_numbers(rows: Rows, table: Layout) -> Layout:
    """Return a table without names that begins with its samples."""
    if table.header is not None:
        return table
    filled = np.array(list(_filled(rows, table.first, table.last)))
    shown = [_trimmed(rows.fields(row)) for row in filled[: 2 * SHOWN_BY]]
    count = leading_numbers(shown, _trimmed(rows.fields(filled[-1])), filled.size)
    above = tuple(filled[:count].tolist())
    return replace(table, first=int(filled[count]), above=above) if count else table


def _trimmed(fields: Sequence[str]) -> list[str]:
    kept = [field.strip() for field in fields]
    while kept and not kept[-1]:
        kept.pop()
    return kept


def _is_sample(rows: Rows, row: int) -> bool:
    if rows.blank[row] or rows.comment[row]:
        return False
    fields = [f for f in _trimmed(rows.fields(row)) if f]
    if not fields or not is_number(fields[0]):
        return False
    return len(fields) == 1 or sum(is_number(f) for f in fields) > 1


def _filled(rows: Rows, begin: int, end: int) -> Iterator[int]:
    """Yield the rows that hold something and are no comment."""
    return (row for row in range(begin, end) if not (rows.blank[row] or rows.comment[row]))


def _first_sample(rows: Rows, begin: int) -> int | None:
    end = min(rows.count, begin + _LONGEST_PREAMBLE)
    for row in _filled(rows, begin, end):
        if not _is_sample(rows, row):
            continue
        after = next(_filled(rows, row + 1, rows.count), None)
        if after is None:
            return row
        same = len(_trimmed(rows.fields(after))) == len(_trimmed(rows.fields(row)))
        if same and _is_sample(rows, after):
            return row
    return None


def _is_header(fields: Sequence[str], width: int) -> bool:
    named = [f for f in fields if f]
    if not named or any(is_number(f) for f in named):
        return False
    return len(fields) == width or len(named) > 1


def _numbered(fields: Sequence[str], below: Sequence[str], width: int) -> bool:
    """Return whether names are channels' numbers but for the first, above a row of units only."""
    whole = len(fields) == len(below) == width > 1 and not is_number(fields[0])
    return whole and all(f.isdigit() for f in fields[1:]) and all(map(is_unit, below))


def _units(fields: Sequence[str], names: Sequence[str]) -> dict[int, str] | None:
    """Return a row's units by column, or None where it is no row of units below the names.

    Every text of it is a unit; or only some are, but the names are names and its texts are none.
    A number, and what stands beside the names, is foreign to it.
    """
    named = {i: f for i, f in enumerate(fields[: len(names)]) if f and f != "-" and names[i]}
    texts = {i: f for i, f in named.items() if not is_number(f)}
    if len(texts) < min(2, len(names)):
        return None
    plain = {i: f[1:-1].strip() if f[0] in _UNIT_MARKS else f for i, f in texts.items()}
    bare = [plain[i] for i, f in texts.items() if f[0] not in _UNIT_MARKS]
    units = sum(is_unit(text) for text in bare)
    if units < len(bare):
        as_names = sum(known_name(text) for text in bare)
        above = sum(known_name(names[i]) for i in texts)
        if 2 * units < len(bare) or units < min(2, len(bare)) or above <= as_names:
            return None
    nameless = {i: f for i, f in enumerate(fields[: len(names)]) if not names[i] and is_unit(f)}
    return {i: text for i, text in sorted({**nameless, **plain}.items()) if text}


def _heading(rows: Rows, begin: int, first: int) -> tuple[int | None, dict[int, str], int]:
    """Return the header's row, the units by column, and the row of the first sample."""
    width = len(_trimmed(rows.fields(first)))
    above = list(_filled(rows, begin, first))[::-1]
    marked = [row for row in range(begin, first) if rows.comment[row] and not rows.blank[row]]
    damaged = list(takewhile(lambda row: _is_damaged(_trimmed(rows.fields(row)), width), above))
    found = _header(rows, above[len(damaged) :], marked, width)
    if found is not None:  # and rows that are damaged follow: they are for reading to complain of
        return *found, damaged[-1] if damaged else first
    found = _header(rows, above, marked, width) if damaged else None
    if found is not None:
        return *found, first
    if above:  # likewise where rows of any kind follow the header
        top = _trimmed(rows.fields(above[-1]))
        follow = len(top) == width or all(_is_sample(rows, row) for row in above[:-1])
        if follow and _is_header(top, width):
            return above[-1], {}, above[-1] + 1
    return None, {}, first


def _header(
    rows: Rows, above: Sequence[int], marked: Sequence[int], width: int
) -> tuple[int, dict[int, str]] | None:
    """Return the header's row and the units by column, by the rows above the samples, or None."""
    named = [row for row in above[:3] if sum(map(bool, _trimmed(rows.fields(row)))) > 1]
    found = (
        _named(rows, above[:2], width)
        or _named(rows, named[:2], width, whole=True)  # below which a lone word opens the samples
        or _named(rows, marked[::-1][:2], width, whole=True)
    )
    if found is None or found[1]:
        return found
    return _stating_units(rows, above, found[0], width)


def _is_damaged(fields: Sequence[str], width: int) -> bool:
    """Return whether a row is as long as a sample and begins as one, but is none."""
    return len(fields) == width > 1 and is_number(fields[0])


def _stating_units(
    rows: Rows, above: Sequence[int], header: int, width: int
) -> tuple[int, dict[int, str]]:
    """Return the row of names that states their units, and units by column from a row below it.

    It is one of all texts right above the samples: below it an instrument may list channels,
    sensors, rates or types, a row each.
    """
    texts = {row: _trimmed(rows.fields(row)) for row in above[:_LONGEST_LIST]}
    block = list(takewhile(lambda row: _is_header(texts[row], width) and len(texts[row]) == width,
                           texts))  # fmt: skip
    counts = {row: sum(_states_unit(field) for field in texts[row]) for row in block}
    if counts.get(header, 1):
        return header, {}
    for below, row in pairwise(block):
        if below != header and all(map(is_unit, texts[below])):
            return row, dict(enumerate(texts[below]))
    best = max(block, key=lambda row: counts[row])
    return best if counts[best] >= min(2, width) else header, {}


def _states_unit(header: str) -> bool:
    unit = split_header(header)[1]
    return unit is not None and is_unit(unit)


def _named(
    rows: Rows, near: Sequence[int], width: int, *, whole: bool = False
) -> tuple[int, dict[int, str]] | None:
    """Return which of the two rows above is the header, nearest first, and the units by column."""
    texts = [_trimmed(rows.fields(row)) for row in near]
    fine = [_is_header(text, width) and not (whole and len(text) != width) for text in texts]
    if len(near) > 1 and (fine[1] or _numbered(texts[1], texts[0], width)):
        units = _units(texts[0], texts[1])
        if units is not None:
            return near[1], units
    if not whole:
        fine = fine[:1]
    return next(((row, {}) for row, good in zip(near, fine, strict=False) if good), None)


def _end(rows: Rows, first: int) -> int:
    """Return one past the last sample: where a footer or the next table's preamble begins."""
    odd = (np.flatnonzero(~rows.numeric[first:]) + first).tolist()
    for row in odd:
        if rows.blank[row] or rows.comment[row] or _is_sample(rows, row):
            continue
        after = _first_sample(rows, row)
        if after is None:
            texts = [_trimmed(rows.fields(r)) for r in _filled(rows, row, rows.count)]
            if not any(is_number(f) for text in texts for f in text if f):
                return row
        elif _heading(rows, row, after)[0] is not None:
            return row
    return rows.count


def _layout(
    rows: Rows,
    begin: int,
    header: int | None,
    units: dict[int, str],
    first: int,
    last: int,
) -> Layout:
    width = len(rows.fields(first)) if header is None else len(rows.fields(header))
    if header is None:
        names = tuple(f"column {i + 1}" for i in range(width))
    else:
        names = _names(rows, begin, header, first)
    top = first if header is None else header
    preamble = [_trimmed(rows.fields(r)) for r in range(begin, top) if not rows.blank[r]]
    units = units or _listed_units(preamble, names)
    alone = [f[0] for f in preamble[-1:] if len([x for x in f if x]) == 1 and f[0]]
    title = alone[0] if alone and not set(alone[0]) & set(":=") else ""
    held = [each for r in range(top + 1, first) for each in _numbers(names, rows.fields(r))]
    own = len(_trimmed(rows.fields(first)))
    if held and {name for name in names[own:] if name} <= dict(held).keys():
        names = names[:own]  # what stands beyond is of the file, and has no samples
    return Layout(names, units, header, first, last, title[:80], (*_notes(preamble), *held))


def _names(rows: Rows, begin: int, header: int, first: int) -> tuple[str, ...]:
    """Return a header's names, for those that it leaves empty what stands above or the place.

    Cells that are merged over two rows leave the lower one empty.
    """
    names = [field.strip() for field in rows.fields(header)]
    samples = rows.fields(first)
    near = header - 1
    above = rows.fields(near) if near >= begin and not rows.blank[near] else []
    if any(is_number(field) for field in above if field):
        above = []  # values of the preamble
    for i, name in enumerate(names):
        if name or i >= len(samples) or not samples[i]:
            continue
        text = above[i].strip() if i < len(above) else ""
        names[i] = text if text and text not in names else f"column {i + 1}"
    return tuple(names)


def _listed_units(preamble: Sequence[Sequence[str]], names: Sequence[str]) -> dict[int, str]:
    """Return the units of a row of the preamble that says to hold them, a field a column."""
    for fields in preamble:
        named = bool(fields) and _UNIT_ROW.search(fields[0]) is not None
        if named and len(fields) == len(names) and all(map(is_unit, fields[1:])):
            return {i: f for i, f in enumerate(fields) if i}
    return {}


def _numbers(names: Sequence[str], fields: Sequence[str]) -> Iterator[tuple[str, str]]:
    """Yield the numbers that stand below names beside the units, as an increment of time."""
    return ((name, f) for name, f in zip(names, fields, strict=False) if name and is_number(f))


def _notes(preamble: Sequence[Sequence[str]]) -> Iterator[tuple[str, str]]:
    for fields in preamble:
        named = [f for f in fields if f]
        if len(named) > 1:
            yield named[0], named[1]
            yield named[0], " ".join(named[1:3])
        joined = " ".join(named)
        for mark in ":=":
            name, found, value = joined.partition(mark)
            if found:
                yield name, value.strip()


def above_text(place: str, text: str) -> str:
    """Return what to tell of a row that stands above the samples, as wide as they are.

    Examples
    --------
    >>> above_text("line 1", "500 2.5")
    "line 1 is left out: '500 2.5' is no sample, as the time begins below it"
    """
    return f"{place} is left out: {shown(text[:_SHOWN])} is no sample, as the time begins below it"


def empty_text(place: str, text: str) -> str:
    """Return what to tell of a row below the header that is as wide as a sample and holds none.

    Examples
    --------
    >>> empty_text("line 2", "-----,-----")
    "line 2 is left out: '-----,-----' holds no number"
    """
    return f"{place} is left out: {shown(text.strip()[:_SHOWN])} holds no number"

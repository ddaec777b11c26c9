"""A record's file, opened: the tables that it holds, and their columns by header."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from models.checks import Array, InputError

LONG = 2**22
"""Samples, above which a record may be read in pieces."""
PIECE = 2**17
"""Samples of a piece."""
MOST_VALUES = 2**27
"""Of one file: more than memory holds is damage or ill will."""


def row_place(row: int) -> str:
    """Return a row's place in a file without lines.

    Examples
    --------
    >>> row_place(0)
    'row 1'
    """
    return f"row {row + 1}"


@dataclass(frozen=True)
class Source:
    """A table whose columns are read when they are asked for."""

    name: str
    """File as in ``campaign.toml``, with the part where it is one of several."""
    headers: tuple[str, ...]
    """As in the file, stripped."""
    read: Callable[[Sequence[int]], list[Array]]
    """Columns by their index among the headers, each (N,) float64, NaN where empty."""
    place: Callable[[int], str] = row_place
    """Where a row is, in words: "line 12" of a text file, "row 11" of others."""
    part: str = ""
    """Name of the sheet, group or table inside the file; "" for the whole file."""
    units: Mapping[int, str] = field(default_factory=dict)
    """Units by header that the file states elsewhere than in the header."""
    roles: Mapping[str, int] = field(default_factory=dict)
    """Headers by quantity where the format itself tells what they are, as a waveform's time."""
    step: float | None = None
    """s, the sampling interval that the file states; None where it states none."""
    start: float = 0.0
    """s, the time of the first sample that goes with `step`."""
    rows: int | None = None
    """N, where the file tells it before its columns are read; else None."""
    pieces: Callable[[Sequence[int]], Iterator[list[Array]]] | None = None
    """The same columns as `read`, a piece (B,) of each at a time; None where a file has to be read
    whole."""
    cell: Callable[[int, int], str] | None = None
    """A row's field of a column as it stands in the file; None where values are numbers anyway."""
    expected: Mapping[int, str] = field(default_factory=dict)
    """How a column's numbers are written, by its index, where that is not plain."""
    notes: Mapping[int, str] = field(default_factory=dict)
    """What to tell of a column where it is read, by its index among the headers."""
    told: tuple[str, ...] = ()
    """What to tell of the table."""
    times: Callable[[int, slice], Array | None] | None = None
    """Times of some of a column's own samples, s, None where they are not known; no function where
    the format has none beside a channel."""


@dataclass(frozen=True)
class Book:
    """A file's tables."""

    name: str
    """File as in ``campaign.toml``."""
    parts: tuple[Source, ...]
    """At least one, in the file's order."""
    key: str = "group"
    """What `[[records]]` calls a part: "sheet" of a workbook, else "group"."""
    whole: Source | None = None
    """All columns of a file whose groups are parts of one tree; None where tables are apart."""
    cells: Callable[[str, str], Source] | None = None
    """The table in a part's range of cells, of a workbook."""
    stacks: dict[tuple[str, str, bool], list[Source]] = field(default_factory=dict)
    """Tests that stand below each other in its tables, kept once they were looked for."""


def some_times(source: Source, first: int, last: int) -> Callable[[int, slice], Array | None]:
    """Return what `Source.times` of some of its rows is."""

    def times(index: int, part: slice) -> Array | None:
        rows = range(first, last)[part]
        return None if source.times is None else source.times(index, slice(rows.start, rows.stop))

    return times


def single(source: Source) -> Book:
    """Return the book of a file that holds one table."""
    return Book(source.name, (source,))


@dataclass(frozen=True)
class LongVector:
    """A column that stays in its file; numpy makes an array of it."""

    size: int
    """N."""
    part: Callable[[slice], np.ndarray[Any, Any]]
    """Reads some of its values."""

    def __getitem__(self, part: slice) -> np.ndarray[Any, Any]:
        """Return some of its values."""
        return self.part(part)

    def __array__(self, dtype: Any = None, copy: Any = None) -> np.ndarray[Any, Any]:
        """Return all of its values, for numpy."""
        return np.asarray(self.part(slice(None)), dtype=dtype)


def column_pieces(
    name: str, headers: Sequence[str], columns: Sequence[Any]
) -> Callable[[Sequence[int]], Iterator[list[Array]]]:
    """Return what reads pieces of columns that can be cut, and refuses those of unequal lengths."""

    def pieces(indices: Sequence[int]) -> Iterator[list[Array]]:
        chosen = [columns[i] for i in indices]
        check_lengths(name, headers, indices, [c.size for c in chosen])
        for first in range(0, chosen[0].size, PIECE):
            part = slice(first, min(first + PIECE, chosen[0].size))
            yield [np.array(c[part], dtype=np.float64) for c in chosen]

    return pieces


def check_lengths(
    name: str, headers: Sequence[str], indices: Sequence[int], sizes: Sequence[int]
) -> None:
    """Raise `InputError` where a column is not of the first one's length."""
    for index, size in zip(indices, sizes, strict=True):
        if size != sizes[0]:
            raise InputError(
                headers[index],
                expected=f"of the length of {headers[indices[0]]} ({sizes[0]})",
                found=f"{size}; save channels of several rates at one rate",
                where=name,
            )


def column_reader(
    name: str, headers: Sequence[str], columns: Sequence[Array]
) -> Callable[[Sequence[int]], list[Array]]:
    """Return what reads columns that are in memory, and refuses those of unequal lengths."""

    def read(indices: Sequence[int]) -> list[Array]:
        result = [np.array(columns[i], dtype=np.float64) for i in indices]
        check_lengths(name, headers, indices, [column.size for column in result])
        return result

    return read

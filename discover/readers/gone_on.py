"""Tables of a text that are one: blocks below a header that is written again."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from discover.readers.columns import split_header, stated_unit
from discover.readers.names import name_score
from discover.readers.source import Source
from discover.readers.units import measures
from models.checks import Array, InputError

_UNEVEN = 1.5  # times the usual step, up to which time goes on


def gone_on(tables: Sequence[Source], name: str) -> tuple[Source, ...]:
    """Return the tables of a text, with those joined that have one header and go on in time.

    Parameters
    ----------
    tables : sequence of Source
        In the file's order.
    name : str
        File.

    Examples
    --------
    >>> def table(first):
    ...     t = first + np.arange(5) / 10.0
    ...     return Source("a.csv [1]", ("time", "force"), lambda ids: [t for _ in ids], part="1")
    >>> [s.read([0])[0].size for s in gone_on([table(0.0), table(0.5), table(9.0)], "a.csv")]
    [10, 5]
    """
    groups: list[list[Source]] = []
    before: Array | None = None
    for table in tables:
        times = _times(table)
        if groups and _follows(groups[-1][-1], before, table, times):
            groups[-1].append(table)
        else:
            groups.append([table])
        before = times
    alone = len(groups) == 1
    return tuple(_joined(group, name if alone else "") for group in groups)


def _times(table: Source) -> Array | None:
    """Return the times of a table, or None where no column is called that."""
    for index, header in enumerate(table.headers):
        if name_score(split_header(header)[0], "time") > 0.0 and measures(
            stated_unit(table, index) or "s", "time"
        ):
            try:
                return table.read([index])[0]
            except InputError:  # which reading it tells with its place
                return None
    return None


def _follows(first: Source, before: Array | None, second: Source, times: Array | None) -> bool:
    """Return whether a table has the columns of the one before and begins a step after it."""
    same = first.headers == second.headers and first.units == second.units
    if not same or before is None or times is None or before.size < 2 or not times.size:
        return False
    usual = float(np.nanmedian(np.diff(before)))
    return bool(0.0 < times[0] - before[-1] < _UNEVEN * usual)


def _joined(group: Sequence[Source], name: str) -> Source:
    """Return tables below each other as one, called `name` where it is all of the file."""
    first = group[0]
    if len(group) == 1:
        return first
    ends = np.cumsum([table.read([0])[0].size for table in group])

    def at(row: int) -> tuple[Source, int]:
        which = int(np.searchsorted(ends, row, side="right"))
        return group[which], row - (int(ends[which - 1]) if which else 0)

    def cell(row: int, index: int) -> str:
        table, inside = at(row)
        return table.cell(inside, index) if table.cell else ""

    def place(row: int) -> str:
        table, inside = at(row)
        return table.place(inside)

    def read(indices: Sequence[int]) -> list[Array]:
        parts = [table.read(indices) for table in group]
        return [np.concatenate(columns) for columns in zip(*parts, strict=True)]

    told = [text for table in group for text in table.told]
    told.append(f"{len(group)} tables below one header go on in time and are read as one")
    notes = {index: text for table in group[::-1] for index, text in table.notes.items()}
    return replace(
        first, name=name or first.name, part="" if name else first.part, read=read, place=place,
        cell=cell, notes=notes, told=tuple(told),
    )  # fmt: skip

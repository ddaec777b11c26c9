"""Tests that stand below each other in one table: where each begins, and what it is called."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np

from discover.readers.columns import find_column, is_place, split_header
from discover.readers.sampling import FEWEST_SAMPLES
from discover.readers.source import Source, some_times
from models.checks import Array, InputError

_TEST = re.compile(
    r"(test|run|trial|experiment|series|specimen|sample|versuch|messung|lauf|probe|essai)"
    r"[\s_]*(id|no|nr|num|number|nummer|count|index)?[.#]?",
    re.IGNORECASE,
)
_PIECE = re.compile(
    r"(total|elapsed)?[\s_]*(block|cycle|zyklus|segment|step|schritt|set|part|phase)s?"
    r"[\s_]*(id|no|nr|num|number|nummer|count|index)?[.#]?",
    re.IGNORECASE,
)
_Read = Callable[[Sequence[int]], list[Array]]
_UNEVEN = 1.5  # times the usual step, up to which time goes on


def stacked(source: Source, names: Mapping[str, str], *, timed: bool = False) -> list[Source]:
    """Return the tests that a table holds below each other; none where it holds one test.

    A test begins where the time begins again, or where a column that counts tests, blocks or
    cycles changes and the time does not go on. It is called by that column, as ``test 3``, where
    that has one value in each of them, else ``test 1`` and so on.

    Parameters
    ----------
    source : Source
        A table.
    names : mapping
        Headers by quantity, of which that of the time is used.
    timed : bool
        Whether a sampling rate stands for the times.

    Examples
    --------
    >>> t = np.tile(np.arange(20) / 100.0, 2)
    >>> columns = [t, np.repeat([7.0, 8.0], 20)]
    >>> table = Source("a.csv", ("time", "Run"), lambda ids: [columns[i] for i in ids])
    >>> [(test.part, test.read([0])[0].size) for test in stacked(table, {})]
    [('Run 7', 20), ('Run 8', 20)]
    """
    try:
        time = None if timed else find_column(source, "time", names.get("time", "time"))
        timed = timed or source.step is not None
        return stacked_by(source, time) if timed or time is not None else []
    except InputError:
        return []


def stacked_by(source: Source, time: int | None) -> list[Source]:
    """Return what `stacked` does, by the column of the time; None where times are made.

    Raises
    ------
    InputError
        Where that column can't be read.
    """
    source = replace(source, read=_kept(source.read))
    times = None if time is None else source.read([time])[0]
    counts = _counts(source, time)
    begins = _begins(times, counts)
    size = next((column.size for column in (times, *counts.values()) if column is not None), 0)
    ends = [0, *begins, size]
    if len(ends) == 2 or min(np.diff(ends)) < FEWEST_SAMPLES:
        return []
    labels = _labels(source, counts, ends)
    return [
        _rows(source, first, last, label)
        for (first, last), label in zip(pairwise(ends), labels, strict=True)
    ]


def stacked_time(source: Source) -> int | None:
    """Return which of columns without names rises evenly but for where it begins again, or None."""
    found: list[int] = []
    if not all(is_place(header) for header in source.headers):
        return None
    for index in range(len(source.headers)):
        try:
            (column,) = source.read([index])
        except InputError:
            continue
        ends = [0, *_again(column), column.size]
        steps = [np.diff(column[first:last]) for first, last in pairwise(ends)]
        if len(ends) > 2 and all(s.size and _even(s) for s in steps):
            found.append(index)
    return found[0] if len(found) == 1 else None


def _kept(read: _Read) -> _Read:
    """Return what reads each column once, since every test has a part of it."""
    columns: dict[int, Array] = {}

    def reading(indices: Sequence[int]) -> list[Array]:
        new = [index for index in indices if index not in columns]
        if new:
            known = list(columns)[:1]  # beside which a column of another length is refused
            columns.update(zip(new, read([*known, *new])[len(known) :], strict=True))
        return [columns[index] for index in indices]

    return reading


def _even(steps: Array) -> bool:
    return bool(steps.min() > 0.0 and steps.max() < 2.0 * _UNEVEN * np.median(steps))


def _counts(source: Source, time: int | None) -> dict[int, Array]:
    """Return the columns that count tests or parts of them, those of tests first."""
    names = [split_header(header)[0] for header in source.headers]
    found: dict[int, Array] = {}
    for pattern in (_TEST, _PIECE) if time is not None else (_TEST,):
        for index, name in enumerate(names):
            if index == time or not pattern.fullmatch(name.strip()):
                continue
            try:
                (column,) = source.read([index])
            except InputError:
                continue
            runs = np.diff(np.flatnonzero(np.diff(column, prepend=np.nan, append=np.nan)))
            if np.isfinite(column).all() and runs.min() >= FEWEST_SAMPLES:  # else it counts samples
                found[index] = column
    return found


def _again(times: Array) -> list[int]:
    """Return the rows where time falls back by more than half of what the test has lasted."""
    found, first = [], 0
    for row in (np.flatnonzero(np.diff(times) < 0.0) + 1).tolist():
        if times[row] < 0.5 * (times[first] + times[row - 1]):
            found.append(row)
            first = row
    return found


def _begins(times: Array | None, counts: Mapping[int, Array]) -> list[int]:
    """Return the rows where another test begins."""
    changes = {int(row) + 1 for c in counts.values() for row in np.flatnonzero(np.diff(c))}
    if times is None or times.size < 2:
        return sorted(changes)
    steps = np.diff(times)
    usual = float(np.median(steps))
    apart = {row for row in changes if not 0.0 < steps[row - 1] < _UNEVEN * usual}
    return sorted({*_again(times), *apart})


def _labels(source: Source, counts: Mapping[int, Array], ends: Sequence[int]) -> list[str]:
    """Return what the tests are called."""
    for index, column in counts.items():
        values = [np.unique(column[first:last]) for first, last in pairwise(ends)]
        if all(v.size == 1 for v in values) and np.unique(values).size == len(values):
            name = split_header(source.headers[index])[0]
            return [f"{name} {v[0]:.9g}" for v in values]
    return [f"test {number}" for number in range(1, len(ends))]


def _rows(source: Source, first: int, last: int, label: str) -> Source:
    """Return some rows of a table as one of its own."""
    part = f"{source.part} {label}" if source.part else label
    cell = source.cell
    return replace(
        source,
        name=f"{source.name.removesuffix(f' [{source.part}]')} [{part}]",
        read=lambda indices: [column[first:last].copy() for column in source.read(indices)],
        place=lambda row: source.place(row + first),
        cell=None if cell is None else lambda row, index: cell(row + first, index),
        part=part, rows=None, pieces=None,
        times=source.times and some_times(source, first, last),
    )  # fmt: skip

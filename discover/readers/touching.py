"""Columns of fixed width that touch each other, as ``-12.345-67.891``."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Sequence

from models.checks import InputError, shown

# A sign after decimals begins the next number; a date has no decimals before its dashes.
_TOUCHING = re.compile(rb"\.\d*(?:[eE][+-]\d\d\d?)?(?:[+-]\d*\.\d|\d\.)")
_PLAIN = re.compile(rb"[\d+\-.eE ]*\.[\d+\-.eE ]*")
_DATE = re.compile(rb"\d\d?\.\d\d?\.\d{4}")
_NUMBER = re.compile(rb"[+-]?(?:\d+\.\d*|\.\d+|\d+)(?:[eE][+-]\d\d\d?)?")
_SAMPLE = 2**16  # bytes in which it shows
_SHOWN = 60  # characters of a line
_FEWEST = 3  # rows below each other that are a table


def parted(data: bytes, name: str) -> bytes:
    r"""Return a text whose columns of fixed width do not touch: with a blank between them.

    Numbers end at the same places in every row of such a table, which the rows in which they do
    not touch, or begin with a sign, show.

    Parameters
    ----------
    data : bytes
        With one kind of line end.
    name : str
        File, for messages.

    Raises
    ------
    InputError
        Where numbers touch and do not end at the same places in all rows.

    Examples
    --------
    >>> parted(b"t x F\n  0.5 -1.5 10.2\n  1.0-11.5-10.2\n  1.5 11.5110.2\n", "a.dat")
    b't x F\n  0.5 -1.5 10.2\n  1.0 -11.5 -10.2\n  1.5  11.5 110.2\n'
    """
    last = data[:_SAMPLE].rstrip(b"\n").rsplit(b"\n", 2)[-2:]  # the very last may be cut
    if any(mark in line for line in last for mark in b",;\t") or not _TOUCHING.search(data):
        return data
    lines = data.split(b"\n")
    rows = _table_rows(lines)
    touching = [i for i in rows if any(map(_touches, lines[i].split()))]
    if not touching:
        return data
    ends = _ends([lines[i] for i in rows])
    if ends is None:
        row = touching[0]
        text = lines[row].decode("latin-1").strip()[:_SHOWN]
        raise InputError(
            "columns", expected="parted by a mark or a blank, or as wide in every row",
            found=f"{shown(text)}, in which numbers touch, while their ends differ from row to row",
            where=f"{name} line {row + 1}",
        )  # fmt: skip
    for i in rows:
        lines[i] = b" ".join(_cut(lines[i], ends))
    return b"\n".join(lines)


def _touches(word: bytes) -> bool:
    return _TOUCHING.search(word) is not None and _DATE.fullmatch(word) is None


def _table_rows(lines: Sequence[bytes]) -> list[int]:
    """Return the lines of numbers that have others above or below them."""
    runs: list[list[int]] = [[]]
    for i, line in enumerate(lines):
        if not _PLAIN.fullmatch(line):
            runs.append([])
        else:
            runs[-1].append(i)
    return [i for run in runs if len(run) >= _FEWEST for i in run]


def _cut(line: bytes, ends: Sequence[int]) -> list[bytes]:
    return [line[first:last] for first, last in zip((0, *ends[:-1]), ends, strict=True)]


def _ends(rows: Sequence[bytes]) -> tuple[int, ...] | None:
    """Return the places at which the numbers of all rows end, or None where there are none."""
    found = Counter(tuple(m.end() for m in _NUMBER.finditer(row)) for row in rows)
    ends = found.most_common(1)[0][0]
    whole = all(
        len(row.rstrip()) == ends[-1]
        and all(_NUMBER.fullmatch(field.strip()) for field in _cut(row, ends))
        for row in rows
    )
    return ends if whole and len(ends) > 1 else None

"""Logs whose lines name each value, as ``t:0.10 F:12.3 x:4.5`` of a microcontroller."""

from __future__ import annotations

import re
from collections import Counter

import numpy as np

from discover.readers.cut_row import cut_text
from discover.readers.numerals import clock_seconds, is_number, value
from discover.readers.source import Source, column_reader
from discover.readers.units import is_unit
from models.checks import InputError, shown

_NUMBER = r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?"
_UNIT = r"(?:[^\W\d]|°)[\w/^%]*"
_VALUE = re.compile(
    rf"([^\W\d][\w ]{{0,30}}?) ?[:=] ?({_NUMBER})(?: ?({_UNIT})(?! ?[:=\w]))?(?=[\s,;|]|$)"
)
_PARTS = " \t,;|->"  # between values
_TRIED = 60  # lines that show the labels
_FEWEST = 16  # lines
_SHOWN = 60  # characters of a line


def labelled_lines(data: bytes, name: str) -> Source | None:
    r"""Return the table of a log whose lines name each value; None of any other text.

    Two labels or more are the same in nearly all lines; a number or a clock's time may stand
    before them. What comes above the first such line is a preamble.

    Parameters
    ----------
    data : bytes
        In UTF-8, with one kind of line end.
    name : str
        File, for messages.

    Raises
    ------
    InputError
        For a line between the others that has not their labels.

    Examples
    --------
    >>> log = b"boot\n" + b"".join(b"t:%d F: 2.5 N\n" % i for i in range(20))
    >>> table = labelled_lines(log, "a.txt")
    >>> table.headers, table.units, table.read([1])[0][0]
    (('t', 'F'), {1: 'N'}, np.float64(2.5))
    """
    head = data[: 2**16].decode("utf-8", "replace").split("\n")[:-1] or [""]
    found = Counter(_labels(line) for line in head[-_TRIED:] if line.strip())
    labels, count = found.most_common(1)[0] if found else ((), 0)
    if len(labels) < 2 or count < max(_FEWEST, 0.8 * found.total()):
        return None
    lines = [
        (i, text) for i, text in enumerate(data.decode("utf-8", "replace").split("\n"), 1)
        if text.strip()
    ]  # fmt: skip
    first = next(k for k, (_, text) in enumerate(lines) if _labels(text) == labels)
    rows = lines[first:]
    cut = [rows.pop()] if _labels(rows[-1][1]) != labels else []
    for at, text in rows:
        if _labels(text) != labels:
            raise InputError(
                "line", expected=f"with {', '.join(filter(None, labels))} as the others",
                found=shown(text.strip()[:_SHOWN]), where=f"{name} line {at}",
            )  # fmt: skip
    fields = [_fields(text) for _, text in rows]
    columns = [np.array([value(row[i], ".") for row in fields]) for i in range(len(labels))]
    headers = tuple(label or "column 1" for label in labels)
    units = {i: u for i, u in enumerate(_units(rows[0][1], len(labels))) if is_unit(u)}
    if not labels[0] and clock_seconds(fields[0][0]) is not None:
        units[0] = "s"
    return Source(
        name, headers, column_reader(name, headers, columns), lambda row: f"line {rows[row][0]}",
        units=units, told=tuple(cut_text(*each) for each in cut),
    )  # fmt: skip


def _leading(line: str) -> str:
    """Return the number or the time that stands before the labels, "" for none."""
    match = _VALUE.search(line)
    before = line[: match.start()].strip(_PARTS) if match else ""
    return before if before and is_number(before) else ""


def _values(line: str) -> list[tuple[str, str, str]]:
    """Return the label, the number and the unit of each value of a line.

    A unit stands before the next label too, as N in ``F: 2.5 N x: 0.1 mm``.
    """
    found: list[tuple[str, str, str]] = []
    for match in _VALUE.finditer(line):
        label = match[1].strip()
        word, _, rest = label.partition(" ")
        if rest and found and not found[-1][2] and is_unit(word):
            found[-1], label = (*found[-1][:2], word), rest.strip()
        found.append((label, match[2], match[3] or ""))
    return found


def _labels(line: str) -> tuple[str, ...]:
    """Return the labels of a line, "" for a number before them; none where it holds more."""
    labels = [label for label, *_ in _values(line)]
    before = _leading(line)
    rest = _VALUE.sub("", line).replace(before, "", 1)
    if len(labels) < 2 or len(set(labels)) < len(labels) or rest.strip(_PARTS + "\r"):
        return ()
    return ("", *labels) if before else tuple(labels)


def _fields(line: str) -> list[str]:
    """Return the numbers of a line."""
    before = _leading(line)
    return [*([before] if before else []), *(number for _, number, _ in _values(line))]


def _units(line: str, count: int) -> list[str]:
    """Return the units of a line's values, "" for none."""
    own = [unit for *_, unit in _values(line)]
    return [""] * (count - len(own)) + own

"""A text's lines, and what parts their fields."""

from __future__ import annotations

import contextlib
import csv
import io
import re
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from discover.readers.numerals import EMPTY, is_number

SPACES = " "
"""Stands for any run of blanks between columns."""
MARKS = (b"#", b"%", b"//", b"'")
"""What a comment begins with."""

_DELIMITERS = ("\t", ";", ",", SPACES)
_TRIED = 60  # lines that show what separates columns
_BRACKETS = re.compile(r"\[[^\[\]]*\]|\([^()]*\)|\"[^\"]*\"")


@dataclass(frozen=True)
class Text:
    """A file's lines."""

    data: bytes
    """With one kind of line end."""
    starts: np.ndarray
    """(N + 1,) where lines begin, then the end."""
    delimiter: str
    """Between columns."""

    def line(self, row: int) -> str:
        """Return a line's text."""
        return decoded(self.data[self.starts[row] : self.starts[row + 1]]).rstrip("\n")

    def fields(self, row: int) -> list[str]:
        """Return a line's fields, of a comment without its mark."""
        text = self.line(row)
        mark = next((m.decode() for m in MARKS if text.lstrip().encode().startswith(m)), "")
        if mark:
            text = text.lstrip().removeprefix(mark).strip()
        return split_line(text, self.delimiter)


def decoded(raw: bytes) -> str:
    """Return text in UTF-8, or else in Latin-1."""
    try:
        return raw.decode("utf-8")
    except UnicodeDecodeError:
        return raw.decode("latin-1")


def find_delimiter(text: Text, rows: np.ndarray, *, numbers: bool) -> str:
    """Return what splits lines of numbers, or else any lines, into equally many fields."""
    some = np.linspace(0, rows.size - 1, min(rows.size, _TRIED)).astype(int)
    lines = [text.line(int(row)) for row in rows[some]]
    if not numbers:
        lines = [_BRACKETS.sub("", line) for line in lines]
    for delimiter in _DELIMITERS if numbers else _DELIMITERS[:3]:
        split = [split_line(line, delimiter) for line in lines]
        widths = [len(fields) for fields in split]
        usual = max(set(widths), key=widths.count, default=0)
        same = [f for f in split if len(f) == usual]
        if usual < 2 or (numbers and len(same) < 0.8 * len(split)):
            continue
        if not numbers or sum(all(map(_is_cell, fields)) for fields in same) >= 0.8 * len(same):
            return delimiter
    return ","


def _is_cell(field: str) -> bool:
    return is_number(field) or field.lower() in EMPTY


def split_line(line: str, delimiter: str) -> list[str]:
    """Return a line's fields."""
    if delimiter == SPACES:
        return _split_blanks(line)
    if '"' not in line:
        return [field.strip() for field in line.split(delimiter)]
    try:
        return [field.strip() for field in next(csv.reader([line], delimiter=delimiter), [])]
    except csv.Error:  # a field beyond what the module takes
        return [field.strip() for field in line.split(delimiter)]


def split_all(body: memoryview, delimiter: str) -> Iterator[list[str]]:
    """Return the fields of all lines, comments too."""
    lines = io.StringIO(decoded(bytes(body)))
    if delimiter == SPACES:
        yield from (line.split() for line in lines)
        return
    with contextlib.suppress(csv.Error):  # which reading, line by line, tells with its place
        yield from csv.reader(lines, delimiter=delimiter)


def _split_blanks(line: str) -> list[str]:
    """Return fields between blanks, a unit in brackets with the name before it."""
    fields: list[str] = []
    for word in line.split():
        last = fields[-1] if fields else ""
        inside = last.count("[") + last.count("(") > last.count("]") + last.count(")")
        named = last and last[0] not in "[("  # else it is a unit of a row of units
        if inside or (named and word[0] in "[("):
            fields[-1] += f" {word}"
        else:
            fields.append(word)
    return fields

"""Excel workbooks as sources of columns (openpyxl through pandas)."""

from __future__ import annotations

import datetime
import io
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from discover.readers.content import check_unpacked, content_error, optional_package
from discover.readers.file_format import FileFormat
from discover.readers.layout import Layout, Rows, above_text, find_tables
from discover.readers.notation import Notation, check_told, notations, thousands_note
from discover.readers.numerals import clock_seconds, value
from discover.readers.sampling_note import stated_step
from discover.readers.source import Book, Source
from models.checks import Array, InputError, shown

_CELLS = re.compile(r"([A-Z]{1,3})([1-9]\d{0,6}):([A-Z]{1,3})([1-9]\d{0,6})")


def open_excel(data: bytes, name: str) -> Book:
    """Open a workbook: every table of every sheet, formulas by the values that were saved.

    Raises
    ------
    InputError
        Where it is no workbook, holds no table, or openpyxl is missing.
    """
    import pandas as pd  # loaded here: few campaigns are workbooks

    optional_package("openpyxl", extra="xlsx", name=name)
    check_unpacked(data, "an Excel workbook", name)
    try:
        with pd.ExcelFile(io.BytesIO(data), engine="openpyxl") as book:
            sheets = pd.read_excel(book, sheet_name=None, header=None, dtype=object)
            hidden = {s.title for s in book.book.worksheets if s.sheet_state != "visible"}
    except Exception as error:  # the library lets errors of many kinds through
        raise content_error("an Excel workbook", error, name) from None
    cells = {str(sheet): frame.to_numpy(dtype=object) for sheet, frame in sheets.items()}
    parts = [s for sheet, values in cells.items() for s in _sources(name, sheet, values)]
    parts = [
        replace(s, told=(*s.told, f"the sheet {shown(sheet)} is hidden in the workbook"))
        if (sheet := _sheet_of(s.part, cells)) in hidden else s
        for s in parts
    ]  # fmt: skip
    if not parts:
        raise content_error("a table of samples", f"none in {len(sheets)} sheets", name)

    def cut(part: str, text: str) -> Source:
        span = cell_range(text)
        sheet = _sheet_of(part, cells)
        found = [] if span is None else _sources(name, sheet, cells[sheet][span])
        if len(found) != 1:
            raise InputError(
                "range", expected="the cells of one table with its header, as B4:E900",
                found=shown(text), where=f"{name} [{sheet}]",
            )  # fmt: skip
        return found[0]

    return Book(name, tuple(parts), key="sheet", cells=cut)


def _sheet_of(part: str, sheets: Iterable[str]) -> str:
    """Return the sheet that a table is of."""
    return next(s for s in sorted(sheets, key=len, reverse=True) if part.startswith(s))


def cell_range(text: str) -> tuple[slice, slice] | None:
    """Return the rows and columns of ``B4:E900``, or None where the text is no such range.

    Examples
    --------
    >>> cell_range("B4:C9")
    (slice(3, 9, None), slice(1, 3, None))
    """
    match = _CELLS.fullmatch(text.strip().upper())
    if match is None:
        return None
    left, top, right, bottom = match.groups()
    return slice(int(top) - 1, int(bottom)), slice(_column(left), _column(right) + 1)


def _column(letters: str) -> int:
    number = 0
    for letter in letters:
        number = 26 * number + ord(letter) - ord("A") + 1
    return number - 1


def _sources(name: str, sheet: str, cells: np.ndarray[Any, Any]) -> list[Source]:
    tables = find_tables(_rows(cells)) if cells.size else []
    sources = []
    for number, layout in enumerate(tables, start=1):
        part = sheet if number == 1 else f"{sheet} {layout.title or number}"
        sources.append(_source(cells, layout, f"{name} [{part}]", part))
    return sources


def _rows(cells: np.ndarray[Any, Any]) -> Rows:
    texts = [[_text(cell) for cell in row] for row in cells]
    numbers = [[isinstance(cell, int | float) for cell in row] for row in cells]
    filled = [[bool(field) for field in row] for row in texts]
    marked = [next((f for f in row if f), "").startswith(("#", "%", "//")) for row in texts]
    numeric = [
        any(f) and all(n for n, there in zip(row, f, strict=True) if there)
        for row, f in zip(numbers, filled, strict=True)
    ]
    return Rows(
        numeric=np.array(numeric, dtype=bool),
        blank=np.array([not any(row) for row in filled], dtype=bool),
        comment=np.array(marked, dtype=bool),
        fields=lambda row: [field.lstrip("#% /") for field in texts[row]],
    )


def _text(cell: Any) -> str:
    if cell is None or (isinstance(cell, float) and np.isnan(cell)):
        return ""
    if isinstance(cell, datetime.datetime):
        return str(cell.isoformat(" "))
    return str(cell).strip()


def _source(cells: np.ndarray[Any, Any], layout: Layout, name: str, part: str) -> Source:
    span = cells[layout.first : layout.last]
    above = [(row + 1, " ".join(map(_text, cells[row]))) for row in layout.above]
    kept = [i for i, row in enumerate(span) if any(_text(cell) for cell in row)]

    def place(row: int) -> str:
        return f"row {layout.first + kept[row] + 1}" if row < len(kept) else f"sample {row + 1}"

    written = _written(span[kept])

    def read(indices: Sequence[int]) -> list[Array]:
        own = {i: written.get(i, Notation(".")) for i in indices}
        for i, notation in own.items():
            check_told(notation, layout.headers[i], name)
        return [np.array([_number(span[row, i], own[i]) for row in kept]) for i in indices]

    return Source(
        name, layout.headers, read, place, part,
        cell=lambda row, index: _text(span[kept[row], index]),
        units={**layout.units, **{i: "s" for i, cell in enumerate(span[0]) if _is_clock(cell)}},
        step=stated_step(layout.notes),
        notes={i: thousands_note(layout.headers[i], n) for i, n in written.items()
               if n.thousands and i < len(layout.headers)},
        told=tuple(above_text(f"row {number}", text) for number, text in above),
    )  # fmt: skip


def _is_clock(cell: Any) -> bool:
    return not isinstance(cell, int | float) and clock_seconds(_text(cell)) is not None


def _written(cells: np.ndarray[Any, Any]) -> Mapping[int, Notation]:
    """Return how numbers are written in columns that hold them as text."""
    texts = [[cell if isinstance(cell, str) else "" for cell in row] for row in cells]
    return notations(texts) if any(map(any, texts)) else {}


def _number(cell: Any, written: Notation) -> float:
    """Return a cell's number, NaN for what is none."""
    if isinstance(cell, int | float):
        return float(cell)
    found = value(_text(cell), written.decimal, written.thousands)
    return float("nan") if found is None else found


FORMAT = FileFormat((".xlsx", ".xlsm"), open_excel)

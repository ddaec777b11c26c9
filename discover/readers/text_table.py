"""CSV, TSV and other text: fast where a table is regular, exact about line and column else."""

from __future__ import annotations

import io
import itertools
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace

import numpy as np
import pyarrow as pa
import pyarrow.csv as pa_csv

from discover.readers.arrow_values import doubles
from discover.readers.content import content_error
from discover.readers.cut_row import cut_text
from discover.readers.gone_on import gone_on
from discover.readers.labelled import labelled_lines
from discover.readers.layout import Layout, Rows, above_text, empty_text, find_tables
from discover.readers.line_kinds import line_kinds
from discover.readers.notation import (
    Notation,
    check_told,
    may_have_thousands,
    notations,
    thousands_note,
)
from discover.readers.numerals import (
    DAY,
    clock_seconds,
    past_midnight,
    value,
)
from discover.readers.sampling_note import stated_step
from discover.readers.source import Book, Source, single
from discover.readers.text_fields import (
    MARKS,
    SPACES,
    Text,
    find_delimiter,
    split_all,
)
from discover.readers.touching import parted
from discover.readers.typed_text import as_utf8, without_thousands
from models.checks import Array, InputError, shown

_LARGE = 16_000_000  # bytes from which threads pay
_FORTRAN = re.compile(rb"(\.\d{0,20})[Dd]([+-]\d\d)")  # the exponent of a double
_SAMPLE = 2**16  # bytes in which it shows


def open_text(data: bytes, name: str) -> Book:
    """Open text with columns: one table or several, each with what stands above it.

    Tab, semicolon, comma and blanks separate; except between commas a decimal comma is
    understood. Lines that begin with ``#``, ``%``, ``//`` or ``'`` are comments.

    Parameters
    ----------
    data : bytes
        The file.
    name : str
        File, for messages.

    Returns
    -------
    Book

    Raises
    ------
    InputError
        On an empty or binary file or one without a table, and, on reading, rows of the wrong
        length or fields that are not numbers, with their line.
    """
    data = as_utf8(data, name)
    labelled = labelled_lines(data, name)
    if labelled is not None:
        return single(labelled)
    data, told = without_thousands(data)
    text, rows, tables = laid_out(data, name)
    parts = []
    for number, layout in enumerate(tables, start=1):
        part = layout.title or f"table {number}" if len(tables) > 1 else ""
        parts.append(_source(text, rows, layout, f"{name} [{part}]" if part else name, part))
    step = stated_step(note for layout in tables for note in layout.notes)
    parts = [replace(_with_step(part, step), told=(*told, *part.told)) for part in parts]
    return Book(name, gone_on(parts, name))


def laid_out(data: bytes, name: str) -> tuple[Text, Rows, list[Layout]]:
    """Return a file's lines, what each is, and where its tables lie.

    Raises
    ------
    InputError
        On an empty or binary file or one without a table.
    """
    data = as_utf8(data, name)
    if not data or data.isspace():
        raise content_error("a header line and samples", "an empty file", name)
    if _FORTRAN.search(data[:_SAMPLE]):
        data = _FORTRAN.sub(rb"\1E\2", data)  # of which lengths and places stay as they are
    if b"\0" in data[:4096]:
        raise content_error("text", "binary data", name)
    data = parted(data, name)
    text, rows = _lines(data, name)
    return text, rows, find_tables(rows) or [_plain_layout(text, rows, name)]


def _with_step(source: Source, step: float | None) -> Source:
    if source.step is not None or step is None:
        return source
    return Source(**{**source.__dict__, "step": step})


def _lines(data: bytes, name: str) -> tuple[Text, Rows]:
    codes = np.frombuffer(data, dtype=np.uint8)
    ends = np.flatnonzero(codes == ord("\n")) + 1
    if not ends.size or ends[-1] != codes.size:
        ends = np.r_[ends, codes.size]
    starts = np.r_[0, ends]

    numeric, blank = line_kinds(data, starts)
    comment = np.zeros(numeric.size, dtype=bool)
    for row in np.flatnonzero(~numeric & ~blank):
        comment[row] = data[starts[row] : starts[row] + 200].lstrip().startswith(MARKS)
    filled = np.flatnonzero(~blank & ~comment)
    if not filled.size and not comment.any():
        raise content_error("a header line and samples", "an empty file", name)
    text = Text(data, starts, "")
    samples = np.flatnonzero(numeric)
    numbers = samples.size > 1
    delimiter = find_delimiter(text, samples if numbers else filled, numbers=numbers)
    text = Text(data, starts, delimiter)
    return text, Rows(numeric, blank, comment, text.fields, unended=not data.endswith(b"\n"))


def _plain_layout(text: Text, rows: Rows, name: str) -> Layout:
    """Return the layout of a file in which no table stands out: header first, samples below."""
    filled = np.flatnonzero(~rows.blank & ~rows.comment)
    if not filled.size:
        raise content_error("a header line and samples", "only comments", name)
    header = int(filled[0])
    headers = tuple(text.fields(header))
    if len(headers) < 2:
        raise InputError(
            "header",
            expected="names separated by comma, semicolon, tab or blanks, such as "
            "time [s],displacement [mm],force [kN]",
            found=shown(text.line(header)[:60]),
            where=name,
        )
    if filled.size == 1:
        raise content_error("a header line and samples", "only a header", name)
    return Layout(headers, {}, header, header + 1, rows.count, "", ())


def _source(text: Text, rows: Rows, layout: Layout, name: str, part: str) -> Source:
    body = memoryview(text.data)[text.starts[layout.first] : text.starts[layout.last]]
    headers, decimal = fields_of(text, layout)
    width = len(headers)
    written: Mapping[int, Notation] = {}
    if may_have_thousands(body, text.delimiter):
        written = notations(split_all(body, text.delimiter))

    def read(indices: Sequence[int]) -> list[Array]:
        own = [written.get(i, Notation(decimal)) for i in indices]
        for index, notation in zip(indices, own, strict=True):
            check_told(notation, headers[index], name)
        plain = {n.decimal for n in own} if not any(n.thousands for n in own) else ()
        if len(plain) == 1:
            fast = _read_fast(body, width, indices, text.delimiter, *plain)
            if fast is not None:
                return fast
        return _read_slow(text, rows, layout, headers, dict(zip(indices, own, strict=True)), name)

    def place(row: int) -> str:
        for count, at in enumerate(_samples(rows, layout)):
            if count == row:
                return f"line {at + 1}"
        return f"sample {row + 1}"

    def cell(row: int, index: int) -> str:
        at = next(itertools.islice(_samples(rows, layout), row, None))
        return text.fields(at)[index]

    return Source(
        name, headers, read, place, part, cell=cell,
        expected={i: _expected(n) for i, n in written.items()},
        units={**layout.units, **dict.fromkeys(_clocks(text, layout), "s")},
        step=stated_step(layout.notes),
        notes={i: thousands_note(headers[i], n) for i, n in written.items()
               if n.thousands and i < width},
        told=left_out_lines(text, layout),
    )  # fmt: skip


def left_out_lines(text: Text, layout: Layout) -> tuple[str, ...]:
    """Return what to tell of lines that are left out, though they look like samples."""
    above = [above_text(f"line {row + 1}", text.line(row)) for row in layout.above]
    cut = () if layout.cut is None else (cut_text(layout.cut + 1, text.line(layout.cut)),)
    between = range(layout.first if layout.header is None else layout.header + 1, layout.first)
    empty = [row for row in between if _is_empty(text.fields(row), len(layout.headers))]
    marked = [empty_text(f"line {row + 1}", text.line(row)) for row in empty]
    return (*above, *marked, *cut)


def _is_empty(fields: Sequence[str], width: int) -> bool:
    """Return whether a row is as wide as the samples, and each field only marks like dashes."""
    whole = len(fields) == width > 1 and all(fields)
    return whole and not any(c.isalnum() for field in fields for c in field)


def fields_of(text: Text, layout: Layout) -> tuple[tuple[str, ...], str]:
    """Return the header of every field of a table, and what parts its decimals."""
    first, last = text.starts[layout.first], text.starts[layout.last]
    some = text.data[first : min(last, first + 2000)]
    decimal = "," if text.delimiter != "," and b"," in some else "."
    beyond = text.fields(layout.first)[len(layout.headers) :]  # empty after a delimiter at the end
    return layout.headers + ("",) * (0 if any(beyond) else len(beyond)), decimal


def _samples(rows: Rows, layout: Layout) -> Iterator[int]:
    span = slice(layout.first, layout.last)
    return iter((np.flatnonzero(~(rows.blank[span] | rows.comment[span])) + layout.first).tolist())


def _read_fast(
    body: memoryview, width: int, indices: Sequence[int], delimiter: str, decimal: str
) -> list[Array] | None:
    """Return the columns by a library, or None where the table is not regular."""
    names = [f"c{i}" for i in range(width)]
    wanted = [names[i] for i in indices]
    if delimiter == SPACES:
        return _read_blanks(body, names, wanted, decimal)
    try:
        table = pa_csv.read_csv(
            pa.BufferReader(body),
            read_options=pa_csv.ReadOptions(column_names=names, use_threads=len(body) > _LARGE),
            parse_options=pa_csv.ParseOptions(delimiter=delimiter),
            convert_options=pa_csv.ConvertOptions(
                include_columns=wanted,
                column_types=dict.fromkeys(wanted, pa.float64()),
                decimal_point=decimal,
            ),
        )
    except (pa.ArrowException, OSError):
        return None
    return [doubles(table.column(key)) for key in wanted]


def _read_blanks(
    body: memoryview, names: list[str], wanted: list[str], decimal: str
) -> list[Array] | None:
    import pandas as pd  # loaded here: only tables parted by blanks need it

    try:
        table = pd.read_csv(
            io.BytesIO(body), sep=r"\s+", header=None, names=names, usecols=wanted, decimal=decimal,
            dtype=dict.fromkeys(wanted, np.float64), index_col=False, on_bad_lines="error",
        )  # fmt: skip
    except (ValueError, pd.errors.ParserError):
        return None
    if table.isna().to_numpy().any():  # a short line is filled up in silence
        return None
    return [table[key].to_numpy(copy=True) for key in wanted]


def _read_slow(
    text: Text,
    rows: Rows,
    layout: Layout,
    headers: tuple[str, ...],
    written: Mapping[int, Notation],
    name: str,
) -> list[Array]:
    """Return the columns line by line, NaN for what is no number, or say which line is wrong."""
    columns: list[list[float]] = [[] for _ in written]
    least = len(headers)
    while least and not headers[least - 1]:
        least -= 1
    for at in _samples(rows, layout):
        fields = text.fields(at)
        where = f"{name} line {at + 1}"
        if not least <= len(fields) <= len(headers):
            more = " (decimal commas need semicolons or tabs between columns)"
            raise InputError(
                "number of columns",
                expected=f"{least} as in the header",
                found=str(len(fields)) + (more if len(fields) > len(headers) else ""),
                where=where,
            )
        for column, (index, own) in zip(columns, written.items(), strict=True):
            found = value(fields[index], own.decimal, own.thousands)
            column.append(float("nan") if found is None else found)
    clocks = _clocks(text, layout)
    return [
        past_midnight(np.array(column)) if clocks.get(index, DAY) < DAY else np.array(column)
        for index, column in zip(written, columns, strict=True)
    ]


def _clocks(text: Text, layout: Layout) -> dict[int, float]:
    """Return the first time of each column that is a clock's, s."""
    found = ((i, clock_seconds(f)) for i, f in enumerate(text.fields(layout.first)))
    return {index: time for index, time in found if time is not None}


def _expected(notation: Notation) -> str:
    """Return how a column's numbers are written."""
    parted = f" and thousands by {notation.thousands!r}" if notation.thousands else ""
    return (
        f"a number with decimals parted by {notation.decimal!r}{parted}, as the rest shows; save"
        " the file again with one decimal mark and without thousands separators"
    )

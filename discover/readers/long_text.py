"""CSV and TSV that is too long to be held: its layout by its first lines, its columns in pieces."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.csv as pa_csv

from discover.readers.arrow_values import doubles
from discover.readers.content import content_error
from discover.readers.cut_row import BEFORE, cut_text, is_cut
from discover.readers.lvm import is_lvm, open_lvm
from discover.readers.sampling_note import stated_step
from discover.readers.source import LONG, Book, Source, single
from discover.readers.text_fields import SPACES, split_line
from discover.readers.text_table import fields_of, laid_out, left_out_lines, open_text
from models.checks import Array

_HEAD = 2**20  # bytes that show the layout
_LEAST = 2  # bytes of a line: a digit and its end
_TAIL = 2**16  # bytes that show the last line
_PIECE = 2**20  # bytes; some tens of them are read ahead
_WIDE_BOM = (b"\xff\xfe", b"\xfe\xff")


def open_long_text(path: Path, name: str) -> Book:
    """Open text with columns; of a long one that is regular, columns are read in pieces.

    Regular are lines of equally many fields between tabs, semicolons or commas, below one header,
    to the end of the file. Any other text is read whole, as by `open_text`.

    Raises
    ------
    InputError
        As of `open_text`; on reading pieces, for a line that is not regular.
    """
    with path.open("rb") as file:
        head = file.read(_HEAD)
    whole = open_lvm if is_lvm(head) else open_text
    if path.stat().st_size <= _LEAST * LONG:
        return whole(path.read_bytes(), name)
    lines = _lines(path)
    if lines <= LONG or whole is open_lvm or head[:2] in _WIDE_BOM or b"\n" not in head:
        return whole(path.read_bytes(), name)
    text, rows, tables = laid_out(head[: head.rindex(b"\n") + 1], name)
    layout = tables[0]
    regular = len(tables) == 1 and text.delimiter != SPACES and layout.last == rows.count
    if not (regular and layout.first):
        return whole(path.read_bytes(), name)
    headers, decimal = fields_of(text, layout)
    names = [f"c{i}" for i in range(len(headers))]
    end, cut = _end(path, text.delimiter, len(headers))
    told = left_out_lines(text, layout) + (() if cut is None else (cut_text(lines, cut),))

    def pieces(indices: Sequence[int]) -> Iterator[list[Array]]:
        wanted = [names[i] for i in indices]
        try:
            with _opened(path, end) as file, pa_csv.open_csv(
                file,
                read_options=pa_csv.ReadOptions(
                    column_names=names, skip_rows=layout.first, block_size=_PIECE, use_threads=False
                ),
                parse_options=pa_csv.ParseOptions(delimiter=text.delimiter),
                convert_options=pa_csv.ConvertOptions(
                    include_columns=wanted,
                    column_types=dict.fromkeys(wanted, pa.float64()),
                    decimal_point=decimal,
                ),
            ) as reader:
                for batch in reader:
                    yield [doubles(pa.chunked_array([batch.column(key)])) for key in wanted]
        except (pa.ArrowException, OSError) as error:
            expected = "one regular table, as so long a text is read in pieces"
            raise content_error(expected, error, name) from None

    def read(indices: Sequence[int]) -> list[Array]:
        return [np.concatenate(parts) for parts in zip(*pieces(indices), strict=True)]

    return single(
        Source(
            name, headers, read, lambda row: f"line {row + layout.first + 1}",
            units=layout.units, step=stated_step(layout.notes), pieces=pieces, told=told,
            rows=lines - layout.first - (cut is not None),
        )
    )  # fmt: skip


def _end(path: Path, delimiter: str, width: int) -> tuple[int, str | None]:
    """Return where the samples end, and the last line where it was not written to its end."""
    size = path.stat().st_size
    with path.open("rb") as file:
        file.seek(max(0, size - _TAIL))
        tail = file.read()
    body = tail.rstrip(b"\r\n")
    *before, last = (line.decode("latin-1").rstrip("\r") for line in body.split(b"\n")[1:])
    fields = [split_line(line, delimiter) for line in before[-BEFORE:]]
    whole = not is_cut(split_line(last, delimiter), fields, width, unended=tail == body)
    return (size, None) if whole else (size - len(tail) + body.rindex(b"\n") + 1, last)


def _opened(path: Path, end: int) -> Any:
    """Open a file up to a place; nothing of it is held."""
    if end == path.stat().st_size:
        return pa.OSFile(str(path))
    with pa.memory_map(str(path)) as mapped:
        return pa.BufferReader(mapped.read_buffer(end))


def _lines(path: Path) -> int:
    """Return the number of a file's lines, the last of which need not end."""
    count, last = 0, b"\n"
    with path.open("rb") as file:
        while data := file.read(_PIECE):
            count += data.count(b"\n")
            last = data[-1:]
    return count + int(last != b"\n")

"""CSV and TSV: fast where the file is regular, exact about line and column where it isn't."""

from __future__ import annotations

import csv
import io
import re
from collections.abc import Iterator, Sequence

import numpy as np
import pyarrow as pa
import pyarrow.csv as pa_csv

from discover.readers.source import Source
from models.checks import Array, InputError

_LINE_END = re.compile(rb"\r\n|\n|\r")
_LARGE = 16_000_000  # bytes from which threads pay
_EMPTY = ("", "nan", "na", "n/a", "null", "none", "-", "#n/a")


def open_text(data: bytes, name: str) -> Source:
    """Open delimited text with one header line.

    Comma, semicolon and tab separate; with the latter two a decimal comma is understood. Blank
    lines and lines that begin with ``#`` before the header are skipped, a byte order mark too.

    Parameters
    ----------
    data : bytes
        The file.
    name : str
        File, for messages.

    Returns
    -------
    Source

    Raises
    ------
    InputError
        On an empty or binary file, a header that is missing or repeats a name, and, on reading,
        rows of the wrong length or fields that are not numbers, with their line.
    """
    if data[:2] in (b"\xff\xfe", b"\xfe\xff"):
        data = _decode(data, "utf-16", name).encode()
    data = data.removeprefix(b"\xef\xbb\xbf")
    if not data.strip():
        raise _content_error("a header line and samples", "an empty file", name)
    if b"\0" in data[:4096]:
        raise _content_error("text", "binary data", name)
    line, number, start = _header_line(data, name)
    delimiter = _delimiter(line, name)
    headers = tuple(h.strip() for h in next(csv.reader([line], delimiter=delimiter)))
    _check_headers(headers, name, number)
    body = data[start:]
    if not body.strip():
        raise _content_error("a header line and samples", "only a header", name)
    decimal = "," if delimiter != "," and b"," in body[:2000] else "."

    def read(indices: Sequence[int]) -> list[Array]:
        fast = _read_fast(body, len(headers), indices, delimiter, decimal)
        if fast is not None:
            return fast
        return _read_slow(body, headers, indices, delimiter, decimal, name, number)

    def place(row: int) -> str:
        for count, (at, _) in enumerate(_rows(body, delimiter, number, name)):
            if count == row:
                return f"line {at}"
        return f"sample {row + 1}"

    return Source(name, headers, read, place)


def _content_error(expected: str, found: str, name: str) -> InputError:
    return InputError("content", expected=expected, found=found, where=name)


def _decode(data: bytes, encoding: str, name: str) -> str:
    try:
        return data.decode(encoding)
    except UnicodeDecodeError as error:
        raise _content_error(f"text in {encoding}", str(error.reason), name) from None


def _header_line(data: bytes, name: str) -> tuple[str, int, int]:
    """Return the header line, its number from 1, and where the next line begins."""
    start, number = 0, 0
    while start < len(data):
        end = _LINE_END.search(data, start)
        stop, after = (end.start(), end.end()) if end else (len(data), len(data))
        raw = data[start:stop]
        number += 1
        if raw.strip() and not raw.lstrip().startswith(b"#"):
            try:
                return raw.decode("utf-8"), number, after
            except UnicodeDecodeError:
                return raw.decode("latin-1"), number, after
        start = after
    raise _content_error("a header line and samples", "only comments", name)


def _delimiter(line: str, name: str) -> str:
    """Return what separates the header's names: tab before semicolon before comma."""
    plain = re.sub(r"\[[^\]]*\]|\([^)]*\)|\"[^\"]*\"", "", line)
    for delimiter in ("\t", ";", ","):
        if delimiter in plain:
            return delimiter
    raise InputError(
        "header",
        expected="names separated by comma, semicolon or tab, such as "
        "time [s],displacement [mm],force [kN]",
        found=repr(line[:60]),
        where=name,
    )


def _check_headers(headers: tuple[str, ...], name: str, number: int) -> None:
    where = f"{name} line {number}"
    if all(_is_number(h) for h in headers if h):
        raise InputError(
            "header",
            expected="names with units, such as time [s],displacement [mm],force [kN]",
            found=", ".join(headers)[:60],
            where=where,
        )
    seen: set[str] = set()
    for header in headers:
        if header and header in seen:
            raise InputError("header", expected="unique", found=f"{header!r} twice", where=where)
        seen.add(header)


def _is_number(text: str) -> bool:
    try:
        float(text.replace(",", "."))
    except ValueError:
        return False
    return True


def _read_fast(
    body: bytes, width: int, indices: Sequence[int], delimiter: str, decimal: str
) -> list[Array] | None:
    """Return the columns by pyarrow, or None where the file is not regular."""
    names = [f"c{i}" for i in range(width)]
    wanted = [names[i] for i in indices]
    try:
        table = pa_csv.read_csv(
            io.BytesIO(body),
            read_options=pa_csv.ReadOptions(column_names=names, use_threads=len(body) > _LARGE),
            parse_options=pa_csv.ParseOptions(delimiter=delimiter),
            convert_options=pa_csv.ConvertOptions(
                include_columns=wanted,
                column_types=dict.fromkeys(wanted, pa.float64()),
                decimal_point=decimal,
            ),
        )
    except pa.ArrowInvalid:
        return None
    return [np.array(table.column(key).to_numpy(), dtype=np.float64) for key in wanted]


def _rows(
    body: bytes, delimiter: str, header_number: int, name: str
) -> Iterator[tuple[int, list[str]]]:
    """Yield the line number and the fields of every line that isn't blank."""
    try:
        text = body.decode("utf-8")
    except UnicodeDecodeError:
        text = body.decode("latin-1")
    lines = io.StringIO(text, newline=None)
    reader = csv.reader(lines, delimiter=delimiter)
    try:
        for fields in reader:
            if len(fields) > 1 or (fields and fields[0].strip()):
                yield header_number + reader.line_num, fields
    except csv.Error as error:
        where = f"{name} line {header_number + reader.line_num}"
        raise InputError("row", expected="delimited text", found=str(error), where=where) from None


def _read_slow(
    body: bytes,
    headers: tuple[str, ...],
    indices: Sequence[int],
    delimiter: str,
    decimal: str,
    name: str,
    number: int,
) -> list[Array]:
    """Return the columns line by line, or say which line and column is wrong."""
    columns: list[list[float]] = [[] for _ in indices]
    for at, fields in _rows(body, delimiter, number, name):
        if len(fields) != len(headers):
            more = " (decimal commas need semicolons or tabs between columns)"
            raise InputError(
                "number of columns",
                expected=f"{len(headers)} as in the header",
                found=str(len(fields)) + (more if len(fields) > len(headers) else ""),
                where=f"{name} line {at}",
            )
        for column, index in zip(columns, indices, strict=True):
            column.append(_value(fields[index], headers[index], decimal, f"{name} line {at}"))
    return [np.array(column) for column in columns]


def _value(field: str, header: str, decimal: str, where: str) -> float:
    text = field.strip()
    if text.lower() in _EMPTY:
        return float("nan")
    try:
        return float(text.replace(decimal, "."))
    except ValueError:
        raise InputError(header, expected="a number", found=repr(text[:40]), where=where) from None

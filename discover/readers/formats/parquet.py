"""Parquet as a source of columns."""

from __future__ import annotations

import io
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.compute as compute
import pyarrow.parquet as parquet

from discover.readers.arrow_values import doubles
from discover.readers.content import content_error
from discover.readers.file_format import FileFormat
from discover.readers.source import PIECE, Book, Source, single
from models.checks import Array, InputError

_BUFFER = 2**20  # bytes of a column that are read ahead


def open_parquet(data: bytes | Path, name: str) -> Book:
    """Open a Parquet file; its column names are the headers.

    Of a path the columns are read when they are asked for, whole or in pieces. Time stamps are
    read as seconds since the first one, with the resolution that they have. A column's metadata
    may state its ``unit``.

    Raises
    ------
    InputError
        Where it is not Parquet, or, on reading, a column is not numeric.
    """
    try:
        with _opened(data) as file:
            schema, rows = file.schema_arrow, int(file.metadata.num_rows)
        headers = tuple(str(h).strip() for h in schema.names)
    except (pa.ArrowException, OSError) as error:
        raise content_error("a Parquet file", error, name) from None
    stated = {i: _unit(schema.field(i).metadata or {}) for i in range(len(headers))}
    units = {i: "s" if _is_time(schema.types[i]) else unit for i, unit in stated.items()}
    known = {i: unit for i, unit in units.items() if unit}
    zeros = _zeros(data, schema)

    def read(indices: Sequence[int]) -> list[Array]:
        names = [schema.names[i] for i in indices]
        try:
            with _opened(data) as file:
                table = file.read(columns=names)
        except (pa.ArrowException, OSError) as error:
            raise content_error("a whole Parquet file", error, name) from None
        places = [_position(i, schema.names, table.column_names) for i in indices]
        columns = [table.column(place) for place in places]
        return [
            _numbers(c, headers[i], name, zeros.get(i, _first(c)))
            for i, c in zip(indices, columns, strict=True)
        ]

    def pieces(indices: Sequence[int]) -> Iterator[list[Array]]:
        names = [schema.names[i] for i in indices]
        firsts = dict(zeros)
        try:
            with _opened(data) as file:
                for batch in file.iter_batches(PIECE, columns=names):
                    piece = pa.Table.from_batches([batch])
                    at = {i: _position(i, schema.names, piece.column_names) for i in indices}
                    columns = {i: piece.column(place) for i, place in at.items()}
                    for i, column in columns.items():
                        firsts.setdefault(i, _first(column))
                    yield [_numbers(c, headers[i], name, firsts[i]) for i, c in columns.items()]
        except (pa.ArrowException, OSError) as error:
            raise content_error("a whole Parquet file", error, name) from None

    return single(Source(name, headers, read, units=known, rows=rows, pieces=pieces))


def _unit(metadata: Mapping[bytes, bytes]) -> str:
    """Return the unit that a column's metadata states, "" where they state none."""
    named = {key.lower(): value for key, value in metadata.items()}
    found = named.get(b"unit") or named.get(b"units") or b""
    return found.decode("utf-8", "replace").strip()


def _zeros(data: bytes | Path, schema: Any) -> dict[int, int]:
    """Return the count from which time stamps are read where several columns have such.

    Columns of one kind begin with the first of them, so that times that began apart stay so.
    """
    stamps = [i for i, kind in enumerate(schema.types) if pa.types.is_timestamp(kind)]
    if len(stamps) < 2:
        return {}
    with _opened(data) as file:
        batch = next(file.iter_batches(1, columns=[schema.names[i] for i in stamps]), None)
    if batch is None:
        return {}
    row = pa.Table.from_batches([batch])
    found: dict[Any, int] = {}
    for i in stamps:
        column = row.column(_position(i, schema.names, row.column_names))
        found.setdefault(schema.types[i], _first(column))
    return {i: found[schema.types[i]] for i in stamps}


def _position(index: int, names: list[str], read: Sequence[str]) -> int:
    """Return where a column of the file is among those read, which may have its name too."""
    before = names[:index].count(names[index])
    return [place for place, own in enumerate(read) if own == names[index]][before]


def _opened(data: bytes | Path) -> parquet.ParquetFile:
    """Open a file that reads no more of a group of rows than is asked for."""
    where = data if isinstance(data, Path) else io.BytesIO(data)
    buffered = isinstance(data, Path)
    return parquet.ParquetFile(
        where, buffer_size=_BUFFER if buffered else 0, pre_buffer=not buffered
    )


def _is_time(kind: Any) -> bool:
    return bool(pa.types.is_timestamp(kind) or pa.types.is_duration(kind) or pa.types.is_time(kind))


def _numbers(column: Any, header: str, name: str, first: int) -> Array:
    """Return a column's numbers; of integers and time stamps `first` may be taken away."""
    kind = column.type
    if _is_time(kind):
        unit = {"s": 1.0, "ms": 1e3, "us": 1e6, "ns": 1e9}[kind.unit]
        return np.asarray(_doubles(_counted_from(_counts(column), first)) / unit)
    if pa.types.is_integer(kind):
        # Counts of nanoseconds since 1970 are beyond what a float holds to the digit.
        counts = _counts(column)
        return _doubles(_counted_from(counts, first) if abs(first) > 2**53 else counts)
    if not (pa.types.is_floating(kind) or pa.types.is_decimal(kind)):
        raise InputError(header, expected="numeric", found=str(kind), where=name)
    return _doubles(column.cast(pa.float64()))


def _counts(column: Any) -> Any:
    """Return integers, or the counts of time stamps."""
    if _is_time(column.type):
        column = column.cast(pa.int32() if column.type.bit_width == 32 else pa.int64())
    return column.cast(pa.int64(), safe=False)


def _first(column: Any) -> int:
    """Return the first of a column's counts; 0 where it has none."""
    if not (_is_time(column.type) or pa.types.is_integer(column.type)):
        return 0
    found = _counts(column[:1]).to_pylist()
    return next((int(value) for value in found if value is not None), 0)


def _counted_from(counts: Any, first: int) -> Any:
    return compute.subtract(counts, pa.scalar(first, pa.int64()))


def _doubles(column: Any) -> Array:
    return doubles(column.cast(pa.float64(), safe=False))


FORMAT = FileFormat((".parquet",), open_parquet, open_parquet)

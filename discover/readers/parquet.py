"""Parquet as a source of columns."""

from __future__ import annotations

import io
from collections.abc import Sequence
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.compute as compute
import pyarrow.parquet as parquet

from discover.readers.arrow_values import doubles
from discover.readers.content import content_error
from discover.readers.source import Book, Source, single
from models.checks import Array, InputError


def open_parquet(data: bytes, name: str) -> Book:
    """Open a Parquet file; its column names are the headers.

    Time stamps are read as seconds since the first one, with the resolution that they have.

    Raises
    ------
    InputError
        Where it is not Parquet, or, on reading, a column is not numeric.
    """
    try:
        file = parquet.ParquetFile(io.BytesIO(data))
        schema = file.schema_arrow
        headers = tuple(str(h).strip() for h in schema.names)
    except (pa.ArrowException, OSError) as error:
        raise content_error("a Parquet file", error, name) from None
    stamps = {i: "s" for i, kind in enumerate(schema.types) if _is_time(kind)}

    def read(indices: Sequence[int]) -> list[Array]:
        names = [schema.names[i] for i in indices]
        try:
            table = file.read(columns=names)
        except (pa.ArrowException, OSError) as error:
            raise content_error("a whole Parquet file", error, name) from None
        # Columns of one name come together, in the file's order.
        kept = [i for i, own in enumerate(schema.names) if own in names]
        return [_numbers(table.column(kept.index(i)), headers[i], name) for i in indices]

    return single(Source(name, headers, read, units=stamps))


def _is_time(kind: Any) -> bool:
    return bool(pa.types.is_timestamp(kind) or pa.types.is_duration(kind) or pa.types.is_time(kind))


def _numbers(column: Any, header: str, name: str) -> Array:
    kind = column.type
    if _is_time(kind):
        return _seconds(column)
    if pa.types.is_integer(kind):
        # Counts of nanoseconds since 1970 are beyond what a float holds to the digit.
        return _doubles(_from_first(column.cast(pa.int64(), safe=False)))
    if not pa.types.is_floating(kind):
        raise InputError(header, expected="numeric", found=str(kind), where=name)
    return _doubles(column.cast(pa.float64()))


def _seconds(column: Any) -> Array:
    """Return time stamps as seconds since the first one."""
    unit = {"s": 1.0, "ms": 1e3, "us": 1e6, "ns": 1e9}[column.type.unit]
    wide = pa.int32() if column.type.bit_width == 32 else pa.int64()
    counts = _from_first(column.cast(wide).cast(pa.int64()), always=True)
    return np.asarray(_doubles(counts) / unit)


def _from_first(column: Any, *, always: bool = False) -> Any:
    """Return integers less the first of them, where they are too large for a float."""
    first = next((value for value in column[:1].to_pylist() if value is not None), 0)
    if always or abs(first) > 2**53:
        return compute.subtract(column, pa.scalar(first, pa.int64()))
    return column


def _doubles(column: Any) -> Array:
    return doubles(column.cast(pa.float64(), safe=False))

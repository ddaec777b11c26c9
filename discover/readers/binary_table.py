"""Parquet, MATLAB .mat and numpy .npz as sources of columns."""

from __future__ import annotations

import io
from collections.abc import Sequence
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.parquet as parquet
from scipy.io import loadmat

from discover.readers.mat_guard import damage
from discover.readers.source import Source, from_arrays, row_place
from models.checks import Array, InputError


def open_parquet(data: bytes, name: str) -> Source:
    """Open a Parquet file; its column names are the headers.

    Raises
    ------
    InputError
        Where it is not Parquet, or, on reading, a column is not numeric.
    """
    try:
        file = parquet.ParquetFile(io.BytesIO(data))
        headers = tuple(str(h).strip() for h in file.schema_arrow.names)
    except (pa.ArrowException, OSError) as error:
        raise InputError(
            "content", where=name, expected="a Parquet file", found=_first_line(error)
        ) from None

    def read(indices: Sequence[int]) -> list[Array]:
        try:
            table = file.read(columns=[file.schema_arrow.names[i] for i in indices])
        except (pa.ArrowException, OSError) as error:
            raise InputError(
                "content", where=name, expected="a whole Parquet file", found=_first_line(error)
            ) from None
        result = []
        for index in indices:
            column = table.column(file.schema_arrow.names[index])
            kind = column.type
            if not (pa.types.is_integer(kind) or pa.types.is_floating(kind)):
                raise InputError(headers[index], expected="numeric", found=str(kind), where=name)
            result.append(np.array(column.cast(pa.float64()).to_numpy(), dtype=np.float64))
        return result

    return Source(name, headers, read, row_place)


def open_npz(data: bytes, name: str) -> Source:
    """Open a numpy archive; its names are the headers. Pickled objects are refused.

    Raises
    ------
    InputError
        Where it is not such an archive or holds no numeric vector.
    """
    arrays: dict[str, object] = {}
    try:
        with np.load(io.BytesIO(data), allow_pickle=False) as archive:
            if not isinstance(archive, np.lib.npyio.NpzFile):
                raise InputError(
                    "content", where=name, expected="an .npz archive", found="a single array"
                )
            for key in archive.files:
                arrays[key] = archive[key]
    except InputError:
        raise
    except Exception as error:  # numpy parses headers as Python: errors of many kinds
        raise InputError(
            "content", where=name, expected="an .npz archive", found=_first_line(error)
        ) from None
    return from_arrays(name, arrays)


def open_mat(data: bytes, name: str) -> Source:
    """Open a MATLAB file up to version 7; fields of structures are named ``data.time``.

    Raises
    ------
    InputError
        Where it is not such a file, is of version 7.3, or holds no numeric vector.
    """
    damaged = damage(data)
    if damaged:
        raise InputError("content", where=name, expected="a whole MATLAB file", found=damaged)
    try:
        content = loadmat(io.BytesIO(data), simplify_cells=True)  # type: ignore[arg-type]  # stubs
    except NotImplementedError:
        raise InputError(
            "content",
            where=name,
            expected="a .mat file saved with -v7 or older",
            found="version 7.3 (HDF5)",
        ) from None
    except Exception as error:  # scipy's parser lets errors of many kinds through
        raise InputError(
            "content", where=name, expected="a MATLAB file", found=_first_line(error)
        ) from None
    flat: dict[str, object] = {}
    _flatten({k: v for k, v in content.items() if not k.startswith("__")}, "", flat)
    return from_arrays(name, flat)


def _flatten(content: dict[str, Any], prefix: str, flat: dict[str, object]) -> None:
    for key, value in content.items():
        if isinstance(value, dict):
            _flatten(value, f"{prefix}{key}.", flat)
        else:
            flat[prefix + key] = value


def _first_line(error: BaseException) -> str:
    return (str(error).strip().splitlines() or [type(error).__name__])[0][:120]

"""A record's file, opened: its headers, and columns by header."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from models.checks import Array, InputError


@dataclass(frozen=True)
class Source:
    """A table whose columns are read when they are asked for."""

    name: str
    """File as in ``campaign.toml``."""
    headers: tuple[str, ...]
    """As in the file, stripped."""
    read: Callable[[Sequence[int]], list[Array]]
    """Columns by their index among the headers, each (N,) float64, NaN where empty."""
    place: Callable[[int], str]
    """Where a row is, in words: "line 12" of a text file, "row 11" of others."""


def row_place(row: int) -> str:
    """Return a row's place in a file without lines.

    Examples
    --------
    >>> row_place(0)
    'row 1'
    """
    return f"row {row + 1}"


def from_arrays(name: str, arrays: dict[str, object]) -> Source:
    """Return a source over named arrays, as files of MATLAB and numpy hold them.

    Parameters
    ----------
    name : str
        File, for messages.
    arrays : dict
        Values by name. Vectors count as columns; a matrix of at most 64 columns gives one
        column each, named as MATLAB would: ``data(:,1)``. Anything else is left out.

    Returns
    -------
    Source
    """
    columns: dict[str, np.ndarray] = {}
    for key, value in arrays.items():
        array = np.asarray(value)
        if array.dtype.kind not in "iufb" or array.size < 2:
            continue
        vector = array.squeeze()
        if vector.ndim == 1:
            columns[key.strip()] = vector
        elif vector.ndim == 2 and vector.shape[1] <= 64:
            for index in range(vector.shape[1]):
                columns[f"{key}(:,{index + 1})"] = vector[:, index]
    if not columns:
        raise InputError("content", expected="numeric vectors", found="none", where=name)
    headers = tuple(columns)

    def read(indices: Sequence[int]) -> list[Array]:
        result = [np.array(columns[headers[i]], dtype=np.float64) for i in indices]
        for index, column in zip(indices, result, strict=True):
            if column.size != result[0].size:
                raise InputError(
                    headers[index],
                    expected=f"of the length of {headers[indices[0]]} ({result[0].size})",
                    found=str(column.size),
                    where=name,
                )
        return result

    return Source(name, headers, read, row_place)

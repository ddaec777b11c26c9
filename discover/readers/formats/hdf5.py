"""HDF5, and MATLAB 7.3 files that are HDF5, as a source of columns (h5py)."""

from __future__ import annotations

import io
import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from discover.readers.content import content_error, optional_package
from discover.readers.file_format import FileFormat
from discover.readers.sampling_note import stated_step
from discover.readers.source import LONG, MOST_VALUES, Book, LongVector
from discover.readers.tree import Leaf, tree_book
from models.checks import InputError

_MAGIC = b"\x89HDF\r\n\x1a\n"
_DEEPEST = 16  # groups in each other
_UNIT_NAMES = ("units", "unit", "Units", "Unit", "UNIT", "unit_string")
_NAMES = re.compile("name|column|channel|label|header|field|signal", re.IGNORECASE)
"""What an attribute is called that lists the columns of a matrix."""


def is_hdf5(data: bytes) -> bool:
    """Return whether a file is HDF5, after a block of a user's own (MATLAB's is 512 bytes) too."""
    return any(data[at : at + 8] == _MAGIC for at in (0, 512, 1024, 2048))


def open_hdf5(data: bytes | Path, name: str, *, joint: str = "/") -> Book:
    """Open an HDF5 file; groups hold tests, data sets are columns.

    Of a path, long vectors are read when they are asked for, whole or in pieces.

    An attribute ``units`` of a data set is its unit; ``scale_factor``, ``add_offset`` and
    ``_FillValue`` say what its counts stand for; one as ``columns`` lists the names of a matrix's
    columns. A scalar or an attribute may state the sampling rate. What lies in other files is not
    followed.

    Raises
    ------
    InputError
        Where it is not such a file, holds no numeric vector, or h5py is missing.
    """
    h5py = optional_package("h5py", extra="hdf5", name=name)
    try:
        path = data if isinstance(data, Path) else None
        with h5py.File(data if isinstance(data, Path) else io.BytesIO(data), "r") as file:
            leaves = list(_Walk(h5py, file, path).leaves(file, ()))
    except InputError:
        raise
    except Exception as error:  # the library lets errors of many kinds through
        raise content_error("an HDF5 file", error, name) from None
    return tree_book(name, leaves, joint=joint)


class _Walk:
    """One walk over a file that meets every object once, however it is linked."""

    def __init__(self, h5py: Any, file: Any, path: Path | None) -> None:
        self.h5py = h5py
        self.file = file
        self.path = path
        self.met = {h5py.h5o.get_info(file.id).addr}

    def leaves(self, group: Any, path: tuple[str, ...]) -> Iterator[Leaf]:
        """Return what lies in a group and below it."""
        for key, value in _scalars(group):
            yield Leaf((*path, key), value)
        for key in group:
            # MATLAB's store of references is reached through them; a link may lead elsewhere.
            hard = isinstance(group.get(key, getlink=True), self.h5py.HardLink)
            if hard and not key.startswith("#"):
                yield from self._item(group[key], (*path, key))

    def _item(self, item: Any, path: tuple[str, ...]) -> Iterator[Leaf]:
        address = self.h5py.h5o.get_info(item.id).addr
        if address in self.met or len(path) > _DEEPEST:
            return
        self.met.add(address)
        if isinstance(item, self.h5py.Group):
            yield from self.leaves(item, path)
        elif isinstance(item, self.h5py.Dataset) and not (item.external or item.is_virtual):
            yield from self._values(item, path)

    def _values(self, item: Any, path: tuple[str, ...]) -> Iterator[Leaf]:
        kind = item.attrs.get("MATLAB_class")
        if item.shape is None or kind == b"char":
            return
        numbers = item.ndim == 1 and item.dtype.kind in "iuf"
        if self.path is not None and numbers and item.size > LONG:
            packing = _packing(item)
            column = LongVector(item.size, _reader(self.h5py, self.path, item.name, packing))
            yield Leaf(path, column, unit=_unit(item), step=self._step(item))
            return
        if item.size > MOST_VALUES:
            return
        if self.h5py.check_dtype(ref=item.dtype) is not None:  # cells, members of a structure
            for index, reference in enumerate(np.ravel(item[()]), start=1):
                if reference:
                    own = (*path[:-1], f"{path[-1]}({index})")
                    yield from self._item(self.file[reference], own)
            return
        step = self._step(item)
        if item.dtype.names:  # a table, as pandas and PyTables write it
            units = _units(item, len(item.dtype.names))
            for field, unit in zip(item.dtype.names, units, strict=True):
                yield Leaf((*path, field), item[field], unit=unit, step=step)
            return
        values = item[()]
        if isinstance(values, np.ndarray) and values.dtype.kind in "iuf":
            values = _unpacked(values, _packing(item))
            if names := _column_names(item):
                columns = values.T if len(names) == values.shape[1] else values
                units = _units(item, len(names))
                for header, column, unit in zip(names, columns, units, strict=True):
                    yield Leaf((*path, header), column, unit=unit, step=step)
                return
        yield Leaf(path, values, unit=_unit(item), step=step)

    def _step(self, item: Any) -> float | None:
        """Return the sampling interval that a data set's attributes state."""
        return stated_step(
            [(key, repr(float(value.ravel()[0]))) for key, value in _scalars(item)]
        )


@dataclass(frozen=True)
class _Packing:
    """How values are kept, as NetCDF's conventions (CF, 8.1) say."""

    factor: float
    """Value of one count."""
    offset: float
    """Value of no counts."""
    fill: float | None
    """What stands for a value that is missing; None for nothing."""


def _packing(item: Any) -> _Packing:
    """Return how a data set's attributes say that its values are kept."""
    stated = {key: float(value.ravel()[0]) for key, value in _scalars(item)}
    fill = stated.get("_FillValue", stated.get("missing_value"))
    return _Packing(stated.get("scale_factor", 1.0), stated.get("add_offset", 0.0), fill)


def _unpacked(values: np.ndarray[Any, Any], how: _Packing) -> np.ndarray[Any, Any]:
    """Return what values stand for, NaN for one that is missing."""
    missing = values == how.fill if how.fill is not None else np.zeros(values.shape, dtype=bool)
    if (how.factor, how.offset) == (1.0, 0.0) and not missing.any():
        return values
    return np.where(missing, np.nan, values * how.factor + how.offset)


def _reader(
    h5py: Any, path: Path, name: str, packing: _Packing
) -> Callable[[slice], np.ndarray[Any, Any]]:
    """Return what reads a part of a data set."""

    def part(inside: slice) -> np.ndarray[Any, Any]:
        with h5py.File(path, "r") as file:
            return _unpacked(np.asarray(file[name][inside]), packing)

    return part


def _scalars(item: Any) -> Iterator[tuple[str, Any]]:
    """Return the attributes that are single numbers."""
    for key, value in item.attrs.items():
        array = np.asarray(value)
        if array.size == 1 and array.dtype.kind in "iuf":
            yield key, array


def _unit(item: Any) -> str:
    """Return a data set's unit, "" for none; of ``seconds since 2024-05-17`` that of the counts."""
    for key in _UNIT_NAMES:
        value = item.attrs.get(key)
        if isinstance(value, bytes):
            value = value.decode("utf-8", "replace")
        if isinstance(value, str):
            return value.partition(" since ")[0].strip()
    return ""


def _units(item: Any, count: int) -> list[str]:
    """Return the units of a table's fields, where an attribute lists them."""
    lists = (_texts(item.attrs.get(key, ())) for key in _UNIT_NAMES)
    return next((listed for listed in lists if len(listed) == count), [""] * count)


def _column_names(item: Any) -> list[str]:
    """Return the names of a matrix's columns or rows, where an attribute lists them; else none."""
    if item.ndim != 2:
        return []
    for key, value in item.attrs.items():
        if _NAMES.search(key) and not key.startswith("DIMENSION_"):  # those name the two axes
            listed = _texts(value)
            if len(listed) in item.shape and len(set(listed)) == len(listed) > 1 and all(listed):
                return listed
    return []


def _texts(value: Any) -> list[str]:
    """Return an attribute's list of texts; nothing of any other attribute."""
    listed = np.ravel(value)
    if listed.dtype.kind not in "OSU":
        return []
    return [
        own.decode("utf-8", "replace").strip() if isinstance(own, bytes) else str(own).strip()
        for own in listed
    ]


FORMAT = FileFormat((".h5", ".hdf5"), open_hdf5, open_hdf5)

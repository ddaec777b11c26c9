"""Universal File Format, data set 58, as a source of columns (pyuff)."""

from __future__ import annotations

import tempfile
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from discover.readers.content import content_error, optional_package
from discover.readers.file_format import FileFormat
from discover.readers.source import Book
from discover.readers.tree import Leaf, tree_book

_FUNCTION = 58  # number of the data set that holds a function
_EVEN = 1  # abscissa spacing
_TIME = 17  # specific data type of the abscissa
# By the data type of the ordinate.
_ROLES = {8: "displacement", 9: "force", 11: "velocity", 12: "acceleration", 13: "force"}
_EMPTY = ("", "NONE")


def open_uff(data: bytes, name: str) -> Book:
    """Open a universal file: its functions of time are columns, its load cases tests.

    Raises
    ------
    InputError
        Where it is not such a file, holds no function of time, or pyuff is missing.
    """
    pyuff = optional_package("pyuff", extra="uff", name=name)
    try:
        with tempfile.TemporaryDirectory() as folder:  # the library reads from a path only
            path = Path(folder, "record.uff")
            path.write_bytes(data)
            file = pyuff.UFF(str(path))
            kinds = [int(kind) for kind in file.get_set_types()]
            sets = [file.read_sets(i) for i, kind in enumerate(kinds) if kind == _FUNCTION]
        leaves = list(_leaves([s for s in sets if s.get("abscissa_spec_data_type") == _TIME]))
    except Exception as error:  # the library lets errors of many kinds through
        raise content_error("a universal file", error, name) from None
    return tree_book(name, leaves)


def _leaves(sets: list[Mapping[str, Any]]) -> Iterator[Leaf]:
    taken: set[tuple[str, ...]] = set()
    for function in sets:
        group = f"load case {int(function.get('load_case_id', 0))}"
        role = _ROLES.get(int(function.get("ordinate_spec_data_type", 0)), "")
        path = (group, _name(function, role))
        count = 1
        while path in taken:
            count += 1
            path = (group, f"{_name(function, role)} {count}")
        taken.add(path)
        even = int(function.get("abscissa_spacing", _EVEN)) == _EVEN
        if not even and (group, "time") not in taken:
            taken.add((group, "time"))
            times = np.asarray(function["x"], dtype=np.float64)
            yield Leaf((group, "time"), times, unit="s", role="time")
        yield Leaf(
            path,
            np.real(np.asarray(function["data"])),
            unit=_text(function, "ordinate_axis_units_lab"),
            step=float(function["abscissa_inc"]) if even else None,
            start=float(function["abscissa_min"]) if even else 0.0,
            role=role,
        )


def _name(function: Mapping[str, Any], role: str) -> str:
    """Return the channel's name: its first line of text, else its axis, else what it measures."""
    for key in ("id1", "ordinate_axis_lab"):
        if _text(function, key):
            return _text(function, key)
    return role or "channel"


def _text(function: Mapping[str, Any], key: str) -> str:
    text = str(function.get(key, "")).strip()
    return "" if text.upper() in _EMPTY else text


FORMAT = FileFormat((".uff", ".unv"), open_uff)

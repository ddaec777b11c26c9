"""From a source's headers to a record's quantities in SI."""

from __future__ import annotations

import difflib
import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import numpy as np

from discover.readers.source import Source
from discover.readers.units import SI_UNITS, check_unit, same_unit, to_si
from models.checks import Array, InputError

QUANTITIES = {
    "time": "time",
    "displacement": "length",
    "force": "force",
    "velocity": "speed",
    "acceleration": "acceleration",
    "temperature": "temperature",
    "base_acceleration": "acceleration",
    "applied_force": "force",
}
"""The columns that a record may have, each with the kind of its unit."""

_LARGEST = 1e30  # whose square, and the sum of squares, is still a number
_HEADER = re.compile(r"\s*(.*?)\s*(?:\[([^\]]*)\]|\(([^():,]*)\))?\s*", re.DOTALL)


@dataclass(frozen=True)
class Columns:
    """A record's columns in SI."""

    values: Mapping[str, Array]
    """(N,) by quantity, those that the file has."""
    raw_time: Array
    """(N,) in the file's unit: its decimals tell rounding from jitter."""
    assumed: tuple[str, ...]
    """Quantities whose unit is nowhere stated and taken as SI."""
    unused: Mapping[str, str]
    """Headers that are nearly a quantity's name but not read, with that name."""


def _split(header: str) -> tuple[str, str | None]:
    """Return a header's name and unit, as in ``force [kN]`` or ``force (kN)``."""
    match = _HEADER.fullmatch(header)
    if match is None or not match.group(1):
        return header.strip(), None
    unit = match.group(2) if match.group(2) is not None else match.group(3)
    return match.group(1), unit.strip() if unit and unit.strip() else None


def _plain(name: str) -> str:
    return re.sub(r"[\s\-]+", "_", name.strip().lower())


def _find(source: Source, quantity: str, wanted: str) -> int | None:
    """Return the index of the header that is meant; None where there is none."""
    if wanted in source.headers:
        return source.headers.index(wanted)
    names = [_plain(_split(h)[0]) for h in source.headers]
    target = _plain(_split(wanted)[0])
    found = [i for i, name in enumerate(names) if name == target]
    if not found:  # a field of a MATLAB structure
        found = [i for i, name in enumerate(names) if name.rsplit(".", 1)[-1] == target]
    if len(found) > 1:
        listed = ", ".join(repr(source.headers[i]) for i in found)
        raise InputError(quantity, expected="one column", found=listed, where=source.name)
    return found[0] if found else None


def read_columns(
    source: Source, *, names: Mapping[str, str], units: Mapping[str, str], may_lack: Iterable[str]
) -> Columns:
    """Read the columns of a record and convert them to SI.

    Parameters
    ----------
    source : Source
        The opened file.
    names : mapping
        ``[columns]``: headers by quantity where they differ.
    units : mapping
        ``[units]``: units by quantity where headers carry none.
    may_lack : iterable of str
        Quantities that this record can do without.

    Raises
    ------
    InputError
        Where a column is missing, its unit is wrong, or a value is missing or not finite.
    """
    found: dict[str, int] = {}
    for quantity in QUANTITIES:
        wanted = names.get(quantity, quantity)
        index = _find(source, quantity, wanted)
        if index is not None:
            found[quantity] = index
        elif quantity not in may_lack:
            raise missing_column(source, quantity, wanted)
    chosen = {}
    for quantity, index in found.items():
        chosen[quantity] = _unit_of(source, index, quantity, units.get(quantity))
    raw = source.read(list(found.values()))
    values, assumed = {}, []
    for (quantity, index), column in zip(found.items(), raw, strict=True):
        _check_finite(source, index, column)
        unit = chosen[quantity]
        if unit is None:
            assumed.append(quantity)
            values[quantity] = column
        else:
            values[quantity] = to_si(column, unit, QUANTITIES[quantity])
    unused = {}
    for index, header in enumerate(source.headers):
        if index in found.values():
            continue
        near = difflib.get_close_matches(_plain(_split(header)[0]), list(QUANTITIES), 1, 0.8)
        if near and near[0] not in found:
            unused[header] = near[0]
    return Columns(values, raw[list(found).index("time")], tuple(assumed), unused)


def missing_column(source: Source, quantity: str, wanted: str, *, instead: str = "") -> InputError:
    """Return the error that says which column is missing and what is there instead."""
    by_name = {_plain(_split(h)[0]): h for h in source.headers}
    close = difflib.get_close_matches(_plain(wanted), list(by_name), n=1, cutoff=0.6)
    hint = f"; is it {by_name[close[0]]!r}? [columns] can say so" if close else ""
    return InputError(
        f"column {wanted!r}" + (f" for {quantity}" if wanted != quantity else ""),
        expected="among the headers" + instead,
        found=", ".join(source.headers)[:200] + hint,
        where=source.name,
    )


def _unit_of(source: Source, index: int, quantity: str, stated: str | None) -> str | None:
    """Return a column's unit, checked; None where neither header nor ``[units]`` has it."""
    kind = QUANTITIES[quantity]
    header = source.headers[index]
    own = _split(header)[1]
    if own is None:
        return stated
    check_unit(own, kind, name=quantity, where=f"{source.name}, header {header!r}")
    if stated is not None and not same_unit(own, stated, kind):
        raise InputError(
            f"unit of {quantity}",
            expected=f"the same in [units] ({stated}) and in the header",
            found=own,
            where=source.name,
        )
    return own


def _check_finite(source: Source, index: int, column: Array) -> None:
    bad = np.flatnonzero(~(np.abs(column) < _LARGEST))
    if bad.size:
        more = f" ({bad.size} such values)" if bad.size > 1 else ""
        raise InputError(
            source.headers[index],
            expected="a finite number throughout",
            found=f"{column[bad[0]]:.6g}{more}",
            where=f"{source.name} {source.place(int(bad[0]))}",
        )


def assumed_units(assumed: Iterable[str]) -> str:
    """Return what to tell about columns without a unit.

    Examples
    --------
    >>> assumed_units(["force"])
    'no unit is stated for force, N taken: name it in the header, as force [kN], or in [units]'
    """
    listed = ", ".join(f"{q}, {SI_UNITS[QUANTITIES[q]]} taken" for q in assumed)
    return f"no unit is stated for {listed}: name it in the header, as force [kN], or in [units]"

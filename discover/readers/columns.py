"""From a source's headers to a record's quantities in SI."""

from __future__ import annotations

import difflib
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from discover.readers.names import NAMED, name_score
from discover.readers.numerals import EMPTY, is_clock_form, is_number
from discover.readers.source import Source
from discover.readers.units import (
    LARGEST,
    SI_UNITS,
    check_unit,
    is_unit,
    measures,
    same_unit,
    to_si,
    turns_sign,
)
from models.checks import Array, InputError, shown

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

_PLACE = re.compile(r"column (\d{1,6})")
_LONGEST_NAME = 80  # characters of a header that are looked at


@dataclass(frozen=True)
class Columns:
    """A record's columns in SI."""

    values: Mapping[str, Array]
    """(N,) by quantity, those that the file has."""
    raw_time: Array
    """(N,) in the file's unit: its decimals tell rounding from jitter."""
    units: Mapping[str, str | None]
    """By quantity as stated, of the columns that were read; None where it is taken as SI."""
    unused: Mapping[str, str]
    """Headers that are nearly a quantity's name but not read, with that name."""
    step: float | None = None
    """s, the sampling interval that the times were made of; None where they were read."""
    notes: tuple[str, ...] = ()
    """What to tell of how they were read."""

    @property
    def assumed(self) -> tuple[str, ...]:
        """Quantities whose unit is nowhere stated and taken as SI."""
        return tuple(quantity for quantity, unit in self.units.items() if unit is None)


def split_header(header: str) -> tuple[str, str | None]:
    """Return a header's name and unit; None where it has none.

    Examples
    --------
    >>> split_header("force [kN]"), split_header("force (kN)"), split_header("data(:,1)")
    (('force', 'kN'), ('force', 'kN'), ('data(:,1)', None))
    >>> split_header("F / kN"), split_header("Weg/mm"), split_header("run 1/F")
    (('F', 'kN'), ('Weg', 'mm'), ('run 1/F', None))
    >>> split_header("Time (hh:mm:ss)")
    ('Time', 'hh:mm:ss')
    """
    text = header.strip()
    for opening, closing, barred in (("[", "]", "[]"), ("(", ")", "():,")):
        if not text.endswith(closing):
            continue
        name, bracket, unit = text[:-1].rpartition(opening)
        parted = any(c in unit for c in barred) and not is_clock_form(unit)
        if bracket and name.strip() and not parted:
            return name.strip(), unit.strip() or None
    name, slash, unit = text.rpartition("/")  # as of DIN 461; else it is a path's
    if slash and name.strip() and unit.strip() and _over_unit(name, unit):
        return name.strip(), unit.strip()
    return text, None


def _over_unit(name: str, unit: str) -> bool:
    """Return whether what follows a header's slash is a unit, and no name inside a group."""
    if name[-1].isspace() and unit[0].isspace():
        return is_unit(unit)
    return any(name_score(name, q) and measures(unit.strip(), QUANTITIES[q]) for q in NAMED)


def stated_unit(source: Source, index: int) -> str | None:
    """Return the unit that a file states for a column, None where it states none.

    What a header has in brackets is no unit where the file itself knows it, as that of a clock
    below ``Time [hh:mm:ss]`` or ``Time (UTC)``.
    """
    own, known = split_header(source.headers[index])[1], source.units.get(index)
    if own is None or is_clock_form(own) or (known is not None and not is_unit(own)):
        return known
    return own


def is_place(header: str) -> bool:
    """Return whether a header is a column's place, as where the file names none.

    Examples
    --------
    >>> is_place("column 2"), is_place("column A")
    (True, False)
    """
    return _PLACE.fullmatch(header) is not None


def _plain(name: str) -> str:
    return re.sub(r"[\s\-]+", "_", name.strip().lower())


def find_column(source: Source, quantity: str, wanted: str) -> int | None:
    """Return the index of the header that is meant; None where there is none.

    A column is named by its place too, as ``column 2``. Of several that are the same throughout
    the first one is taken.

    Raises
    ------
    InputError
        Where several could be meant.
    """
    found = [i for i, header in enumerate(source.headers) if header == wanted]
    target = _plain(split_header(wanted)[0])
    names = [_plain(split_header(h)[0]) for h in source.headers]
    if not found:
        found = [i for i, name in enumerate(names) if name == target]
    if not found:  # a vector in a group or a structure
        found = [i for i, name in enumerate(names) if name.endswith((f".{target}", f"/{target}"))]
    if not found and wanted == quantity and quantity in source.roles:
        found = [source.roles[quantity]]
    place = _PLACE.fullmatch(wanted)
    if not found and place is not None and 1 <= int(place[1]) <= len(source.headers):
        found = [int(place[1]) - 1]
    if len(found) > 1 and _alike(source, found):
        found = found[:1]
    if len(found) > 1:
        listed = ", ".join(repr(source.headers[i]) for i in found)
        if len({source.headers[i] for i in found}) == 1 and source.cell is not None:
            listed += (
                '; take the cells of one test by `range` in [[records]], as "A1:C900", where it is'
                f' a sheet; or name a column by its place, as "column {found[0] + 1}"'
            )
        raise InputError(quantity, expected="one column", found=listed, where=source.name)
    return found[0] if found else None


def _alike(source: Source, indices: Sequence[int]) -> bool:
    """Return whether columns are the same throughout, as a time beside every channel is."""
    try:
        first, *others = source.read(indices)
    except (InputError, ValueError):
        return False
    return all(np.array_equal(first, other, equal_nan=True) for other in others)


def read_columns(
    source: Source,
    *,
    names: Mapping[str, str],
    units: Mapping[str, str],
    may_lack: Iterable[str],
    step: float | None = None,
    span: tuple[float | None, float | None] = (None, None),
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
    step : float, optional
        s, a sampling interval to take in place of a time column.
    span : tuple of float or None
        s, first and last time that is wanted: beyond them a value may be missing.

    Raises
    ------
    InputError
        Where a column is missing, its unit is wrong, or a value is missing or not finite.
    """
    found = _indices(source, names, may_lack, timed=step is not None)
    chosen = {}
    for quantity, index in found.items():
        chosen[quantity] = _unit_of(source, index, quantity, units.get(quantity))
    raw = source.read(list(found.values()))
    values = {}
    for quantity, column in zip(found, raw, strict=True):
        unit = chosen[quantity]
        values[quantity] = column if unit is None else to_si(column, unit, QUANTITIES[quantity])
    made = None
    if "time" in found:
        raw_time = raw[list(found).index("time")]
    else:
        made = step if step is not None else source.step or 1.0
        start = source.start if step is None else 0.0
        raw_time = made * np.arange(values["force"].size, dtype=np.float64) + start
        values["time"] = raw_time
    inside = within(values["time"], span)
    for index, column in zip(found.values(), raw, strict=True):
        check_finite(source, index, column, inside)
    notes = [source.notes[index] for index in found.values() if index in source.notes]
    notes += _calibrations(source, found, chosen)
    unused = _unused(source, found)
    return Columns(values, raw_time, chosen, unused, made, (*source.told, *notes))


def _indices(
    source: Source, names: Mapping[str, str], may_lack: Iterable[str], *, timed: bool
) -> dict[str, int]:
    """Return which column is which quantity, without the time where a rate stands for it."""
    found = {}
    for quantity in QUANTITIES:
        wanted = names.get(quantity, quantity)
        index = find_column(source, quantity, wanted)
        if quantity == "time" and timed:
            continue
        if index is not None:
            found[quantity] = index
        elif quantity == "time" and source.step is not None:
            continue
        elif quantity not in may_lack:
            raise missing_column(source, quantity, wanted)
    return found


def within(time: Array, span: tuple[float | None, float | None]) -> NDArray[np.bool_]:
    """Return which times (N,) lie in a span; all of them, missing ones too, where it is open.

    Examples
    --------
    >>> within(np.array([0.0, np.nan, 2.0]), (None, 1.0)).tolist()
    [True, False, False]
    """
    first, last = span
    inside = np.ones(time.size, dtype=bool)
    if first is not None:
        inside &= time >= first
    if last is not None:
        inside &= time <= last
    return inside


def _unused(source: Source, found: Mapping[str, int]) -> dict[str, str]:
    """Return headers that are not read but nearly a quantity's name, with that name."""
    unused = {}
    for index, header in enumerate(source.headers):
        if index in found.values() or len(header) > _LONGEST_NAME:
            continue
        near = difflib.get_close_matches(_plain(split_header(header)[0]), list(QUANTITIES), 1, 0.8)
        if near and near[0] not in found:
            unused[header] = near[0]
    return unused


def missing_column(source: Source, quantity: str, wanted: str, *, instead: str = "") -> InputError:
    """Return the error that says which column is missing and what is there instead."""
    by_name = {_plain(split_header(h)[0]): h for h in source.headers}
    short = [name for name in by_name if len(name) <= _LONGEST_NAME]
    close = difflib.get_close_matches(_plain(wanted)[:_LONGEST_NAME], short, n=1, cutoff=0.6)
    hint = f"; is it {by_name[close[0]]!r}? [columns] can say so" if close else ""
    if all(map(is_place, source.headers)):
        hint = f'; there is no header: say in [columns] which is which, {quantity} = "column 1"'
    return InputError(
        f"column {wanted!r}" + (f" for {quantity}" if wanted != quantity else ""),
        expected="among the headers" + instead,
        found=", ".join(h[:_LONGEST_NAME] for h in source.headers[:99])[:200] + hint,
        where=source.name,
    )


def _unit_of(source: Source, index: int, quantity: str, stated: str | None) -> str | None:
    """Return a column's unit, checked; None where neither header nor ``[units]`` has it.

    ``[units]`` may turn the sign of what the header says, as "-1 kN" does beside kN, and says what
    one of it is where the header's is no unit of this kind, as "2 kN" does beside V.
    """
    kind = QUANTITIES[quantity]
    header = source.headers[index]
    own = stated_unit(source, index)
    if own is None or (stated is not None and not measures(own, kind)):
        return stated
    try:
        check_unit(own, kind, name=quantity, where=f"{source.name}, header {header!r}")
    except InputError as error:
        remedy = f"; `{quantity}` in [units] may say what one of it is"
        raise InputError(
            error.what, expected=error.expected, found=error.found + remedy, where=error.where
        ) from None
    if stated is not None and turns_sign(own, stated, kind):
        return stated
    if stated is not None and not same_unit(own, stated, kind):
        raise InputError(
            f"unit of {quantity}",
            expected=f"the same in [units] ({stated}) and in the header",
            found=own,
            where=source.name,
        )
    return own


def _calibrations(
    source: Source, found: Mapping[str, int], chosen: Mapping[str, str | None]
) -> list[str]:
    """Return what to tell of columns whose header says a unit of another kind."""
    told = []
    for quantity, index in found.items():
        own, unit = stated_unit(source, index), chosen[quantity]
        if own is not None and not measures(own, QUANTITIES[quantity]):
            header = shown(source.headers[index])
            told.append(f"one {own} of {header} is taken as {unit}, by [units]")
    return told


def check_finite(source: Source, index: int, column: Array, inside: NDArray[np.bool_]) -> None:
    """Refuse a value inside the wanted span that is no finite number, as the file has it.

    Raises
    ------
    InputError
        With the place of the first such value.
    """
    bad = np.flatnonzero(~(np.abs(column) < LARGEST) & inside)
    if not bad.size:
        return
    row = int(bad[0])
    more = f" ({bad.size} such values)" if bad.size > 1 else ""
    expected, found = "a finite number throughout", f"{column[row]:.6g}"
    if source.cell is not None and np.isnan(column[row]):
        text = source.cell(row, index)
        found = shown(text)
        if text.strip().lower() not in EMPTY:
            expected = source.expected.get(index, "a number") if is_number(text) else "a number"
    raise InputError(
        source.headers[index],
        expected=expected,
        found=f"{found}{more}; mend the file, or take the part before or after by `range`",
        where=f"{source.name} {source.place(row)}",
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

"""The tables of ``campaign.toml``, checked and in SI."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import Any

from discover.readers.columns import QUANTITIES
from discover.readers.entries import Entry
from discover.readers.formats.excel import cell_range
from discover.readers.units import check_unit, quantity
from discover.records import CarriedSystem, RigLimits
from models.checks import InputError, nearest, number, one_of, shown
from models.device import Device

_FILE = "campaign.toml"
_DEVICE = {
    "rod_radius": "length",
    "cylinder_radius": "length",
    "channel_radius": "length",
    "helix_radius": "length",
    "helix_pitch": "length",
    "transition_length": "length",
    "piston_clearance": "length",
    "inertance": "mass",
    "coulomb_friction": "force",
}
_FLUID = {"density": "density", "viscosity": "dynamic viscosity"}
_RIG = {
    "max_stroke": "length",
    "max_speed": "speed",
    "max_acceleration": "acceleration",
    "max_force": "force",
}
_RECORD = (
    "file", "frequency", "amplitude", "held_out", "sheet", "group", "channel", "range",
    "sampling_rate", "units",
)  # fmt: skip
_ABOVE = "; that of the campaign stands above the first [table]"
_SYSTEM = {"mass": "mass", "stiffness": "stiffness"}


def _table(value: object, keys: Iterable[str], *, where: str) -> Mapping[str, Any]:
    """Return a table whose keys are all known, or raise `InputError` with the near name."""
    if not isinstance(value, Mapping):
        raise InputError(where, expected="a table", found=shown(value), where=_FILE)
    listed = tuple(keys)
    for key in value:
        if key not in listed:
            raise InputError(
                f"key {key!r}",
                expected="one of " + ", ".join(listed),
                found="an unknown key" + (_ABOVE if key == "title" else nearest(key, listed)),
                where=f"{_FILE} {where}",
            )
    return value


def read_column_names(value: object) -> dict[str, str]:
    """Return ``[columns]``: headers by quantity."""
    table = _table(value, QUANTITIES, where="[columns]")
    for key, header in table.items():
        if not isinstance(header, str) or not header.strip():
            raise InputError(
                key, expected="a header's text", found=shown(header), where=f"{_FILE} [columns]"
            )
    return dict(table)


def read_guessed_units(value: object) -> tuple[object, tuple[str, ...]]:
    """Return ``[units]`` without its list of those that are guessed, and that list."""
    if not isinstance(value, Mapping) or "guessed" not in value:
        return value, ()
    given = value["guessed"]
    units = {key: unit for key, unit in value.items() if key != "guessed"}
    if not isinstance(given, list) or not all(isinstance(q, str) and q in units for q in given):
        raise InputError(
            "guessed", expected="a list of quantities in [units], as [\"force\"]",
            found=shown(given), where=f"{_FILE} [units]",
        )  # fmt: skip
    return units, tuple(given)


def read_column_units(value: object) -> dict[str, str]:
    """Return ``[units]``: checked units by quantity."""
    return _units(value, "[units]")


def _units(value: object, place: str) -> dict[str, str]:
    where = f"{_FILE} {place}"
    table = _table(value, QUANTITIES, where=place)
    return {
        key: check_unit(unit, QUANTITIES[key], name=key, where=where) for key, unit in table.items()
    }


def read_device(value: object) -> Device:
    """Return ``[device]``: a preset, its values replaced by those beside it, or values alone.

    Raises
    ------
    InputError
        On an unknown key, a unit of the wrong kind or impossible geometry.
    """
    where = f"{_FILE} [device]"
    table = _table(value, ("preset", "name", *_DEVICE, "turns", "fluid"), where="[device]")
    plain: dict[str, Any] = {}
    for key in ("preset", "name"):
        if key in table:
            if not isinstance(table[key], str):
                raise InputError(key, expected="text", found=shown(table[key]), where=where)
            plain[key] = table[key]
    for key, kind in _DEVICE.items():
        if key in table:
            plain[key] = quantity(table[key], kind, name=key, where=where)
    if "turns" in table:
        plain["turns"] = number("turns", _plain_number(table["turns"]), above=0.0, where=where)
    if "fluid" in table:
        inside = f"{_FILE} [device.fluid]"
        fluid = _table(table["fluid"], _FLUID, where="[device.fluid]")
        plain["fluid"] = {
            key: quantity(text, _FLUID[key], name=key, where=inside) for key, text in fluid.items()
        }
    try:
        return Device.from_dict(plain, where=where)
    except InputError as error:
        place = error.where if error.where.startswith(_FILE) else where
        raise InputError(
            error.what, expected=error.expected, found=error.found, where=place
        ) from None


def _plain_number(value: object) -> object:
    """Return a number as it is, and anything that only converts to one as text to be refused."""
    return value if isinstance(value, int | float) and not isinstance(value, bool) else shown(value)


def read_rig(value: object) -> RigLimits:
    """Return ``[rig]``: limits for proposed tests, all positive."""
    where = f"{_FILE} [rig]"
    table = _table(value, _RIG, where="[rig]")
    limits = {
        key: number(key, quantity(text, _RIG[key], name=key, where=where), above=0.0, where=where)
        for key, text in table.items()
    }
    return RigLimits(**limits)


def read_system(value: object) -> CarriedSystem:
    """Return ``[system]``: the mass and spring that the device works in."""
    where = f"{_FILE} [system]"
    table = _table(value, (*_SYSTEM, "input"), where="[system]")
    for key in (*_SYSTEM, "input"):
        if key not in table:
            raise InputError(key, expected="given", found="nothing", where=where)
    found = {
        key: number(key, quantity(table[key], kind, name=key, where=where), above=0.0, where=where)
        for key, kind in _SYSTEM.items()
    }
    driven = table["input"]
    choices = ("base_acceleration", "applied_force")
    if not isinstance(driven, str):
        raise InputError(
            "input", expected="one of " + ", ".join(choices), found=shown(driven), where=where
        )
    return CarriedSystem(input=one_of("input", driven, choices, where=where), **found)


def read_entries(value: object) -> list[Entry]:
    """Return ``[[records]]``: at least one, each once."""
    if not isinstance(value, list) or not value:
        raise InputError(
            "[[records]]",
            expected='at least one table with a file, such as file = "run1.csv"',
            found="none" if not value else "something else",
            where=_FILE,
        )
    entries: list[Entry] = []
    met: set[str] = set()
    for index, item in enumerate(value, start=1):
        where = f"[[records]] {index}"
        entry = _entry(_table(item, _RECORD, where=where), f"{_FILE} {where}")
        same = replace(entry, channel_told=True).label(str(entry.part or ""))
        if same in met:
            raise InputError(
                "file", expected="listed once", found=f"{shown(same)} again",
                where=f"{_FILE} {where}",
            )  # fmt: skip
        met.add(same)
        entries.append(entry)
    samples = Counter(_samples(entry) for entry in entries)
    return [replace(e, channel_told=samples[_samples(e)] > 1) for e in entries]


def _samples(entry: Entry) -> tuple[str, str]:
    """Return what tells apart entries but for their channels."""
    return " + ".join(entry.files), replace(entry, channel_told=False).label(str(entry.part or ""))


def _entry(table: Mapping[str, Any], place: str) -> Entry:
    file, *beside = _files(table.get("file"), place)
    held_out = table.get("held_out", False)
    if not isinstance(held_out, bool):
        raise InputError("held_out", expected="true or false", found=shown(held_out), where=place)
    labels: dict[str, float | None] = {"frequency": None, "amplitude": None, "sampling_rate": None}
    for key, kind in (
        ("frequency", "frequency"), ("amplitude", "length"), ("sampling_rate", "frequency")
    ):  # fmt: skip
        if key in table:
            si = quantity(table[key], kind, name=key, where=place)
            labels[key] = number(key, si, above=0.0, where=place)
    rate = labels["sampling_rate"]
    key, part = _part(table, place)
    cells, span = _range(table.get("range", ""), place)
    return Entry(
        file,
        labels["frequency"],
        labels["amplitude"],
        held_out,
        key=key,
        part=part,
        channel=_channel(table.get("channel", {}), place),
        units=_units(table.get("units", {}), f"{place.removeprefix(_FILE).strip()} units"),
        cells=cells,
        span=span,
        span_text="" if cells else " ".join(str(table.get("range", "")).split()),
        step=None if rate is None else 1.0 / rate,
        beside=tuple(beside),
    )


def _files(value: object, place: str) -> list[str]:
    """Return the file's name, or those of the files that hold the channels of one test."""
    files: list[Any] = value if isinstance(value, list) and value else [value]
    for file in files:
        if not isinstance(file, str) or not file.strip():
            listed = ", or a list of those that hold one test's channels"
            expected = "a file's name" + (listed if isinstance(value, list) else "")
            raise InputError("file", expected=expected, found=shown(file), where=place)
    if len(set(files)) < len(files):
        twice = next(file for file in files if files.count(file) > 1)
        raise InputError("file", expected="each once", found=f"{shown(twice)} again", where=place)
    return files


def _part(table: Mapping[str, Any], place: str) -> tuple[str, str | int | None]:
    """Return what the part is called, and its name or number."""
    if "sheet" in table and "group" in table:
        raise InputError("sheet", expected="given without group", found="both", where=place)
    for key in ("sheet", "group"):
        value = table.get(key)
        if value is None:
            continue
        named = isinstance(value, str) and value.strip()
        numbered = isinstance(value, int) and not isinstance(value, bool)
        if not (named or numbered):
            raise InputError(
                key, expected="a name, or a number from 1", found=shown(value), where=place
            )
        return key, value
    return "group", None


def _channel(value: object, place: str) -> dict[str, str]:
    """Return this record's own headers: of the force alone, or of any column."""
    own = {"force": value} if isinstance(value, str) else value
    table = _table(own, QUANTITIES, where=f"{place.removeprefix(_FILE).strip()} channel")
    for key, header in table.items():
        if not isinstance(header, str) or not header.strip():
            raise InputError(
                f"channel.{key}", expected="a header's text", found=shown(header), where=place
            )
    return dict(table)


def _range(value: object, place: str) -> tuple[str, tuple[float | None, float | None]]:
    """Return a range of cells, or the ends of a span of time, s."""
    expected = 'a span of time as "10 s : 25 s", open as "10 s :", or cells as "B4:E900"'
    if not isinstance(value, str):
        raise InputError("range", expected=expected, found=shown(value), where=place)
    text = value.strip()
    if not text:
        return "", (None, None)
    if cell_range(text) is not None:
        return text.upper(), (None, None)
    first, colon, last = text.partition(":")
    if not colon or not (first.strip() or last.strip()):
        raise InputError("range", expected=expected, found=shown(value), where=place)
    ends = [
        quantity(end, "time", name="range", where=place) if end.strip() else None
        for end in (first, last)
    ]
    if None not in ends and not ends[0] < ends[1]:  # type: ignore[operator]  # neither is None
        raise InputError("range", expected="rising", found=shown(value), where=place)
    return "", (ends[0], ends[1])

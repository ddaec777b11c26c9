"""The numbers of a fleet that can be compared between its devices, each with all its values."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

from discover.words import term_name
from models.terms import TERMS

Row = Mapping[str, Any]
_SHAPES = ("order", "exponent")
_BOUNDARY = {"dean": "", "speed": "m/s", "frequency": "Hz"}


@dataclass(frozen=True)
class Compared:
    """A number with the values that devices have of it."""

    kind: str
    """"boundary", "shape" or "coefficient"."""
    structure: str
    """Of the bands; "" for what is no band's own."""
    name: str
    """In words."""
    unit: str
    """SI."""
    bounds: tuple[float, float]
    """What every value lies between."""
    values: tuple[Mapping[str, Any], ...]
    """``campaign``, ``band``, ``value``, ``lower`` and ``upper`` (95 %) of each."""
    between_tests: bool = False
    """Whether all that is known is the tests between which a value lies, as of a boundary, or the
    steps of a scale; such values lie over decades, so their logarithms are compared."""

    @property
    def campaigns(self) -> frozenset[str]:
        """Those that have a value."""
        return frozenset(v["campaign"] for v in self.values)


def compared(rows: Sequence[Row]) -> tuple[Compared, ...]:
    """Return every number that has an interval in a fleet's table, with all its values.

    Coefficients are compared among bands of one structure; one whose unit differs between devices,
    as that of a fractional derivative does, only among those that share it.

    Parameters
    ----------
    rows : sequence of mapping
        Of the table, see `discover.batch.table`.
    """
    found: dict[tuple[str, ...], Compared] = {}
    for number in (n for row in rows for n in _numbers(row)):
        key = (number.kind, number.structure, number.name, number.unit)
        before = found.get(key)
        found[key] = (
            number if before is None else replace(before, values=before.values + number.values)
        )
    return (*found.values(), *_boundaries(rows))


def _numbers(row: Row) -> Iterator[Compared]:
    if row["term"] is None:
        return
    where = {"campaign": row["campaign"], "band": row["band"]}
    place = row["structure"]
    name = term_name(row["term"]).partition(",")[0]
    term = TERMS[row["term"]]
    for shape in _SHAPES:
        value = _value(row, shape, f"{shape}_lower95", f"{shape}_upper95")
        if value is not None:
            ends = next((p.lower, p.upper) for p in term.parameters if p.name == shape)
            told = ({**where, **value},)
            yield Compared("shape", place, f"{shape} of {name}", "", ends, told)
    value = _value(row, "coefficient", "lower95", "upper95")
    if value is not None:
        ends = (0.0 if term.nonnegative else -math.inf, math.inf)
        told = ({**where, **value},)
        yield Compared("coefficient", place, name, row["unit"], ends, told)


def _value(row: Row, name: str, low: str, high: str) -> dict[str, float] | None:
    """Return a value with its interval; None where it was not fitted."""
    value, lower, upper = row[name], row[low], row[high]
    if value is None or lower is None or upper is None or not lower < upper:
        return None
    return {"value": value, "lower": lower, "upper": upper}


def _boundaries(rows: Sequence[Row]) -> list[Compared]:
    """Return the devices' lowest boundaries, one entry a coordinate."""
    found: dict[str, list[dict[str, Any]]] = {}
    seen = set()
    for row in rows:
        value = _value(row, "upper", "upper_lower95", "upper_upper95")
        if value is None or row["band"] != 1 or row["campaign"] in seen or value["lower"] <= 0.0:
            continue
        seen.add(row["campaign"])
        found.setdefault(row["coordinate"], []).append(
            {"campaign": row["campaign"], "band": 1, **value}
        )
    return [
        Compared(
            "boundary", "", name, _BOUNDARY.get(name, ""), (0.0, math.inf), tuple(told),
            between_tests=True,
        )
        for name, told in sorted(found.items())
    ]

"""What a fleet's answers say together: coefficients over devices, boundary, who stands apart."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy as np

from discover.batch.pooling import far_from_rest, pooled, standard_errors
from discover.words import term_name

Row = Mapping[str, Any]
_SHAPES = ("order", "exponent")
_BOUNDARY = {"dean": "", "speed": "m/s", "frequency": "Hz"}


def fleet_quantities(rows: Sequence[Row]) -> list[dict[str, Any]]:
    """Return every number that several devices have, with its values, mean, spread and outliers.

    Coefficients are compared among bands of one structure; one whose unit differs between devices,
    as that of a fractional derivative does, is compared only among those that share it. Boundaries
    are compared by their logarithms, since they lie over decades. What stands apart is left out of
    mean and spread.

    Parameters
    ----------
    rows : sequence of mapping
        Of the table, see `discover.batch.table`.
    """
    found: dict[tuple[str, ...], list[dict[str, Any]]] = {}
    for row in rows:
        for key, value in _numbers(row):
            found.setdefault(key, []).append(value)
    told = [_quantity(key, values) for key, values in found.items() if len(values) > 1]
    told += _boundaries(rows)
    kinds = ("boundary", "shape", "coefficient")
    return sorted(
        told, key=lambda q: (kinds.index(q["kind"]), -len(q["values"]), q["structure"], q["name"])
    )


def _numbers(row: Row) -> Iterable[tuple[tuple[str, ...], dict[str, Any]]]:
    where = {"campaign": row["campaign"], "band": row["band"]}
    if row["term"] is None:
        return
    place = row["structure"]
    name = term_name(row["term"]).partition(",")[0]
    for shape in _SHAPES:
        value = _value(row, shape, f"{shape}_lower95", f"{shape}_upper95")
        if value is not None:
            yield ("shape", place, f"{shape} of {name}", ""), {**where, **value}
    value = _value(row, "coefficient", "lower95", "upper95")
    if value is not None:
        yield ("coefficient", place, name, row["unit"]), {**where, **value}


def _value(row: Row, name: str, low: str, high: str) -> dict[str, float] | None:
    """Return a value with its interval; None where it was not fitted."""
    value, lower, upper = row[name], row[low], row[high]
    if value is None or lower is None or upper is None or not lower < upper:
        return None
    return {"value": value, "lower": lower, "upper": upper}


def _boundaries(rows: Sequence[Row]) -> list[dict[str, Any]]:
    """Return the devices' lowest boundaries in the same form, one entry a coordinate."""
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
        _quantity(("boundary", "", name, _BOUNDARY.get(name, "")), values)
        for name, values in sorted(found.items())
        if len(values) > 1
    ]


def _quantity(key: tuple[str, ...], values: list[dict[str, Any]]) -> dict[str, Any]:
    kind, structure, name, unit = key
    scaled = kind == "boundary"
    table = np.array([[v["value"], v["lower"], v["upper"]] for v in values])
    table = np.log(table) if scaled else table
    errors = standard_errors(table[:, 1], table[:, 2])
    apart = far_from_rest(table[:, 0], errors)
    rest = np.setdiff1d(np.arange(len(values)), [i for i, _ in apart])
    common = pooled(table[rest, 0], errors[rest])
    ends = np.array([common.mean, *common.interval])
    mean, low, high = (float(e) for e in (np.exp(ends) if scaled else ends))
    return {
        "kind": kind,
        "name": name,
        "structure": structure,
        "unit": unit,
        "mean": mean,
        "interval": [low, high],
        "spread": common.spread * (mean if scaled else 1.0),
        "values": values,
        "outliers": [
            {"campaign": values[i]["campaign"], "band": values[i]["band"],
             "value": values[i]["value"], "deviations": score}
            for i, score in apart
        ],
    }  # fmt: skip


def structure_counts(rows: Sequence[Row]) -> list[dict[str, Any]]:
    """Return which structures the campaigns have, from the lowest band up, commonest first."""
    bands: dict[str, dict[int, str]] = {}
    for row in rows:
        if row["band"] is not None:
            bands.setdefault(row["campaign"], {})[row["band"]] = row["structure"]
    counts = Counter(tuple(own[b] for b in sorted(own)) for own in bands.values())
    return [
        {"structures": list(names), "campaigns": number}
        for names, number in sorted(counts.items(), key=lambda item: (-item[1], item[0]))
    ]

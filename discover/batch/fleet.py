"""What a fleet's answers say together: coefficients over devices, boundary, who stands apart."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from typing import Any

import numpy as np

from discover.batch.compared import Compared, Row, compared
from discover.batch.pooling import far_from_rest, pooled, standard_errors


def fleet_quantities(rows: Sequence[Row]) -> list[dict[str, Any]]:
    """Return every number that several devices have, with its values, mean, spread and outliers.

    Boundaries are compared by their logarithms, since they lie over decades. What stands apart is
    left out of mean and spread.

    Parameters
    ----------
    rows : sequence of mapping
        Of the table, see `discover.batch.table`.
    """
    told = [_quantity(number) for number in compared(rows) if len(number.values) > 1]
    kinds = ("boundary", "shape", "coefficient")
    return sorted(
        told, key=lambda q: (kinds.index(q["kind"]), -len(q["values"]), q["structure"], q["name"])
    )


def _quantity(number: Compared) -> dict[str, Any]:
    values = number.values
    table = np.array([[v["value"], v["lower"], v["upper"]] for v in values])
    table = np.log(table) if number.between_tests else table
    errors = standard_errors(table[:, 1], table[:, 2])
    apart = far_from_rest(table[:, 0], errors)
    rest = np.setdiff1d(np.arange(len(values)), [i for i, _ in apart])
    common = pooled(table[rest, 0], errors[rest])
    ends = np.array([common.mean, *common.interval])
    mean, low, high = (float(e) for e in (np.exp(ends) if number.between_tests else ends))
    return {
        "kind": number.kind,
        "name": number.name,
        "structure": number.structure,
        "unit": number.unit,
        "mean": mean,
        "interval": [low, high],
        "spread": common.spread * (mean if number.between_tests else 1.0),
        "values": [dict(v) for v in values],
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

"""What pooling changed as one table: a row for each device and quantity."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import pyarrow as pa

from discover.batch.table import files_of

_TEXT, _NUMBER, _COUNT = pa.string(), pa.float64(), pa.int64()

POOLED_COLUMNS: dict[str, Any] = {
    "campaign": _TEXT,
    "band": _COUNT,
    "kind": _TEXT,
    "structure": _TEXT,
    "quantity": _TEXT,
    "unit": _TEXT,
    "alone": _NUMBER,
    "alone_lower95": _NUMBER,
    "alone_upper95": _NUMBER,
    "pooled": _NUMBER,
    "pooled_lower95": _NUMBER,
    "pooled_upper95": _NUMBER,
    "spread": _NUMBER,
    "spread_lower95": _NUMBER,
    "spread_upper95": _NUMBER,
    "agreement": _NUMBER,
}
"""Names and kinds of the columns. All numbers are SI; of the kind "probability" `alone` and
`pooled` are those of the way that `quantity` ends with, and `agreement` is that of its devices.
The spread of a boundary, or of what friction turns over, is that of its natural logarithm."""


def pooled_rows(pooling: Mapping[str, Any]) -> list[dict[str, Any]]:
    """Return the rows of ``pooled.csv``.

    Parameters
    ----------
    pooling : mapping
        As in ``batch.json``.
    """
    empty = dict.fromkeys(POOLED_COLUMNS)
    return [{**empty, **row} for row in (*_numbers(pooling), *_probabilities(pooling))]


def _numbers(pooling: Mapping[str, Any]) -> Iterator[dict[str, Any]]:
    for q in pooling["quantities"]:
        low, high = q["spread_interval"]
        for v in q["values"]:
            yield {
                "campaign": v["campaign"], "band": v["band"], "kind": q["kind"],
                "structure": q["structure"] or None, "quantity": q["name"], "unit": q["unit"],
                **_ends("alone", v["alone"]), **_ends("pooled", v["pooled"]),
                "spread": q["spread"], "spread_lower95": low, "spread_upper95": high,
            }  # fmt: skip


def _ends(name: str, told: Mapping[str, float]) -> dict[str, float]:
    return {
        name: told["value"], f"{name}_lower95": told["lower"], f"{name}_upper95": told["upper"]
    }  # fmt: skip


def _probabilities(pooling: Mapping[str, Any]) -> Iterator[dict[str, Any]]:
    for choice in pooling["choices"]:
        for v in choice["values"]:
            for way in v["ways"]:
                yield {
                    "campaign": v["campaign"], "band": v["band"], "kind": "probability",
                    "quantity": f"{choice['name']}: {way['way']}", "unit": "",
                    "alone": way["alone"], "pooled": way["pooled"],
                    "agreement": choice["agreement"],
                }  # fmt: skip


def pooled_files(rows: Sequence[Mapping[str, Any]]) -> dict[str, bytes]:
    """Return the table as ``pooled.parquet`` and ``pooled.csv``."""
    return files_of("pooled", rows, POOLED_COLUMNS)


POOLED_FILES = ("pooled.parquet", "pooled.csv")
"""Names of the table's files."""

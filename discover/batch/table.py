"""The answers of many campaigns as one table: a row for each term of each band."""

from __future__ import annotations

import io
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import pyarrow as pa
import pyarrow.csv
import pyarrow.parquet

from discover.batch.answer import Answer
from discover.friction_parts import whole_friction
from discover.shape_words import shape

_TEXT, _NUMBER, _COUNT, _TRUTH = pa.string(), pa.float64(), pa.int64(), pa.bool_()

COLUMNS: dict[str, Any] = {
    "campaign": _TEXT,
    "title": _TEXT,
    "path": _TEXT,
    "content_hash": _TEXT,
    "status": _TEXT,
    "error": _TEXT,
    "coordinate": _TEXT,
    "identifiable": _TRUTH,
    "relative_error_percent": _NUMBER,
    "held_out_relative_error_percent": _NUMBER,
    "dean_verdict": _TEXT,
    "gap_verdict": _TEXT,
    "gap_percent": _NUMBER,
    "final_gap_percent": _NUMBER,
    "effects": _TEXT,
    "band": _COUNT,
    "lower": _NUMBER,
    "upper": _NUMBER,
    "upper_lower95": _NUMBER,
    "upper_upper95": _NUMBER,
    "records": _COUNT,
    "structure": _TEXT,
    "probability": _NUMBER,
    "band_error_percent": _NUMBER,
    "noise_percent": _NUMBER,
    "remainder_percent": _NUMBER,
    "term": _TEXT,
    "extra": _TRUTH,
    "coefficient": _NUMBER,
    "lower95": _NUMBER,
    "upper95": _NUMBER,
    "unit": _TEXT,
    "order": _NUMBER,
    "order_lower95": _NUMBER,
    "order_upper95": _NUMBER,
    "exponent": _NUMBER,
    "exponent_lower95": _NUMBER,
    "exponent_upper95": _NUMBER,
    "shape": _TEXT,
}
"""Names and kinds of the columns; all numbers are SI, nothing stands where there is none."""


def table_rows(answers: Sequence[Answer]) -> list[dict[str, Any]]:
    """Return the rows of the table; a campaign that failed has one, with its error."""
    return [row for answer in answers for row in _rows(answer)]


def _rows(answer: Answer) -> Iterator[dict[str, Any]]:
    empty = dict.fromkeys(COLUMNS)
    head = {
        "campaign": answer.label, "path": answer.path, "status": answer.status,
        "error": answer.error or None, **_gap(answer.gap),
    }
    study = answer.study
    if study is None:
        yield {**empty, **head}
        return
    head |= {
        "title": study["campaign"]["title"],
        "content_hash": study["campaign"]["hash"],
        "coordinate": study["coordinate"],
        "identifiable": study["identifiable"],
        "relative_error_percent": study["relative_error_percent"],
        "held_out_relative_error_percent": study.get("held_out_relative_error_percent"),
        "dean_verdict": study["dean_check"]["verdict"],
    }
    ends = [b["interval"] for b in study["boundaries"]]
    for number, band in enumerate(study["bands"]):
        low, high = ends[number] if number < len(ends) else (None, None)
        inside = {
            "band": number + 1,
            "lower": band["lower"],
            "upper": band["upper"],
            "upper_lower95": low,
            "upper_upper95": high,
            "records": len(band["records"]),
            "structure": band["structure"],
            "probability": band["probability"],
            "band_error_percent": band["relative_error_percent"],
            "noise_percent": band["noise_percent"],
            "remainder_percent": band["remainder_percent"]["value"],
        }
        extras = [_key(e) for e in band["extras"]]
        for term in whole_friction(band["terms"]):
            yield {**empty, **head, **inside, **_term(term), "extra": _key(term) in extras}


def _key(term: Mapping[str, Any]) -> tuple[str, float]:
    return term["id"], term["coefficient"]


def _term(term: Mapping[str, Any]) -> dict[str, Any]:
    low, high = term.get("interval") or (None, None)
    told: dict[str, Any] = {
        "term": term["id"], "coefficient": term["coefficient"], "lower95": low, "upper95": high,
        "unit": term["unit"], "shape": term.get("parts") or shape(term) or None,
    }  # fmt: skip
    for name in ("order", "exponent"):
        told[name] = term.get(name)
        told[f"{name}_lower95"], told[f"{name}_upper95"] = (
            term.get(f"{name}_interval") or (None, None)
        )
    return told


def _gap(gap: Mapping[str, Any] | None) -> dict[str, Any]:
    if gap is None:
        return {}
    return {
        "gap_verdict": gap["verdict"],
        "gap_percent": gap["gap_percent"],
        "final_gap_percent": gap["final_gap_percent"],
        "effects": ", ".join(r["effect"] for r in gap["rounds"]) or None,
    }


def table_files(rows: Sequence[Mapping[str, Any]]) -> dict[str, bytes]:
    """Return the table as ``table.parquet`` and ``table.csv``."""
    return files_of("table", rows, COLUMNS)


def files_of(
    name: str, rows: Sequence[Mapping[str, Any]], columns: Mapping[str, Any]
) -> dict[str, bytes]:
    """Return rows as ``NAME.parquet`` and ``NAME.csv``.

    Parameters
    ----------
    name : str
        Of the files.
    rows : sequence of mapping
        By the columns' names.
    columns : mapping
        Names and kinds of the columns.
    """
    table = pa.Table.from_pylist([dict(r) for r in rows], schema=pa.schema(list(columns.items())))
    columnar, text = io.BytesIO(), io.BytesIO()
    pyarrow.parquet.write_table(table, columnar)
    pyarrow.csv.write_csv(table, text)
    return {f"{name}.parquet": columnar.getvalue(), f"{name}.csv": text.getvalue()}

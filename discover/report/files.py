"""What a verb writes besides its document: page, pictures in each format, tables as CSV."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from discover.plots.drawing import Drawing

Entry = Mapping[str, Any]

_TERM_KEYS = ("id", "coefficient", "std_error", "interval", "unit", "probability", "alternatives",
              "source")  # fmt: skip


def page_files(
    page: str, figures: Mapping[str, str], formats: Sequence[str] = ()
) -> dict[str, str | bytes]:
    """Return a page and its pictures by file name.

    Parameters
    ----------
    page : str
        The report.
    figures : mapping
        ``<svg>`` elements by name.
    formats : sequence of str
        Of the pictures, beside SVG: "png", "pdf".
    """
    files: dict[str, str | bytes] = {"report.html": page}
    for name, svg in figures.items():
        files[f"figures/{name}.svg"] = str(svg)
        if isinstance(svg, Drawing):
            files |= {f"figures/{name}.{kind}": svg.saved(kind) for kind in formats}
    return files


def coefficients_csv(bands: Iterable[tuple[str, Sequence[Entry]]]) -> str:
    """Return terms as CSV, a row each: band, term, coefficient, interval, unit, shape; SI.

    Parameters
    ----------
    bands : iterable of (str, sequence of mapping)
        Name of each band and its terms as in documents.

    Examples
    --------
    >>> term = {"id": "inertia", "coefficient": 60.0, "interval": [59.0, 61.0], "unit": "kg"}
    >>> print(coefficients_csv([("1", [term])]), end="")
    band,term,coefficient,lower,upper,unit
    1,inertia,60.0,59.0,61.0,kg
    """
    rows = []
    for band, terms in bands:
        for term in terms:
            low, high = term.get("interval") or (None, None)
            shape = {k: v for k, v in term.items() if k not in _TERM_KEYS and _scalar(v)}
            for key, ends in term.items():
                if key.endswith("_interval") and ends is not None:
                    stem = key.removesuffix("_interval")
                    shape |= {f"{stem}_lower": ends[0], f"{stem}_upper": ends[1]}
            rows.append({
                "band": band, "term": term["id"], "coefficient": term["coefficient"],
                "lower": low, "upper": high, "unit": term["unit"], **shape,
            })  # fmt: skip
    return table_csv(rows, ("band", "term", "coefficient", "lower", "upper", "unit"))


def table_csv(rows: Sequence[Entry], columns: Sequence[str]) -> str:
    """Return rows as CSV: the `columns`, then what else any row has; nothing for None."""
    names = list(dict.fromkeys([*columns, *(k for row in rows for k in row)]))
    text = io.StringIO()
    writer = csv.DictWriter(text, names, restval="", lineterminator="\n")
    writer.writeheader()
    writer.writerows({k: "" if v is None else v for k, v in row.items()} for row in rows)
    return text.getvalue()


def _scalar(value: object) -> bool:
    return isinstance(value, int | float | str)

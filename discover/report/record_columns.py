"""Columns of a study's table of records, in the report and in ``records.csv``: an entry each."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Literal

from markupsafe import Markup

from discover.figure_data import RecordCurves
from discover.words import kind_name, percent, significant

Value = str | float | bool | None


@dataclass(frozen=True)
class RecordColumn:
    """One column: what a record's value is, and how the report tells it."""

    name: str
    """Header in ``records.csv``."""
    value: Callable[[RecordCurves], Value]
    """Of a record, in SI as in ``records.csv``; None where it has none."""
    heading: str = ""
    """In the report; "" where only ``records.csv`` has the column. `Markup` for HTML."""
    told: Callable[[RecordCurves], str] | None = None
    """A record's cell in the report; `Markup` for HTML. None: the value to three digits."""
    style: Literal["n", "v", ""] = "n"
    """Class of its cells: "n" a number, "v" words, "" as it comes."""

    def cell(self, record: RecordCurves) -> str:
        """Return a record's cell in the report; "–" where it has no value."""
        value = self.value(record)
        if value is None:
            return "–"
        if self.told is not None:
            return self.told(record)
        return value if isinstance(value, str) else significant(value, 3)


def _kind(record: RecordCurves) -> str:
    return kind_name(record.kind) + (", held out" if record.held_out else "")


COLUMNS = (
    RecordColumn(
        "file", lambda r: r.file, "Record", lambda r: Markup("<code>{}</code>").format(r.file), "",
    ),
    RecordColumn("kind", lambda r: r.kind, "Kind", _kind, "v"),
    RecordColumn("held_out", lambda r: r.held_out),
    RecordColumn(
        "frequency", lambda r: r.frequency, "Frequency",
        lambda r: f"{significant(r.frequency, 3)} Hz",
    ),
    RecordColumn(
        "amplitude", lambda r: r.amplitude, "Amplitude",
        lambda r: f"{significant(1e3 * (r.amplitude or 0.0), 3)} mm",
    ),
    RecordColumn("band", lambda r: None if r.band is None else r.band + 1),
    RecordColumn(
        "structure", lambda r: r.structure, "Structure", lambda r: r.structure or "–", "v"
    ),
    RecordColumn("dean_paper", lambda r: r.dean_paper, "Dean, paper"),
    RecordColumn("dean_standard", lambda r: r.dean_standard, "Dean, standard"),
    RecordColumn(
        "error_percent", lambda r: r.error_percent, Markup("e<sub>d</sub>"),
        lambda r: percent(r.error_percent),
    ),
    RecordColumn(
        "relative_error_percent", lambda r: r.relative_error_percent, "‖e‖/‖F‖",
        lambda r: percent(r.relative_error_percent),
    ),
    RecordColumn(
        "noise_percent", lambda r: r.noise_percent, "Noise", lambda r: percent(r.noise_percent)
    ),
)  # fmt: skip
"""All of them, from left to right."""


def shown_columns(records: Sequence[RecordCurves]) -> list[RecordColumn]:
    """Return the columns that the report shows: those of which a record has a value."""
    return [c for c in COLUMNS if c.heading and any(c.value(r) is not None for r in records)]

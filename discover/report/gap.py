"""The gap search's report: what is missing, where it shows, and how the gap shrinks."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from discover.figure_data import GapFigureData
from discover.gap.verdict import round_text, verdict_lines
from discover.plots.gap import (
    contest,
    effect_shape,
    gap_by_record,
    gap_by_round,
    misfit_surface,
)
from discover.report.environment import render
from discover.report.files import coefficients_csv, page_files, table_csv
from discover.report.motion import motion_lines
from discover.report.records import only_drawn, picture, record_figures, record_section
from discover.shape_words import shape
from discover.words import error_lines, named_line


def gap_lines(document: Mapping[str, Any]) -> list[str]:
    """Return the answer in a few sentences, for the terminal and the head of the report.

    Parameters
    ----------
    document : mapping
        The search as in ``gap.json``.
    """
    motion = motion_lines(document["motion"]) if document.get("motion") else []
    return [*error_lines(document), *verdict_lines(document), *motion]


def gap_files(
    document: Mapping[str, Any],
    data: GapFigureData,
    *,
    command: str,
    formats: Sequence[str] = (),
) -> dict[str, str | bytes]:
    """Return page, pictures and tables of a gap search by file name.

    Parameters
    ----------
    document : mapping
        The search as in ``gap.json``.
    data : GapFigureData
        What pictures need besides.
    command : str
        What a person types to repeat it.
    formats : sequence of str
        Of the pictures, beside SVG.
    """
    figures = gap_figures(document, data)
    baseline = document["baseline"]
    parts = [(f"baseline {i}", band["terms"])
             for i, band in enumerate(baseline.get("bands") or (), start=1)]  # fmt: skip
    terms = [*(parts or [("baseline", baseline["terms"])]), ("mended", document["mended"])]
    return {
        **page_files(gap_report(document, data, figures, command=command), figures, formats),
        "coefficients.csv": coefficients_csv(terms),
        "records.csv": table_csv(document["records"], ("file", "held_out")),
    }


def gap_figures(document: Mapping[str, Any], data: GapFigureData) -> dict[str, str]:
    """Return the search's pictures by name, each one ``<svg>`` element.

    Parameters
    ----------
    document : mapping
        The search as in ``gap.json``.
    data : GapFigureData
        What the pictures need besides.
    """
    drawn: dict[str, str | None] = {
        "gap-rounds": gap_by_round(document),
        "gap-records": gap_by_record(document["records"]),
        "gap-surface": misfit_surface(data),
    }
    for number, entry in enumerate(document["rounds"], start=1):
        drawn[f"contest-{number}"] = contest(entry, name=f"contest-{number}")
    for curve in data.shapes:
        drawn[f"shape-{curve.round + 1}"] = effect_shape(curve, name=f"shape-{curve.round + 1}")
    return {**only_drawn(drawn), **record_figures(data.records)}


def gap_report(
    document: Mapping[str, Any],
    data: GapFigureData,
    figures: Mapping[str, str],
    *,
    command: str,
) -> str:
    """Return ``report.html`` of a gap search.

    Parameters
    ----------
    document : mapping
        The search as in ``gap.json``.
    data : GapFigureData
        What the tables show.
    figures : mapping
        From `gap_figures`.
    command : str
        What a person types to repeat it.
    """
    rounds = [
        {
            "entry": entry,
            "contest": picture(figures, f"contest-{number}"),
            "shape": picture(figures, f"shape-{number}"),
            "text": round_text(entry),
            "shape_text": shape({"id": entry["effect"], **entry.get("parameters", {})}),
        }
        for number, entry in enumerate(document["rounds"], start=1)
    ]
    return render(
        "gap.html",
        command=command,
        document_name="gap.json",
        document=document,
        verdict=[named_line(line) for line in gap_lines(document)],
        rounds=rounds,
        shown=record_section(data.records, figures),
        by_round=picture(figures, "gap-rounds"),
        by_record=picture(figures, "gap-records"),
        surface=picture(figures, "gap-surface"),
    )

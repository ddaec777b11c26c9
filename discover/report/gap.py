"""The gap search's report: what is missing, where it shows, and how the gap shrinks."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from markupsafe import Markup

from discover.figure_data import GapFigureData
from discover.gap.verdict import round_text, verdict_lines
from discover.plots.gap import (
    contest,
    effect_shape,
    gap_by_record,
    gap_by_round,
    gap_loops,
    misfit_surface,
    telling_records,
)
from discover.report.environment import render
from discover.report.motion import motion_lines
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


def gap_figures(document: Mapping[str, Any], data: GapFigureData) -> dict[str, str]:
    """Return the search's pictures by name, each one ``<svg>`` element.

    Parameters
    ----------
    document : mapping
        The search as in ``gap.json``.
    data : GapFigureData
        What the pictures need besides.
    """
    drawn = {
        "gap-rounds": gap_by_round(document),
        "gap-records": gap_by_record(document["records"]),
        "gap-surface": misfit_surface(data),
    }
    for number, entry in enumerate(document["rounds"], start=1):
        drawn[f"contest-{number}"] = contest(entry, name=f"contest-{number}")
    for curve in data.shapes:
        drawn[f"shape-{curve.round + 1}"] = effect_shape(curve, name=f"shape-{curve.round + 1}")
    for number, record in enumerate(telling_records(data), start=1):
        drawn[f"loops-{number}"] = gap_loops(record, name=f"loops-{number}")
    return {name: svg for name, svg in drawn.items() if svg is not None}


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

    def picture(name: str) -> Markup:
        return Markup(figures.get(name, ""))

    rounds = [
        {
            "entry": entry,
            "contest": picture(f"contest-{number}"),
            "shape": picture(f"shape-{number}"),
            "text": round_text(entry),
            "shape_text": shape({"id": entry["effect"], **entry.get("parameters", {})}),
        }
        for number, entry in enumerate(document["rounds"], start=1)
    ]
    loops = [
        {"svg": picture(f"loops-{number}"), "record": record}
        for number, record in enumerate(telling_records(data), start=1)
    ]
    return render(
        "gap.html",
        command=command,
        document_name="gap.json",
        document=document,
        verdict=[named_line(line) for line in gap_lines(document)],
        rounds=rounds,
        loops=loops,
        by_round=picture("gap-rounds"),
        by_record=picture("gap-records"),
        surface=picture("gap-surface"),
    )

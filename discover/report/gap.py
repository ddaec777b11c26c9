"""The gap search's report: what is missing, where it shows, and how the gap shrinks."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from typing import Any

from markupsafe import Markup

from discover.figure_data import GapFigureData
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
from discover.report.verdict import error_lines, named_line
from discover.report.words import listed, percent, probability, term_name

_VERDICTS = {
    "agrees": "model and measurement agree within the noise; nothing is missing",
    "closed": "the gap is closed to the noise floor",
    "reduced": "the gap is smaller, but more is left than noise",
    "unexplained": "something is missing that no effect in the catalogue explains",
}


def gap_lines(document: Mapping[str, Any]) -> list[str]:
    """Return the answer in a few sentences, for the terminal and the head of the report.

    Parameters
    ----------
    document : mapping
        The search as in ``gap.json``.
    """
    verdict = str(document["verdict"])
    names = [term_name(str(r["effect"])) for r in document["rounds"]]
    lines = error_lines(document)
    lines.append(f"Verdict: {verdict}: {_VERDICTS.get(verdict, '')}.")
    if names:
        lines.append(f"Missing: {listed(names)}.")
        for number, entry in enumerate(document["rounds"], start=1):
            lines.append(f"Round {number}: {_round(entry)}.")
    held_out = document.get("final_held_out_gap_percent")
    left = f"; {percent(held_out)} on records that were not fitted" if held_out is not None else ""
    lines.append(
        f"Gap: {percent(document['gap_percent'])} before, {percent(document['final_gap_percent'])}"
        f" after{left}; noise floor {percent(document['noise_percent'])}."
    )
    if document.get("shape"):
        lines.append(f"Left over: {document['shape']}.")
    if document.get("motion"):
        lines += motion_lines(document["motion"])
    return lines


def _round(entry: Mapping[str, Any]) -> str:
    text = f"{term_name(str(entry['effect']))} {probability(entry['probability'])}"
    others = [
        f"{term_name(str(a['effect']))} ({probability(a['probability'])})"
        for a in entry.get("alternatives", ())
        if a["effect"] != entry["effect"]
    ]
    if others:
        text += f", or {listed(others, last='or')}"
    return (
        f"{text}; gap {percent(entry['gap_before_percent'])} to"
        f" {percent(entry['gap_after_percent'])}{_corrected(entry.get('corrected'))}"
    )


def _corrected(entry: Mapping[str, Any] | None) -> str:
    """Return how far formulas alone came, where the curves of effects were corrected."""
    if entry is None:
        return ""
    counts = Counter(str(e) for e in entry["effects"])
    terms = [
        f"the curve of {term_name(name)} takes {number} more {'term' if number == 1 else 'terms'}"
        for name, number in counts.items()
    ]
    return f" ({percent(entry['gap_by_formula_percent'])} by formula; {listed(terms)})"


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
    for shape in data.shapes:
        drawn[f"shape-{shape.round + 1}"] = effect_shape(shape, name=f"shape-{shape.round + 1}")
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
            "text": _round(entry),
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

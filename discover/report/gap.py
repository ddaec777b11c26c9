"""The gap search's report: what is missing, where it shows, and how the gap shrinks."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from typing import Any

from markupsafe import Markup

from discover.figure_data import GapFigureData
from discover.gap import CLOSED
from discover.plots.gap import (
    contest,
    effect_shape,
    gap_by_record,
    gap_by_round,
    gap_loops,
    misfit_surface,
    telling_records,
)
from discover.report.environment import render, shape
from discover.report.motion import motion_lines
from discover.report.verdict import error_lines, named_line
from discover.report.words import listed, percent, probability, short_name, significant

_VERDICTS = {
    "agrees": "model and measurement agree within the noise; nothing is missing",
    "closed": "the gap is closed to the noise floor",
    "reduced": "the gap is smaller, but more is left than noise",
    "unexplained": "something is missing that no effect in the catalogue explains",
}
_BY_SHAPES = "what is left is no more than noise and what the named shapes may be wrong by"
_NOT_SHOWN = "nothing is missing that these tests would show"
_UNASKED = "something is missing that none of the effects asked for explains"
_FALLS = 0.995  # of a gap: what does not fall below it is not said to fall
_REFITTED = 1.01  # of a gap, from which the model's own coefficients are said to have closed some


def gap_lines(document: Mapping[str, Any]) -> list[str]:
    """Return the answer in a few sentences, for the terminal and the head of the report.

    Parameters
    ----------
    document : mapping
        The search as in ``gap.json``.
    """
    verdict = str(document["verdict"])
    dropped = {name for r in document["rounds"] for name in r.get("dropped", ())}
    names = [_missing(r) for r in document["rounds"] if r["effect"] not in dropped]
    lines = error_lines(document)
    lines.append(f"Verdict: {verdict}: {_said(document, verdict)}.")
    if names:
        lines.append(f"Missing: {listed(names)}.")
        for number, entry in enumerate(document["rounds"], start=1):
            lines.append(f"Round {number}: {_round(entry)}.")
    held_out = document.get("final_held_out_gap_percent")
    left = f"; {percent(held_out)} on records that were not fitted" if held_out is not None else ""
    lines.append(f"Gap: {_gaps(document)}{left}; noise floor {percent(document['noise_percent'])}.")
    if document.get("shape"):
        lines.append(f"Left over: {document['shape']}.")
    if document.get("motion"):
        lines += motion_lines(document["motion"])
    return lines


def _said(document: Mapping[str, Any], verdict: str) -> str:
    over = document["final_gap_percent"] / max(document["noise_percent"], 1e-300)
    if verdict == "closed" and over > CLOSED:
        return _BY_SHAPES
    if verdict == "agrees" and over > CLOSED:
        return f"{_NOT_SHOWN} (the gap is {significant(over, 2)} times the noise; see the notes)"
    said = _VERDICTS.get(verdict, "")
    if verdict == "unexplained":
        said = _UNASKED if document.get("effects") else said
        return f"{said} (the gap is {significant(over, 2)} times the noise)"
    return said


def _gaps(document: Mapping[str, Any]) -> str:
    """Return the gap as the model was given, refitted, and with what was added."""
    given, final = document["gap_percent"], document["final_gap_percent"]
    rounds = document["rounds"]
    begun = rounds[0]["gap_before_percent"] if rounds else final
    parts = [f"{percent(given)} {'before' if begun * _REFITTED > given else 'as given'}"]
    if begun * _REFITTED <= given:
        parts.append(f"{percent(begun)} with the model's own coefficients refitted")
    if rounds:
        parts.append(f"{percent(final)} after")
    return ", ".join(parts)


def _missing(entry: Mapping[str, Any]) -> str:
    """Return a name with what it can't be told apart from."""
    same = [short_name(str(e)) for e in entry.get("not_distinguishable_from") or ()]
    apart = f" (or {listed(same, last='or')}: not told apart)" if same else ""
    return f"{short_name(str(entry['effect']))} {probability(entry['probability'])}{apart}"


def _round(entry: Mapping[str, Any]) -> str:
    text = f"{short_name(str(entry['effect']))} {probability(entry['probability'])}"
    if entry.get("dropped"):
        text += f" instead of {listed([short_name(str(e)) for e in entry['dropped']])}"
    others = [
        f"{short_name(str(a['effect']))} ({probability(a['probability'])})"
        for a in entry.get("alternatives", ())
        if a["effect"] != entry["effect"]
    ]
    if others:
        text += f", or {listed(others, last='or')}"
    return (
        f"{text}; gap {percent(entry['gap_before_percent'])} to"
        f" {percent(entry['gap_after_percent'])}{_alike(entry)}"
        f"{_corrected(entry.get('corrected'))}"
    )


def _alike(entry: Mapping[str, Any]) -> str:
    """Return what a round gains with every record counting alike, where the pooled gap hides it."""
    if entry["gap_after_percent"] <= _FALLS * entry["gap_before_percent"]:
        return ""
    before, after = (entry[f"rms_record_gap_{at}_percent"] for at in ("before", "after"))
    return f" pooled, {percent(before)} to {percent(after)} with every record counting alike"


def _corrected(entry: Mapping[str, Any] | None) -> str:
    """Return how far formulas alone came, where the curves of effects were corrected."""
    if entry is None:
        return ""
    counts = Counter(str(e) for e in entry["effects"])
    terms = [
        f"the curve of {short_name(name)} takes {number} more {'term' if number == 1 else 'terms'}"
        for name, number in counts.items()
    ]
    if entry.get("reversal"):
        terms.append("friction reverses along a curve of its own")
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
            "text": _round(entry),
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

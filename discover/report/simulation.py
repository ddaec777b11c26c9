"""Predicted forces: lines for the terminal, models best first, and the page."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from discover.figure_data import SimulatedRecord
from discover.plots.model_errors import model_errors
from discover.report.environment import render
from discover.report.files import page_files
from discover.report.records import only_drawn, picture, record_figures, record_section
from discover.words import counted, model_names, named_line, percent


def simulation_files(
    document: Mapping[str, Any],
    records: Sequence[SimulatedRecord],
    *,
    command: str,
    formats: Sequence[str] = (),
) -> dict[str, str | bytes]:
    """Return page and pictures of a simulation by file name.

    Parameters
    ----------
    document : mapping
        As in ``simulation.json``.
    records : sequence of SimulatedRecord
        In the campaign's order.
    command : str
        What a person types to repeat it.
    formats : sequence of str
        Of the pictures, beside SVG.
    """
    ranked = sorted(document["models"], key=lambda m: int(m["rank"]))
    names = model_names([m["name"] for m in ranked])
    named = [{**m, "name": name} for m, name in zip(ranked, names, strict=True)]
    errors = {"errors": model_errors(named, name="errors")}
    figures = {**only_drawn(errors), **record_figures(records)}
    page = render(
        "simulation.html",
        command=command,
        document_name="simulation.json",
        document=document,
        verdict=[named_line(line) for line in simulation_lines({**document, "models": named})],
        ranked=[{**m, "given": g["name"]} for m, g in zip(named, ranked, strict=True)],
        records=records,
        held_out=any(r.held_out for r in records),
        errors=picture(figures, "errors"),
        shown=record_section(records, figures),
    )
    return page_files(page, figures, formats)


def simulation_lines(document: Mapping[str, Any]) -> list[str]:
    """Return the ranking and what a person should know of it.

    Parameters
    ----------
    document : mapping
        The comparison as in ``simulation.json``.
    """
    lines = []
    for model in sorted(document["models"], key=lambda m: int(m["rank"])):
        fitted = model["relative_error_percent"]
        unseen = model["held_out_relative_error_percent"]
        parts = []
        if unseen is not None:
            parts.append(f"{percent(unseen)} of the force on held-out records")
        if fitted is not None:
            others = "the others" if unseen is not None else "all records"
            parts.append(f"{percent(fitted)} on {others}")
        lines.append(f"{model['rank']}. {model['name']}: misses " + ", ".join(parts) + ".")
    records = counted(len(document["models"][0]["records"]), "record")
    lines.append(f"Noise: {percent(document['noise_percent'])} of the force ({records}).")
    for finding in document["findings"]:
        lines.append(f"{str(finding['level']).capitalize()}: {finding['text']}")
    return lines

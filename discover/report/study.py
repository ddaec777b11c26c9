"""The study's report: one page that needs nothing else, and its pictures as files."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from markupsafe import Markup

from discover.figure_data import StudyFigureData
from discover.plots.errors import error_by_record
from discover.plots.probabilities import probability_bars
from discover.plots.record_map import record_map
from discover.report.environment import render
from discover.report.files import coefficients_csv, page_files, table_csv
from discover.report.record_columns import COLUMNS, shown_columns
from discover.report.records import only_drawn, picture, record_figures, record_section
from discover.study.extras_words import extras
from discover.study.verdict import (
    boundary_text,
    friction_text,
    next_purpose,
    structure_name,
    verdict_lines,
)
from discover.words import coordinate_name, named_line, odds, remainder_text, significant


def study_files(
    document: Mapping[str, Any],
    data: StudyFigureData,
    *,
    command: str,
    formats: Sequence[str] = (),
) -> dict[str, str | bytes]:
    """Return page, pictures and tables of a study by file name.

    Parameters
    ----------
    document : mapping
        The study as in ``study.json``.
    data : StudyFigureData
        What pictures and tables need besides.
    command : str
        What a person types to repeat the study.
    formats : sequence of str
        Of the pictures, beside SVG.
    """
    figures = study_figures(document, data)
    page = study_report(document, data, figures, command=command)
    bands = [(str(i), band["terms"]) for i, band in enumerate(document["bands"], start=1)]
    records = [{column.name: column.value(r) for column in COLUMNS} for r in data.records]
    return {
        **page_files(page, figures, formats),
        "coefficients.csv": coefficients_csv(bands),
        "records.csv": table_csv(records, [column.name for column in COLUMNS]),
    }


def study_figures(document: Mapping[str, Any], data: StudyFigureData) -> dict[str, str]:
    """Return the study's pictures by name, each one ``<svg>`` element.

    Parameters
    ----------
    document : mapping
        The study as in ``study.json``.
    data : StudyFigureData
        What the pictures need besides.
    """
    drawn: dict[str, str | None] = {
        "map": record_map(document, data),
        "probabilities": probability_bars(document, data),
    }
    for number, svg in enumerate(error_by_record(data), start=1):
        drawn[f"errors-{number}"] = svg
    return {**only_drawn(drawn), **record_figures(data.records)}


def study_report(
    document: Mapping[str, Any],
    data: StudyFigureData,
    figures: Mapping[str, str],
    *,
    command: str,
) -> str:
    """Return ``report.html``: self-contained, the verdict first.

    Parameters
    ----------
    document : mapping
        The study as in ``study.json``.
    data : StudyFigureData
        What the tables of records and methods show.
    figures : mapping
        From `study_figures`.
    command : str
        What a person types to repeat the study.
    """
    boundaries = [boundary_text(b, document) for b in document.get("boundaries", ())]
    verdict = [named_line(line) for line in verdict_lines(document)]
    check = {"boundary_dean": None, "amplitude_exponent": None, "reason": ""}
    bands = [
        {
            "band": band,
            "name": structure_name(band),
            "friction": friction_text(band),
            "remainder": remainder_text(left) if (left := band.get("remainder_percent")) else "",
        }
        for band in document["bands"]
    ]
    return render(
        "study.html",
        command=command,
        document_name="study.json",
        document=document,
        verdict=verdict,
        figures={name: picture(figures, name) for name in ("map", "probabilities")},
        errors=[Markup(svg) for name, svg in figures.items() if name.startswith("errors-")],
        map_caption=_map_caption(document, data),
        boundaries=boundaries,
        bands=bands,
        extras=extras(document),
        shown=record_section(data.records, figures),
        records=data.records,
        held_out=sum(r.held_out for r in data.records),
        coordinate=coordinate_name(document),
        all_terms=[t for band in document["bands"] for t in band["terms"]],
        record_columns=shown_columns(data.records),
        baselines=data.baselines,
        check={**check, **document["dean_check"]},
        has_fluid=document["dean_check"]["verdict"] != "no-geometry",
        next_test=_next(document),
    )


def _map_caption(document: Mapping[str, Any], data: StudyFigureData) -> str:
    text = "Each mark is one sine test, its colour and shape the structure of its band."
    if document.get("boundaries"):
        text += " The line is the boundary, the shade its interval."
    if data.dean_per_speed_paper:
        convention = document["dean_check"]["convention"]
        text += f" Dotted: constant Dean number, {convention} convention."
    return text


def _next(document: Mapping[str, Any]) -> str:
    test = document.get("next_test")
    if not test or test.get("frequency_hz") is None:
        return ""
    text = (
        f"Run one more sine test at {significant(test['frequency_hz'], 3)} Hz and "
        f"{significant(1e3 * test['amplitude_m'], 3)} mm"
    )
    purpose = next_purpose(test)
    if purpose:
        text += f". Of all tests within the limits it best {purpose}"
    if test.get("gain") is not None and len(set(test["separates"])) > 1:
        text += f" (expected odds of the right one: {odds(test['gain'])})"
    return text + ". Then run the command below on the campaign with that record added."

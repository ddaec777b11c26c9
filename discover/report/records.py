"""The part on records that every page has: loops or stretches, stiffness, what is left."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from markupsafe import Markup

from discover.figure_data import RecordCurves, ShownRecord
from discover.plots.loops import MOST_LOOPS, all_loops, record_curves
from discover.plots.representative import representative
from discover.plots.residuals import over_tests, residual
from discover.plots.stiffness import stiffness
from discover.words import percent, significant

Figures = Mapping[str, str]


def only_drawn(figures: Mapping[str, str | None]) -> dict[str, str]:
    """Return the pictures that there is something to draw of."""
    return {name: svg for name, svg in figures.items() if svg is not None}


def picture(figures: Figures, name: str) -> Markup:
    """Return a picture for a template, nothing where it was not drawn."""
    return Markup(figures.get(name, ""))


def record_figures(records: Sequence[ShownRecord]) -> dict[str, str]:
    """Return the pictures of records by name, each one ``<svg>`` element.

    Parameters
    ----------
    records : sequence of ShownRecord
        In the campaign's order.
    """
    drawn: dict[str, str | None] = {
        "stiffness": stiffness(records, name="stiffness"),
        "all-loops": all_loops(records, name="all-loops"),
        "over-tests": over_tests(records, name="over-tests"),
    }
    for number, record in enumerate(representative(records), start=1):
        drawn[f"loops-{number}"] = record_curves(record, name=f"loops-{number}")
        drawn[f"left-{number}"] = residual(record, name=f"left-{number}")
    return only_drawn(drawn)


def record_section(records: Sequence[ShownRecord], figures: Figures) -> dict[str, Any]:
    """Return what the macro ``records`` shows.

    Parameters
    ----------
    records : sequence of ShownRecord
        As `record_figures` took them.
    figures : mapping
        What it gave, others among it.
    """
    shown = list(enumerate(representative(records), start=1))
    sines = any(r.frequency is not None for r in records)
    wide = any(r.frequency is None for r in records)
    return {
        "loops": [
            {"svg": picture(figures, f"loops-{i}"), "heading": _heading(r), "caption": _caption(r)}
            for i, r in shown
        ],
        "residuals": [
            {"svg": picture(figures, f"left-{i}"), "heading": _heading(r), "caption": _left(r)}
            for i, r in shown
            if f"left-{i}" in figures
        ],
        "stiffness": picture(figures, "stiffness"),
        "stiffness_caption": _stiffness_caption(records, sines=sines, wide=wide),
        "all_loops": picture(figures, "all-loops"),
        "loops_caption": _loops_caption(records),
        "over_tests": picture(figures, "over-tests"),
        "over_tests_caption": _over_tests_caption(records),
        "wide": wide,
    }


def _loops_caption(records: Sequence[ShownRecord]) -> str:
    sines = sum(r.frequency is not None and bool(r.force.size) for r in records)
    of = "each sine test" if sines <= MOST_LOOPS else f"{MOST_LOOPS} of the {sines} sine tests"
    return f"One cycle of {of}, dark slow, light fast; the model dashed."


def _heading(record: ShownRecord) -> str:
    if record.frequency and record.amplitude:
        return f"{significant(record.frequency, 3)} Hz, {significant(1e3 * record.amplitude, 3)} mm"
    return record.file


def _caption(record: ShownRecord) -> str:
    parts = []
    if isinstance(record, RecordCurves) and record.structure:
        parts.append(record.structure)
    if record.held_out:
        parts.append("held out")
    for (label, _), error in zip(record.predictions, record.errors_percent, strict=True):
        if error is not None:
            name = "error" if label == "model" else label
            parts.append(f"{name} {percent(error)} of ‖force‖")
    if record.noise_percent is not None:
        parts.append(f"noise {percent(record.noise_percent)}")
    if isinstance(record, RecordCurves) and record.dean_paper is not None:
        parts.append(
            f"De {significant(record.dean_paper, 3)} (paper), "
            f"{significant(record.dean_standard, 3)} (standard convention)"
        )
    return " · ".join(parts)


def _left(record: ShownRecord) -> str:
    """Return what is said under the picture of what is left, by the first model."""
    (label, _), response = record.predictions[0], record.responses[0]
    parts = []
    if response.error_over_noise is not None:
        parts.append(f"{significant(response.error_over_noise, 3)} times the noise")
    if response.correlation.size:
        parts.append(
            f"{percent(response.outside_percent)} of the correlations lie outside the grey band, "
            f"5{chr(0x202F)}% expected of white noise"
        )
    return ("" if label == "model" else f"{label}: ") + "; ".join(parts)


def _first_model(records: Sequence[ShownRecord]) -> str:
    """Return the model that pictures of many records show, in words."""
    first = next((r.predictions[0][0] for r in records if r.predictions), "model")
    return {"model": "the model", "after": "the mended model"}.get(first, f"the model {first}")


def _over_tests_caption(records: Sequence[ShownRecord]) -> str:
    return (
        f"Above: what {_first_model(records)} leaves of the force, over the noise; 1 where only "
        "noise is left. Below: by how much the measured force is greater than the model's; a trend "
        "from test to test is drift, for instance of temperature."
    )


def _stiffness_caption(records: Sequence[ShownRecord], *, sines: bool, wide: bool) -> str:
    parts = []
    if sines:
        parts.append("Sine tests, each at its own frequency, one colour for each amplitude: rings "
                     f"are measured, crosses and dashes are {_first_model(records)}")  # fmt: skip
    if wide:
        parts.append(f"{'Other records' if sines else 'Records'} by Welch's method, at the "
                     f"frequencies that the motion holds: measured whole, {_first_model(records)} "
                     "dashed. The coherence of displacement and measured force is 1 where the one "
                     "alone makes the other")  # fmt: skip
    return ". ".join(parts) + "."

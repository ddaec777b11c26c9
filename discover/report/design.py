"""The rough design's report."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from markupsafe import Markup

from discover.plots.design import prices, sections
from discover.plots.design_front import design_front
from discover.report.environment import render
from discover.words import listed, named_line, significant

_ROWS = (
    ("cylinder_radius", "Cylinder radius", 1e3, "mm"),
    ("rod_radius", "Rod radius", 1e3, "mm"),
    ("channel_radius", "Channel radius", 1e3, "mm"),
    ("helix_radius", "Helix radius", 1e3, "mm"),
    ("helix_pitch", "Helix pitch", 1e3, "mm"),
    ("turns", "Turns", 1.0, ""),
    ("transition_length", "Transition sections, each", 1e3, "mm"),
)
_JUDGED = (
    ("inertance", "Inertance", 1.0, "kg"),
    ("parasitic_damping", "Parasitic damping", 1.0, "N s/m"),
    ("inertial_corner_hz", "Inertia exceeds viscous damping above", 1.0, "Hz"),
    ("peak_pressure", "Peak pressure", 1e-6, "MPa"),
    ("channel_length", "Channel length", 1.0, "m"),
)


def design_lines(document: Mapping[str, Any]) -> tuple[str, ...]:
    """Return the answer in a few sentences, for the terminal and the head of the report."""
    own = document["baseline"]["critical_frequency_hz"]
    if not document["feasible"]:
        names = [str(c["name"]) for c in document["conflicts"]]
        ease = [
            f"{c['name']} of {significant(c['needed'])} {c['unit']}"
            for c in document["conflicts"]
            if c["needed"] is not None
        ]
        return (
            f"Design: nothing fits; {listed(names)} keep every design out.",
            f"Way out: {listed(ease, last='or')} would admit one."
            if ease
            else "Way out: no single bound, eased alone, admits a design.",
        )
    found = document["critical_frequency_hz"]
    held = [str(b["name"]) for b in document["active_bounds"]]
    return (
        f"Design: critical frequency {significant(found['paper'], 3)} Hz by the paper's Dean "
        f"number ({significant(found['standard'], 3)} Hz by the standard one), "
        f"{significant(document['improvement'], 3)} times lower than the baseline's "
        f"{significant(own['paper'], 3)} Hz.",
        f"Inertance: {significant(document['inertance'])} kg; parasitic damping "
        f"{significant(document['parasitic_damping'], 3)} N s/m against "
        f"{significant(document['baseline']['parasitic_damping'], 3)}.",
        f"Held by: {listed(held) if held else 'no bound'}.",
        *([f"On the rig: {document['loop']['text']}"] if document.get("loop") else []),
    )


def design_figures(document: Mapping[str, Any]) -> dict[str, str]:
    """Return the design's pictures by name, each one ``<svg>`` element."""
    drawn = {
        "sections": sections(document),
        "front": design_front(document),
        "prices": prices(document),
    }
    return {name: svg for name, svg in drawn.items() if svg is not None}


def design_report(document: Mapping[str, Any], figures: Mapping[str, str], *, command: str) -> str:
    """Return ``report.html`` of a rough design.

    Parameters
    ----------
    document : mapping
        The design as in ``design.json``.
    figures : mapping
        From `design_figures`.
    command : str
        What a person types to repeat it.
    """
    best, baseline = document if document["feasible"] else None, document["baseline"]
    rows = [
        (label, unit, _value(baseline["geometry"], key, scale), _best(best, "geometry", key, scale))
        for key, label, scale, unit in _ROWS
    ]
    rows += [
        (
            label,
            unit,
            _value(baseline, key, scale),
            "–" if best is None else _value(best, key, scale),
        )
        for key, label, scale, unit in _JUDGED
    ]
    rows += [
        (
            f"Critical frequency, {convention} convention",
            "Hz",
            significant(baseline["critical_frequency_hz"][convention]),
            "–" if best is None else significant(best["critical_frequency_hz"][convention]),
        )
        for convention in ("paper", "standard")
    ]
    verdict = [named_line(line) for line in design_lines(document)]
    return render(
        "design.html",
        command=command,
        document_name="design.json",
        document=document,
        verdict=verdict,
        rows=rows,
        front=Markup(figures.get("front", "")),
        sections=Markup(figures["sections"]),
        prices=Markup(figures["prices"]),
        turbulent=best is not None and best["turbulent_at_duty"],
    )


def _value(table: Mapping[str, Any], key: str, scale: float) -> str:
    return significant(scale * table[key])


def _best(point: Mapping[str, Any] | None, group: str, key: str, scale: float) -> str:
    return "–" if point is None else _value(point[group], key, scale)

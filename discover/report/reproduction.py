"""The report of the paper reproduced: verdicts first, then tables, figures and every claim."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from markupsafe import Markup

from discover.plots.reproduction import order_figure, paper_figure, table_3_figure
from discover.report.environment import render
from discover.reproduction import Reproduction
from discover.words import counted, significant

_GROUPS = (
    ("not-reproduced", "Not borne out by its own formulas"),
    ("unverifiable", "Can't be checked"),
    ("reproduced", "Reproduced"),
)
# Those that decide what the paper's conclusions rest on, where they don't hold, in short.
_DECISIVE = {
    "m1-below-boundary": "its ultra-low model was identified above its own boundary",
    "figure-8": "that model is not the closer one below the boundary",
    "one-record": "one record at one frequency can't show a fractional law",
    "inertia-above-boundary": "De = 100 is not where inertia overtakes viscosity",
    "low-means-inertial": "a lower critical frequency doesn't mean more inertia",
}


def reproduction_figures(result: Reproduction) -> dict[str, str]:
    """Return the pictures by name, each one ``<svg>`` element."""
    drawn = {f"figure-{figure.number}": paper_figure(figure) for figure in result.figures}
    drawn["table-3"] = table_3_figure(result.comparisons)
    drawn["orders"] = order_figure(result.curve, result.orders)
    return drawn


def reproduction_lines(result: Reproduction) -> tuple[str, ...]:
    """Return the answer in a few sentences, for the terminal and the head of the report."""
    counts = result.counts
    near = sum(row.distance <= 0.1 for row in result.comparisons)
    far = [row.printed.condition.label for row in result.comparisons if row.distance > 0.1]
    failed = {claim.id for claim in result.claims if claim.verdict == "not-reproduced"}
    against = [text for name, text in _DECISIVE.items() if name in failed]
    lines = [
        f"Claims: {counts['reproduced']} of {len(result.claims)} reproduced, "
        f"{counts['not-reproduced']} not reproduced, {counts['unverifiable']} can't be checked.",
        *([f"Against it: {'; '.join(against)}."] if against else []),
        f"Table 3: {near} of {counted(len(result.comparisons), 'row')} within 0.1 points of what "
        f"the printed rounding allows; not {', '.join(far)}.",
    ]
    if result.identification:
        fewest = min(row.fewer for row in result.identification)
        worst = max(row.difference for row in result.identification)
        lines.append(
            f"Identification: variable projection meets the genetic algorithm to "
            f"{significant(worst, 1)} with at least {fewest:.0f} times fewer evaluations."
        )
    lines.append("Table 2: quoted only, its measurements are not public.")
    return tuple(lines)


def reproduction_report(
    result: Reproduction, figures: Mapping[str, str], *, command: str
) -> str:
    """Return ``report.html`` of the reproduction.

    Parameters
    ----------
    result : Reproduction
        What was recomputed.
    figures : mapping
        From `reproduction_figures`.
    command : str
        What a person types to repeat it.
    """
    lines = reproduction_lines(result)
    return render(
        "reproduction.html",
        command=command,
        document_name="reproduction.json",
        document=result.to_dict(),
        verdict=[_split(line) for line in lines],
        groups=[
            {
                "verdict": name,
                "title": title,
                "claims": [
                    {
                        **claim.to_dict(),
                        "printed": _value(claim.printed),
                        "computed": _value(claim.computed),
                    }
                    for claim in result.claims
                    if claim.verdict == name
                ],
            }
            for name, title in _GROUPS
        ],
        figures={name: Markup(svg) for name, svg in figures.items()},
        captions=[
            {
                "name": f"figure-{f.number}",
                "number": f.number,
                "caption": f.caption,
                "wide": len(f.panels) > 1,
            }
            for f in result.figures
        ],
        identification=[
            {**row.to_dict(), "seconds": (row.evolution.seconds, row.projection.seconds)}
            for row in result.identification
        ],
    )


def _split(line: str) -> tuple[str, str]:
    name, _, text = line.partition(": ")
    return name, text[:1].upper() + text[1:]


def _value(value: Any) -> str:
    if isinstance(value, float | int):
        return "0" if abs(value) < 1e-12 else significant(float(value), 5)
    return "–" if value is None else str(value)

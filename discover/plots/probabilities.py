"""How probable each structure is, band by band."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from discover.figure_data import StudyFigureData
from discover.plots.style import (
    INK,
    MUTED,
    STRUCTURE_COLOURS,
    house_style,
    legend_above,
    new_figure,
)
from discover.plots.svg import to_svg

_VISIBLE = 0.004  # of the bar's length: about two pixels


def probability_bars(document: Mapping[str, Any], data: StudyFigureData) -> str | None:
    """Draw one stacked bar a band, or return None where nothing was weighed.

    Structures that the data can't rule out are named on their part of the bar.

    Parameters
    ----------
    document : mapping
        The study as in ``study.json``.
    data : StudyFigureData
        Its `probabilities`; where empty, those in the document's bands stand in.
    """
    weighed = _weighed(document, data)
    if not any(weighed):
        return None
    with house_style():
        figure = new_figure(660, 92 + 58 * len(weighed))
        axes = figure.add_subplot()
        labelled: set[str] = set()
        for band, parts in enumerate(weighed):
            left = 0.0
            for structure, probability in parts:
                visible = probability >= _VISIBLE
                colour = STRUCTURE_COLOURS.get(structure, STRUCTURE_COLOURS["other"])
                axes.barh(
                    band,
                    probability,
                    left=left,
                    height=0.62,
                    color=colour,
                    edgecolor="white",
                    linewidth=1.0,
                    label=structure if structure not in labelled and visible else None,
                )
                if visible:
                    labelled.add(structure)
                if probability > 0.09:
                    text = "> 99 %" if probability > 0.995 else f"{100.0 * probability:.0f} %"
                    middle = left + probability / 2.0
                    axes.text(
                        middle,
                        band,
                        text,
                        ha="center",
                        va="center",
                        color="white",
                        fontsize=10.5,
                        fontweight="bold",
                    )
                left += probability
        axes.set_xlim(0.0, 1.0)
        axes.set_ylim(len(weighed) - 0.5, -0.5)
        axes.set_xticks([0.0, 0.25, 0.5, 0.75, 1.0], ["0", "25", "50", "75", "100"])
        axes.set_yticks(range(len(weighed)), [f"Band {i + 1}" for i in range(len(weighed))])
        axes.tick_params(axis="y", length=0, labelsize=11, labelcolor=INK)
        axes.tick_params(axis="x", colors=MUTED)
        axes.grid(visible=False, axis="y")
        axes.spines["left"].set_visible(False)
        axes.set_xlabel("Probability of the structure (%)")
        legend_above(figure, ncols=4, handlelength=1.0, columnspacing=1.2)
        return to_svg(figure, name="probabilities", title="Probability of each structure by band")


def _weighed(document: Mapping[str, Any], data: StudyFigureData) -> list[list[tuple[str, float]]]:
    """Return (structure, probability) by band, the most probable first."""
    result: list[list[tuple[str, float]]] = []
    for index, band in enumerate(document.get("bands", ())):
        parts = [(p.structure, p.probability) for p in data.probabilities if p.band == index]
        if not parts:
            stated = {
                str(e["structure"]): float(e["probability"])
                for e in (*band.get("equivalents", ()), band)
                if e.get("probability") is not None
            }
            parts = list(stated.items())
        result.append(sorted(parts, key=lambda part: -part[1]))
    return result

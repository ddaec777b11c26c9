"""Coefficients of several answers side by side, with their intervals."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from discover.plots.style import INK, MUTED, house_style, legend_above, new_figure, prediction_look
from discover.plots.svg import series, to_svg
from discover.words import zero_possible

_ROW = 15.0  # CSS pixels of one answer
_MARKERS = "osD^vPX"


def side_by_side(
    quantities: Sequence[Mapping[str, Any]], names: Sequence[str], *, labels: Sequence[str]
) -> str | None:
    """Draw quantities relative to their middle, with intervals, as one ``<svg>``; None for none.

    Parameters
    ----------
    quantities : sequence of mapping
        As in ``comparison.json``; left out are those that only one answer has, those that may be
        nothing in one (against these the others' intervals would be too short to see), and those
        that are the same number without an interval in all.
    names : sequence of str
        Of the answers.
    labels : sequence of str
        Of the quantities.
    """
    rows = [
        (label, q["values"])
        for label, q in zip(labels, quantities, strict=True)
        if sum(v is not None for v in q["values"]) > 1 and _comparable(q["values"])
    ]
    if not rows:
        return None
    step = 1.0 / (len(names) + 1)
    with house_style():
        figure = new_figure(620, 110 + _ROW * max(len(names) + 1, 3) * len(rows))
        axes = figure.add_subplot()
        axes.axvline(0.0, color=MUTED, linewidth=0.8)
        for number, name in enumerate(names):
            look = prediction_look("", number)
            places, middles, ends = [], [], []
            for row, (_, values) in enumerate(rows):
                value = values[number]
                if value is None:
                    continue
                middle = float(np.mean([v["value"] for v in values if v is not None]))
                percents = [100.0 * (v / middle - 1.0) for v in
                            (value["value"], *(value["interval"] or (value["value"],) * 2))]
                places.append(row + (number + 1) * step)
                middles.append(percents[0])
                ends.append(sorted(percents[1:]))
            lines = axes.plot(
                middles, places, linestyle="none", marker=_MARKERS[number % len(_MARKERS)],
                markersize=6.0, color=look["color"], label=name,
            )  # fmt: skip
            for place, (low, high) in zip(places, ends, strict=True):
                lines += axes.plot([low, high], [place, place], color=look["color"], linewidth=1.6)
            series(lines, name)
        axes.set_ylim(len(rows), 0.0)
        # The band on a line of its own: beside the name it leaves the axes no room.
        axes.set_yticks(
            [r + 0.5 for r in range(len(rows))], [t.replace(" (", "\n(") for t, _ in rows]
        )
        axes.tick_params(axis="y", length=0, labelcolor=INK)
        axes.grid(visible=False, axis="y")
        for edge in range(1, len(rows)):
            axes.axhline(edge, color="#e3e8ee", linewidth=0.8)
        axes.set_xlabel("From the mean (%)")
        handles, legend = axes.get_legend_handles_labels()
        legend_above(figure, handles, legend, ncols=3)
        return to_svg(figure, name="side-by-side", title="Coefficients side by side")


def _comparable(values: Sequence[Mapping[str, Any] | None]) -> bool:
    """Return whether numbers have one unit, a mean that stands apart from nought, and a size."""
    there = [v for v in values if v is not None]
    if any(zero_possible(v["interval"]) for v in there):
        return False
    sizes = [abs(v["value"]) for v in there]
    if all(v["interval"] is None for v in there) and max(sizes) == min(sizes):
        return False
    mean = abs(float(np.mean([v["value"] for v in there])))
    return len({v["unit"] for v in there}) == 1 and mean > 0.2 * max(sizes)

"""The rough design's trade-off: critical frequency against parasitic damping."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from discover.plots.style import (
    ACCENT,
    INK,
    MODEL,
    house_style,
    legend_above,
    new_figure,
    plain_log_axis,
)
from discover.plots.svg import to_svg

_COLOURS = ("#56b4e9", ACCENT, "#009e73", "#8d5aa6", "#e69f00")
_MARKERS = ("v", "o", "^", "s", "D")


def design_front(document: Mapping[str, Any]) -> str | None:
    """Draw the front by inertance, the baseline and the best design; None where there is no front.

    Parameters
    ----------
    document : mapping
        The design as in ``design.json``.
    """
    front = document.get("front") or ()
    if not front:
        return None
    with house_style():
        figure = new_figure(620, 420)
        axes = figure.add_subplot()
        axes.set(xscale="log", yscale="log")
        groups: dict[float, list[Mapping[str, Any]]] = {}
        for point in front:
            groups.setdefault(float(f"{point['inertance']:.3g}"), []).append(point)
        for index, (inertance, points) in enumerate(sorted(groups.items())):
            points.sort(key=lambda p: p["parasitic_damping"])
            axes.plot(
                [p["parasitic_damping"] for p in points],
                [p["critical_frequency_hz"]["paper"] for p in points],
                marker=_MARKERS[index % len(_MARKERS)],
                color=_COLOURS[index % len(_COLOURS)],
                label=f"{inertance:g} kg",
                linewidth=1.2,
            )
        for point, colour, label in (
            (document["baseline"], INK, "baseline"),
            (document if document["feasible"] else None, MODEL, "best"),
        ):
            if point is not None:
                axes.plot(
                    [point["parasitic_damping"]],
                    [point["critical_frequency_hz"]["paper"]],
                    "*",
                    markersize=14,
                    color=colour,
                    label=label,
                    zorder=4,
                )
        axes.set_xlabel("Parasitic damping at the duty's peak speed (N s/m)")
        axes.set_ylabel("Critical frequency (Hz)")
        plain_log_axis(axes, which="x")
        plain_log_axis(axes, which="y")
        legend_above(figure, ncols=5, columnspacing=1.2)
        title = "Trade-off of critical frequency, inertance and damping"
        return to_svg(figure, name="front", title=title)

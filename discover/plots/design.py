"""Pictures of a rough design: section through the device, what each bound costs."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Circle, Rectangle

from discover.plots.style import (
    ACCENT,
    GRID,
    INK,
    MODEL,
    MUTED,
    house_style,
    new_figure,
)
from discover.plots.svg import to_svg


def sections(document: Mapping[str, Any]) -> str:
    """Draw sections through baseline and designed device, on one scale."""
    shown = [("Baseline", document["baseline"]["geometry"])]
    if document["feasible"]:
        shown.append(("Designed", document["geometry"]))
    with house_style():
        drawing = new_figure(430 * len(shown), 330)
        axes = drawing.subplots(1, len(shown), sharex=True, sharey=True, squeeze=False)[0]
        for one, (title, geometry) in zip(axes, shown, strict=True):
            _section(one, geometry)
            turns, bore = f"{geometry['turns']:.3g}", 2e3 * geometry["channel_radius"]
            wound = f"{turns} turn{'' if turns == '1' else 's'}"
            one.set_title(f"{title}: {wound}, bore {bore:.3g} mm")
            one.set_xlabel("Radius (mm)")
        axes[0].set_ylabel("Height (mm)")
        return to_svg(drawing, name="sections", title="Sections through baseline and design")


def _section(axes: Axes, geometry: Mapping[str, float]) -> None:
    """Draw cylinder, rod and the helix's turns as the plane of its axis cuts them, in mm."""
    r1, r2, r3, r4 = (
        1e3 * geometry[key]
        for key in ("rod_radius", "cylinder_radius", "channel_radius", "helix_radius")
    )
    pitch, turns = 1e3 * geometry["helix_pitch"], geometry["turns"]
    height = pitch * turns + 2.0 * r3
    axes.add_patch(Rectangle((-r2, 0), 2 * r2, height, facecolor=GRID, edgecolor=INK, linewidth=1))
    axes.add_patch(
        Rectangle((-r1, -0.08 * height), 2 * r1, 1.16 * height, facecolor=MUTED, edgecolor="none")
    )
    # The helix crosses the plane every half turn, on alternate sides.
    for half in range(int(2.0 * turns + 1e-6) + 1):
        side = 1.0 if half % 2 == 0 else -1.0
        axes.add_patch(
            Circle((side * r4, r3 + 0.5 * half * pitch), r3, facecolor=ACCENT, edgecolor="white")
        )
    axes.set_aspect("equal")
    axes.autoscale_view()
    axes.grid(visible=False)


def prices(document: Mapping[str, Any]) -> str:
    """Draw what each dimension buys and what each active bound costs, as bars."""
    slopes = {k: v for k, v in document["elasticities"].items() if v and k != "amplitude"}
    bounds = {
        b["name"]: b["price_percent_per_percent"]
        for b in document["active_bounds"]
        if abs(b["price_percent_per_percent"]) > 1e-3
    }
    with house_style():
        # One above the other: beside each other they are too wide for a phone.
        rows = [(slopes, "Each 1 % of a dimension")]
        rows += [(bounds, "Each 1 % of a bound")] if bounds else []
        lengths = [max(len(values), 3) for values, _ in rows]
        drawing = new_figure(460, 80 * len(rows) + 30 * sum(lengths))
        panels = drawing.subplots(len(rows), 1, squeeze=False, height_ratios=lengths)
        for axes, (values, name) in zip(panels[:, 0], rows, strict=True):
            _bars(axes, values, name)
        title = "Percent of critical frequency for one percent of each dimension and bound"
        return to_svg(drawing, name="prices", title=title)


def _bars(axes: Axes, values: Mapping[str, float], title: str) -> None:
    ordered = sorted(values.items(), key=lambda item: abs(item[1]))
    lengths = np.array([value for _, value in ordered])
    places = np.arange(lengths.size)
    axes.barh(places, lengths, color=[MODEL if v > 0 else ACCENT for v in lengths], height=0.6)
    axes.axvline(0.0, color=MUTED, linewidth=0.8)
    axes.set_yticks(places, [name.replace("_", " ") for name, _ in ordered])
    for place, value in zip(places, lengths, strict=True):
        inside = (3, 0) if value > 0 else (-3, 0)
        axes.annotate(
            f"{value:+.2f}".replace("-", "−"), (value, place), xytext=inside,
            textcoords="offset points", ha="left" if value > 0 else "right", va="center",
            fontsize=8.5,
        )
    axes.margins(x=0.22)
    axes.set_title(title)
    axes.set_xlabel("Change of critical frequency (%)")
    axes.grid(visible=False, axis="y")

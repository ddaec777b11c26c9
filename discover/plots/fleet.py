"""One number over the devices of a fleet."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes

from discover.plots.style import (
    ACCENT,
    INK,
    MODEL,
    MUTED,
    house_style,
    new_figure,
    plain_log_axis,
)
from discover.plots.svg import to_svg

NAMED = 40
"""Devices that still have room for their names."""
ROW, THIN = 18.0, 5.0
"""CSS pixels of a device's row, with its name and without."""
_LONGEST_NAME = 26


def over_devices(quantity: Mapping[str, Any], *, name: str, label: str) -> str:
    """Draw a quantity's values with their intervals, a row a device, over the fleet's mean.

    Parameters
    ----------
    quantity : mapping
        As in ``batch.json``.
    name : str
        Of the picture.
    label : str
        Of the axis, with its unit.
    """
    values = sorted(quantity["values"], key=lambda v: v["value"])
    named = len(values) <= NAMED
    rows = np.arange(len(values))
    apart = {(o["campaign"], o["band"]) for o in quantity["outliers"]}
    with house_style():
        figure = new_figure(560, 96 + (ROW if named else THIN) * max(len(values), 3))
        axes = figure.add_subplot()
        axes.axvspan(*quantity["interval"], color=ACCENT, alpha=0.15, linewidth=0)
        axes.axvline(quantity["mean"], color=ACCENT, linewidth=1.2)
        if quantity["kind"] == "boundary":
            axes.set_xscale("log")
        for outlier, colour in ((False, INK), (True, MODEL)):
            at = [
                i for i, v in enumerate(values)
                if ((v["campaign"], v["band"]) in apart) is outlier
            ]
            if not at:
                continue
            axes.hlines(
                rows[at], [values[i]["lower"] for i in at], [values[i]["upper"] for i in at],
                color=colour, linewidth=1.2,
            )
            axes.plot(
                [values[i]["value"] for i in at], rows[at], linestyle="none",
                marker="D" if outlier else "o", markersize=6 if named else 4, color=colour,
            )
        if quantity["kind"] == "boundary":
            plain_log_axis(axes, which="x")
        a_row_a_device(axes, [v["campaign"] for v in values], label)
        return to_svg(figure, name=name, title=f"{label} of each device")


def short_label(name: str) -> str:
    """Return a campaign's name with no more letters than there is room for."""
    return name if len(name) <= _LONGEST_NAME else name[: _LONGEST_NAME - 1] + "…"


def a_row_a_device(axes: Axes, campaigns: Sequence[str], label: str) -> None:
    """Give each device its row, the first one on top, with its name where there is room."""
    names = [short_label(c) for c in campaigns] if len(campaigns) <= NAMED else []
    axes.set_ylim(len(campaigns) - 0.4, -0.6)
    axes.set_yticks(range(len(names)), names)
    axes.tick_params(axis="y", length=0, labelsize=10, labelcolor=MUTED)
    axes.grid(visible=False, axis="y")
    axes.spines["left"].set_visible(False)
    axes.set_xlabel(label)

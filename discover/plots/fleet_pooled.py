"""One number over the devices of a fleet, alone and pooled."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from discover.plots.fleet import NAMED, ROW, THIN, a_row_a_device
from discover.plots.style import (
    ACCENT,
    BEFORE,
    house_style,
    legend_above,
    new_figure,
    plain_log_axis,
)
from discover.plots.svg import to_svg

_APART = 0.2  # of a row, between alone and pooled


def alone_and_pooled(quantity: Mapping[str, Any], *, name: str, label: str) -> str:
    """Draw each device's value with its 95 % interval, alone and pooled, a row a device.

    Parameters
    ----------
    quantity : mapping
        As in ``pooling`` of ``batch.json``.
    name : str
        Of the picture.
    label : str
        Of the axis, with its unit.
    """
    values = sorted(quantity["values"], key=lambda v: v["pooled"]["value"])
    named = len(values) <= NAMED
    rows = np.arange(len(values))
    with house_style():
        figure = new_figure(560, 120 + (ROW if named else THIN) * max(len(values), 3))
        axes = figure.add_subplot()
        if quantity["logarithmic"]:
            axes.set_xscale("log")
        for key, colour, marker, side in (
            ("alone", BEFORE, "o", -_APART), ("pooled", ACCENT, "s", _APART),
        ):  # fmt: skip
            told = [v[key] for v in values]
            axes.hlines(
                rows + side, [t["lower"] for t in told], [t["upper"] for t in told],
                color=colour, linewidth=1.4 if named else 0.8,
            )
            axes.plot(
                [t["value"] for t in told], rows + side, linestyle="none", marker=marker,
                markersize=5 if named else 2.5, color=colour, label=key,
            )
        if quantity["logarithmic"]:
            plain_log_axis(axes, which="x")
        a_row_a_device(axes, [v["campaign"] for v in values], label)
        legend_above(figure, ncols=2)
        return to_svg(figure, name=name, title=f"{label} of each device, alone and pooled")

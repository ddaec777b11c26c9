"""What several models miss of every record, one row a record, beside its noise."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from discover.plots.style import (
    INK,
    MUTED,
    house_style,
    legend_above,
    new_figure,
    plain_log_axis,
    prediction_look,
)
from discover.plots.svg import series, to_svg

_ROW = 20.0  # CSS pixels
_MARKERS = "osD^vPX"


def model_errors(models: Sequence[Mapping[str, Any]], *, name: str) -> str | None:
    """Draw each model's relative error on each record as one ``<svg>``; None without records.

    Parameters
    ----------
    models : sequence of mapping
        ``name`` and ``records`` (``file``, ``held_out``, ``relative_error_percent``,
        ``noise_percent``), the same records in each; the best model first.
    name : str
        Prefix of the picture's ids.
    """
    records = models[0]["records"] if models else ()
    if not records:
        return None
    rows = np.arange(len(records))
    with house_style():
        figure = new_figure(620, 110 + _ROW * max(len(records), 3))
        axes = figure.add_subplot()
        axes.set_xscale("log")
        floors = [r["noise_percent"] or np.nan for r in records]
        look: dict[str, Any] = {"linestyle": "none", "marker": "|", "color": MUTED}
        lines = axes.plot(floors, rows, markersize=12, markeredgewidth=2.2, label="noise", **look)
        series(lines, "noise")
        for number, model in enumerate(models):
            colour = prediction_look("", number)["color"]
            errors = [r["relative_error_percent"] or np.nan for r in model["records"]]
            lines = axes.plot(
                errors, rows, linestyle="none", marker=_MARKERS[number % len(_MARKERS)],
                markersize=6.5, markerfacecolor=colour, markeredgecolor="white",
                label=str(model["name"]),
            )  # fmt: skip
            series(lines, str(model["name"]))
        axes.set_ylim(max(len(records), 3) - 0.4, -0.6)
        names = [str(r["file"]) + (" *" if r["held_out"] else "") for r in records]
        axes.set_yticks(rows, names)
        axes.tick_params(axis="y", length=0, labelcolor=INK)
        axes.grid(visible=False, axis="y")
        axes.spines["left"].set_visible(False)
        axes.set_xlabel("‖error‖ / ‖force‖ (%)")
        plain_log_axis(axes, which="x")
        handles, labels = axes.get_legend_handles_labels()
        legend_above(figure, handles, labels, ncols=3)
        return to_svg(figure, name=name, title="Error of each model on each record")

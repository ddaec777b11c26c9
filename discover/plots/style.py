"""How every picture looks: a colour-blind-safe palette, one type scale, no pyplot."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import Any

import matplotlib
import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, LogLocator, MaxNLocator, NullFormatter, NullLocator

INK = "#1d2733"
"""Text and measured curves."""
MUTED = "#5f6b7a"
"""Secondary text, axes, reference lines."""
GRID = "#e3e8ee"
"""Grid lines."""
MODEL = "#d55e00"
"""The model's curve."""
ACCENT = "#0072b2"
"""Bars and the boundary."""

BEFORE = "#8a94a0"
"""A model before it was mended."""

_LOOKS = (
    {"color": MODEL, "linewidth": 1.5, "dashes": (4, 2)},
    {"color": "#009e73", "linewidth": 1.5, "dashes": (6, 2, 1, 2)},
    {"color": "#cc79a7", "linewidth": 1.5, "dashes": (3, 1)},
    {"color": ACCENT, "linewidth": 1.5, "dashes": (1.5, 1.5)},
)
"""Of the models beside a measured curve; colours by Okabe and Ito, each with its own dashes.

Blue, which the noise has, comes last."""

MODEL_OVER_MANY: dict[str, Any] = {"color": MODEL, "linewidth": 1.0, "dashes": (4, 2)}
"""Of the model where measured curves have many colours."""

STRUCTURE_COLOURS = {
    "FOIM": "#0072b2",
    "IOIM-linear": "#e69f00",
    "IOIM-laminar": "#009e73",
    "IOIM-turbulent": "#d55e00",
    "other": "#8d5aa6",
    "": "#8a94a0",
}
"""Okabe and Ito's colours, one a structure ("" where a record has none)."""

STRUCTURE_MARKERS = {
    "FOIM": "o",
    "IOIM-linear": "s",
    "IOIM-laminar": "^",
    "IOIM-turbulent": "D",
    "other": "h",
    "": "X",
}
"""A shape beside the colour, so that neither carries the meaning alone."""


def record_marker(structure: str, *, held_out: bool, size: float = 8.0) -> dict[str, Any]:
    """Return the marker of one record, hollow where it is held out, with its legend label."""
    colour = STRUCTURE_COLOURS.get(structure, STRUCTURE_COLOURS["other"])
    name = structure or "in no band"
    return {
        "linestyle": "none",
        "marker": STRUCTURE_MARKERS.get(structure, STRUCTURE_MARKERS["other"]),
        "markersize": size,
        "markerfacecolor": "white" if held_out else colour,
        "markeredgecolor": colour if held_out else "white",
        "markeredgewidth": 1.6 if held_out else 0.7,
        "label": f"{name}, held out" if held_out else name,
        "zorder": 4,
    }


_STYLE: Any = {  # keys that only newer matplotlib types spell out
    "svg.fonttype": "none",
    "text.parse_math": False,
    "font.family": "DejaVu Sans",
    "font.size": 11.5,
    "axes.titlesize": 12.0,
    "axes.titleweight": "bold",
    "axes.titlelocation": "left",
    "axes.titlepad": 8.0,
    "axes.labelsize": 11.5,
    "axes.labelcolor": INK,
    "axes.edgecolor": "#aab4c0",
    "axes.linewidth": 0.8,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "axes.axisbelow": True,
    "grid.color": GRID,
    "grid.linewidth": 0.8,
    "xtick.color": MUTED,
    "ytick.color": MUTED,
    "xtick.labelsize": 10.5,
    "ytick.labelsize": 10.5,
    "text.color": INK,
    "legend.frameon": False,
    "legend.fontsize": 10.0,
    "lines.linewidth": 1.6,
    "figure.facecolor": "white",
}


@contextmanager
def house_style() -> Iterator[None]:
    """Apply the type scale and colours for the pictures drawn inside, and nowhere else."""
    with matplotlib.rc_context(_STYLE):
        yield


def new_figure(width: float, height: float) -> Figure:
    """Return an empty figure of `width` by `height`, CSS pixels at the page's natural size."""
    return Figure(figsize=(width / 96.0, height / 96.0), dpi=96, layout="constrained")


def legend_above(
    figure: Figure,
    handles: Sequence[Artist] | None = None,
    labels: Sequence[str] | None = None,
    *,
    ncols: int,
    **look: Any,
) -> None:
    """Put a legend above everything, in at most `ncols` columns and no wider than the figure.

    Parameters
    ----------
    figure : matplotlib.figure.Figure
        Drawn inside `house_style`.
    handles, labels : sequence, optional
        What is named and how; without them all that the figure's axes have.
    ncols : int
        As many columns as would look best; fewer where long names need the room.
    **look
        As `matplotlib.figure.Figure.legend` takes it.
    """
    if handles is None or labels is None:
        pairs = [axes.get_legend_handles_labels() for axes in figure.axes]
        handles, labels = [h for p in pairs for h in p[0]], [n for p in pairs for n in p[1]]
    room = figure.get_figwidth() * figure.dpi
    for columns in range(ncols, 0, -1):
        legend = figure.legend(handles, labels, loc="outside upper left", ncols=columns, **look)
        box = legend.get_window_extent()
        if columns == 1 or box.x0 + box.x1 <= room:  # as much room on the right as on the left
            return
        legend.remove()


def prediction_look(label: str, number: int) -> dict[str, Any]:
    """Return how the `number`-th model (from 0) is drawn beside a measured curve."""
    if label == "before":
        return {"color": BEFORE, "linewidth": 1.6, "dashes": (2, 2)}
    return dict(_LOOKS[number % len(_LOOKS)])


def graded_colours(count: int) -> list[tuple[float, float, float, float]]:
    """Return so many colours from dark to light: quantities in rising order, without pale ends."""
    ramp = matplotlib.colormaps["viridis"]
    return [tuple(ramp(v)) for v in np.linspace(0.0, 0.85, max(count, 1))]


def plain_log_axis(axes: Axes, *, which: str) -> None:
    """Label a logarithmic axis with plain numbers (0.1, 0.2, 0.5, 1 ...) instead of powers."""
    axis = axes.xaxis if which == "x" else axes.yaxis
    low, high = axes.get_xlim() if which == "x" else axes.get_ylim()
    steps = (1.0, 2.0, 5.0) if high / low < 300.0 else (1.0,)
    if high / low < 10.0:  # 1, 2 and 5 leave such an axis with a mark or two
        axis.set_major_locator(MaxNLocator(5, steps=[1, 2, 2.5, 5, 10]))
        axis.set_minor_locator(NullLocator())
    else:
        axis.set_major_locator(LogLocator(base=10.0, subs=steps, numticks=20))
    axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axis.set_minor_formatter(NullFormatter())


def scaled(peak: float, unit: str) -> tuple[float, str]:
    """Return the factor and the prefixed unit in which `peak` (SI) reads well.

    Examples
    --------
    >>> scaled(12_300.0, "N")
    (0.001, 'kN')
    >>> scaled(0.02, "m")
    (1000.0, 'mm')
    """
    for limit, factor, prefix in ((1e6, 1e-6, "M"), (1e3, 1e-3, "k"), (0.1, 1.0, "")):
        if peak >= limit:
            return factor, prefix + unit
    return (1e3, "m" + unit) if peak > 1e-4 else (1e6, "µ" + unit)

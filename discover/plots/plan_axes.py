"""The plane of frequency and displacement amplitude that every plan of tests is drawn on."""

from __future__ import annotations

import math
from collections.abc import Sequence

from matplotlib.axes import Axes

from discover.plots.style import MUTED, plain_log_axis

_LEAST_SPAN = 5.0  # a factor that always holds two of the labels 1, 2, 5, 10
DOTTED = (0, (1, 2.5))
"""The line style of a constant Dean number."""


def plan_limits(axes: Axes, frequencies: Sequence[float], amplitudes: Sequence[float]) -> None:
    """Make both axes logarithmic, with room around tests of these Hz and mm."""
    axes.set(xscale="log", yscale="log")
    for values, put in ((frequencies, axes.set_xlim), (amplitudes, axes.set_ylim)):
        span = max(values) / min(values)
        room = max(1.25, span**0.12, math.sqrt(_LEAST_SPAN / span))
        put(min(values) / room, max(values) * room)


def plan_labels(axes: Axes) -> None:
    """Name both axes with their units, in plain numbers."""
    axes.set_xlabel("Frequency (Hz)")
    axes.set_ylabel("Displacement amplitude (mm)")
    plain_log_axis(axes, which="x")
    plain_log_axis(axes, which="y")


def constant_speed(axes: Axes, speed: float) -> tuple[list[float], list[float]]:
    """Return the line of one speed amplitude (m/s) across the axes: Hz, mm."""
    frequencies = list(axes.get_xlim())
    return frequencies, [1e3 * speed / (2.0 * math.pi * f) for f in frequencies]


def speed_range(axes: Axes) -> tuple[float, float]:
    """Return the least and the greatest speed amplitude on the axes, m/s."""
    corners = zip(axes.get_xlim(), axes.get_ylim(), strict=True)
    lowest, highest = (2e-3 * math.pi * f * a for f, a in corners)
    return lowest, highest


def dean_line(
    axes: Axes,
    speed: float,
    text: str,
    *,
    color: str = MUTED,
    linestyle: str | tuple[int, tuple[float, ...]] = DOTTED,
    linewidth: float = 0.9,
) -> None:
    """Draw the tests of one Dean number, which share a speed amplitude (m/s), with its label."""
    line = constant_speed(axes, speed)
    axes.plot(
        *line,
        color=color,
        linewidth=linewidth,
        linestyle=linestyle,
        zorder=1,
        scalex=False,
        scaley=False,
    )
    _edge_label(axes, line, text)


def _edge_label(axes: Axes, line: tuple[list[float], list[float]], text: str) -> None:
    """Write `text` where the falling line meets the top edge, or else the left one."""
    product = line[0][0] * line[1][0]
    (left, right), (bottom, top) = axes.get_xlim(), axes.get_ylim()
    across = product / top
    if left <= across <= right:
        axes.annotate(
            text,
            (across, top),
            xytext=(3, 3),
            textcoords="offset points",
            fontsize=10,
            color=MUTED,
            ha="center",
            va="bottom",
            annotation_clip=False,
        )
    elif bottom < line[1][0] < top:
        axes.annotate(
            text,
            (left, line[1][0]),
            xytext=(4, 0),
            textcoords="offset points",
            fontsize=10,
            color=MUTED,
            ha="left",
            va="bottom",
        )

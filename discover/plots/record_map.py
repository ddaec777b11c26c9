"""The plan of tests as a map: frequency by amplitude, coloured by structure, with the boundary."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

from matplotlib.axes import Axes

from discover.figure_data import RecordCurves, StudyFigureData
from discover.plots.style import (
    INK,
    MUTED,
    house_style,
    new_figure,
    plain_log_axis,
    record_marker,
    to_svg,
)


def record_map(document: Mapping[str, Any], data: StudyFigureData) -> str | None:
    """Draw the map of the sine tests, or return None where the campaign has none.

    Lines of constant Dean number (in the study's convention) and the boundary with its interval
    are straight with slope -1: at constant frequency times amplitude. A boundary in frequency
    stands upright.

    Parameters
    ----------
    document : mapping
        The study as in ``study.json``.
    data : StudyFigureData
        The records' places in the plan.

    Returns
    -------
    str or None
        One ``<svg>`` element.
    """
    tests = [r for r in data.records if r.frequency and r.amplitude]
    if not tests:
        return None
    with house_style():
        figure = new_figure(660, 490)
        axes = figure.add_subplot()
        axes.set(xscale="log", yscale="log")
        _limits(axes, tests)
        _dean_lines(axes, document, data)
        for boundary in document.get("boundaries", ()):
            _boundary(axes, boundary, document["coordinate"])
        _points(axes, tests)
        axes.set_xlabel("Frequency (Hz)")
        axes.set_ylabel("Displacement amplitude (mm)")
        plain_log_axis(axes, which="x")
        plain_log_axis(axes, which="y")
        figure.legend(loc="outside upper left", ncols=3, handletextpad=0.4, columnspacing=1.4)
        return to_svg(figure, name="map", title="Map of the tests, coloured by structure")


def _limits(axes: Axes, tests: Sequence[RecordCurves]) -> None:
    frequencies = [r.frequency for r in tests if r.frequency]
    amplitudes = [1e3 * r.amplitude for r in tests if r.amplitude]
    for values, put in ((frequencies, axes.set_xlim), (amplitudes, axes.set_ylim)):
        room = max(1.25, (max(values) / min(values)) ** 0.12)
        put(min(values) / room, max(values) * room)


def _points(axes: Axes, tests: Sequence[RecordCurves]) -> None:
    """Draw fitted and held-out tests of each structure as one group."""
    for structure, held_out in sorted({(r.structure, r.held_out) for r in tests}):
        group = [r for r in tests if (r.structure, r.held_out) == (structure, held_out)]
        axes.plot(
            [r.frequency for r in group if r.frequency],
            [1e3 * r.amplitude for r in group if r.amplitude],
            **record_marker(structure, held_out=held_out, size=9.0),
        )


def _constant_speed(axes: Axes, speed: float) -> tuple[list[float], list[float]]:
    """Return the line of one speed amplitude (m/s) across the axes: Hz, mm."""
    frequencies = list(axes.get_xlim())
    return frequencies, [1e3 * speed / (2.0 * math.pi * f) for f in frequencies]


def _dean_lines(axes: Axes, document: Mapping[str, Any], data: StudyFigureData) -> None:
    convention = str(document.get("dean_check", {}).get("convention", "paper"))
    scale = {"paper": data.dean_per_speed_paper, "standard": data.dean_per_speed_standard}
    per_speed = scale.get(convention)
    if not per_speed:
        return
    (f_low, f_high), (a_low, a_high) = axes.get_xlim(), axes.get_ylim()
    lowest, highest = (
        2e-3 * math.pi * f * a * per_speed for f, a in ((f_low, a_low), (f_high, a_high))
    )
    criterion = float(document.get("dean_check", {}).get("criterion") or 100.0)
    decades = range(math.ceil(math.log10(lowest)), math.floor(math.log10(highest)) + 1)
    for dean in sorted({10.0**d for d in decades} | {criterion}):
        if not lowest < dean < highest:
            continue
        line = _constant_speed(axes, dean / per_speed)
        axes.plot(
            *line,
            color=MUTED,
            linewidth=0.9,
            linestyle=(0, (1, 2.5)),
            zorder=1,
            scalex=False,
            scaley=False,
        )
        _edge_label(axes, line, f"De {dean:g}")
    axes.plot(
        [],
        [],
        color=MUTED,
        linewidth=0.9,
        linestyle=(0, (1, 2.5)),
        label=f"Dean number ({convention} convention)",
    )


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
            fontsize=8.5,
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
            fontsize=8.5,
            color=MUTED,
            ha="left",
            va="bottom",
        )


def _boundary(axes: Axes, boundary: Mapping[str, Any], coordinate: str) -> None:
    """Draw one boundary with its interval, which scales as the coordinate does."""
    value = boundary["coordinate"] if coordinate == "frequency" else boundary.get("speed")
    if not value:
        return
    spread = relative_interval(boundary)
    first = "boundary" not in axes.get_legend_handles_labels()[1]
    line: dict[str, Any] = {"color": INK, "linewidth": 1.8, "zorder": 3}
    line["label"] = "boundary" if first else None
    fill: dict[str, Any] = {"color": INK, "alpha": 0.1, "linewidth": 0.0, "zorder": 0}
    fill["label"] = "its interval" if first else None
    if coordinate == "frequency":
        axes.axvline(value, **line)
        if spread:
            axes.axvspan(value * spread[0], value * spread[1], **fill)
        return
    axes.plot(*_constant_speed(axes, value), scalex=False, scaley=False, **line)
    if spread:
        low, high = (_constant_speed(axes, value * k)[1] for k in spread)
        limits = axes.get_ylim()
        axes.fill_between(axes.get_xlim(), low, high, **fill)
        axes.set_ylim(limits)


def relative_interval(boundary: Mapping[str, Any]) -> tuple[float, float] | None:
    """Return a boundary's interval (else its bracket) as multiples of its value.

    None where it carries neither.

    Examples
    --------
    >>> relative_interval({"coordinate": 100.0, "interval": [90.0, 120.0]})
    (0.9, 1.2)
    """
    value = boundary["coordinate"]
    interval = boundary.get("interval") or boundary.get("bracket")
    if not value or not interval or None in interval:
        return None
    return float(interval[0]) / float(value), float(interval[1]) / float(value)

"""The plan of tests as a map: frequency by amplitude, coloured by structure, with the boundary."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

from matplotlib.axes import Axes

from discover.figure_data import RecordCurves, StudyFigureData
from discover.plots.plan_axes import (
    DOTTED,
    constant_speed,
    dean_line,
    plan_labels,
    plan_limits,
    speed_range,
)
from discover.plots.style import INK, MUTED, house_style, legend_above, new_figure, record_marker
from discover.plots.svg import to_svg


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
        plan_limits(
            axes,
            [r.frequency for r in tests if r.frequency],
            [1e3 * r.amplitude for r in tests if r.amplitude],
        )
        _dean_lines(axes, document, data)
        for boundary in document.get("boundaries", ()):
            _boundary(axes, boundary, document["coordinate"])
        _points(axes, tests)
        plan_labels(axes)
        legend_above(figure, ncols=3, handletextpad=0.4, columnspacing=1.4)
        return to_svg(figure, name="map", title="Map of the tests, coloured by structure")


def _points(axes: Axes, tests: Sequence[RecordCurves]) -> None:
    """Draw fitted and held-out tests of each structure as one group."""
    for structure, held_out in sorted({(r.structure, r.held_out) for r in tests}):
        group = [r for r in tests if (r.structure, r.held_out) == (structure, held_out)]
        axes.plot(
            [r.frequency for r in group if r.frequency],
            [1e3 * r.amplitude for r in group if r.amplitude],
            **record_marker(structure, held_out=held_out, size=9.0),
        )


def _dean_lines(axes: Axes, document: Mapping[str, Any], data: StudyFigureData) -> None:
    convention = str(document.get("dean_check", {}).get("convention", "paper"))
    scale = {"paper": data.dean_per_speed_paper, "standard": data.dean_per_speed_standard}
    per_speed = scale.get(convention)
    if not per_speed:
        return
    lowest, highest = (speed * per_speed for speed in speed_range(axes))
    criterion = float(document.get("dean_check", {}).get("criterion") or 100.0)
    decades = range(math.ceil(math.log10(lowest)), math.floor(math.log10(highest)) + 1)
    for dean in sorted({10.0**d for d in decades} | {criterion}):
        if not lowest < dean < highest:
            continue
        dean_line(axes, dean / per_speed, f"De {dean:g}")
    axes.plot(
        [],
        [],
        color=MUTED,
        linewidth=0.9,
        linestyle=DOTTED,
        label=f"Dean number ({convention} convention)",
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
    axes.plot(*constant_speed(axes, value), scalex=False, scaley=False, **line)
    if spread:
        low, high = (constant_speed(axes, value * k)[1] for k in spread)
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

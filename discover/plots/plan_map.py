"""The plan of tests before any fit: where each stands, its noise, and what was found on it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from matplotlib.axes import Axes
from matplotlib.transforms import Bbox

from discover.figure_data import PlanFigureData, PlannedTest
from discover.plots.plan_axes import DOTTED, dean_line, plan_labels, plan_limits, speed_range
from discover.plots.style import INK, MUTED, house_style, legend_above, new_figure
from discover.plots.svg import to_svg

_CLASSES = (
    (0.5, "#5ec962", "noise below 0.5 %"),
    (2.0, "#21918c", "noise 0.5 to 2 %"),
    (5.0, "#3b528b", "noise 2 to 5 %"),
    (20.0, "#7b1fa2", "noise 5 to 20 %"),
    (math.inf, INK, "noise above 20 %"),
)
_UNKNOWN = ("#aab4c0", "noise not known")
_LEVELS = {"warning": ("o", "#e69f00", "warning"), "error": ("x", "#c02600", "error")}
_CRITERION = 100.0
_WIDTH, _HEIGHT = 660, 490
_MARK = 6.0  # half a mark's width, CSS pixels
_ROOM = (6.0, 1.0)  # between a number and what stands beside, above or below it, CSS pixels


def plan_map(data: PlanFigureData) -> str | None:
    """Draw the plan, or return None where no record has a frequency and an amplitude.

    Each test is coloured by its force noise, ringed where a warning concerns it and crossed where
    an error does. The lines of Dean number 100 have slope -1: constant speed amplitude.

    Parameters
    ----------
    data : PlanFigureData
        The tests and the device's Dean numbers.

    Returns
    -------
    str or None
        One ``<svg>`` element.
    """
    if not data.tests:
        return None
    with house_style():
        figure = new_figure(_WIDTH, _HEIGHT)
        axes = figure.add_subplot()
        amplitudes = [1e3 * t.amplitude for t in data.tests]
        plan_limits(axes, [t.frequency for t in data.tests], amplitudes)
        _criterion_lines(axes, data)
        _points(axes, data.tests)
        _findings(axes, data.tests)
        plan_labels(axes)
        legend_above(
            figure, ncols=2,
            handletextpad=0.4,
            columnspacing=1.4,
        )
        _numbers(axes, data.tests)
        title = "Map of the planned tests, coloured by the noise of their force"
        return to_svg(figure, name="plan", title=title)


def _noise_class(test: PlannedTest) -> tuple[str, str]:
    """Return the colour and the name of the class that a test's noise, as written, lies in."""
    if test.noise_percent is None:
        return _UNKNOWN
    noise = float(_written(test.noise_percent))
    return next((colour, name) for limit, colour, name in _CLASSES if noise < limit)


def _written(noise_percent: float) -> str:
    return f"{noise_percent:.2g}"


def _points(axes: Axes, tests: Sequence[PlannedTest]) -> None:
    """Draw fitted and held-out tests of each noise class as one group."""
    classes = [*((c, n) for _, c, n in _CLASSES), _UNKNOWN]
    for colour, name in classes:
        for held_out in (False, True):
            group = [t for t in tests if (_noise_class(t)[1], t.held_out) == (name, held_out)]
            if not group:
                continue
            axes.plot(
                [t.frequency for t in group],
                [1e3 * t.amplitude for t in group],
                linestyle="none",
                marker="o",
                markersize=9.0,
                markerfacecolor="white" if held_out else colour,
                markeredgecolor=colour if held_out else "white",
                markeredgewidth=1.8 if held_out else 0.7,
                label=f"{name}, held out" if held_out else name,
                zorder=4,
            )


def _findings(axes: Axes, tests: Sequence[PlannedTest]) -> None:
    for level, (marker, colour, name) in _LEVELS.items():
        group = [t for t in tests if t.level == level]
        if not group:
            continue
        axes.plot(
            [t.frequency for t in group],
            [1e3 * t.amplitude for t in group],
            linestyle="none",
            marker=marker,
            markersize=15.0,
            markerfacecolor="none",
            markeredgecolor=colour,
            markeredgewidth=2.0,
            label=name,
            zorder=5,
        )


def _numbers(axes: Axes, tests: Sequence[PlannedTest]) -> None:
    """Write the noise under each sine test where it touches no other mark, number or label."""
    figure = axes.get_figure(root=True)
    if figure is None:
        return
    figure.draw_without_rendering()  # only then is it known where all stands
    marks = [_mark(axes, t) for t in tests]
    written = [label.get_window_extent() for label in axes.texts]
    for index, test in enumerate(tests):
        others = [*marks[:index], *marks[index + 1 :]]
        on_another = any(_touch(marks[index], other) for other in others)
        if test.kind != "sine" or test.noise_percent is None or on_another:
            continue
        number = axes.annotate(
            f"{_written(test.noise_percent)} %",
            (test.frequency, 1e3 * test.amplitude),
            xytext=(0, -9),
            textcoords="offset points",
            fontsize=9.5,
            color=MUTED,
            ha="center",
            va="top",
            bbox={"facecolor": "white", "edgecolor": "none", "alpha": 0.85, "pad": 0.6},
            zorder=3,
        )
        place = number.get_window_extent()
        if any(_touch(place, other) for other in (*written, *others)):
            number.remove()
        else:
            written.append(place)


def _mark(axes: Axes, test: PlannedTest) -> Bbox:
    """Return the place of a test's mark in the picture, CSS pixels."""
    x, y = axes.transData.transform((test.frequency, 1e3 * test.amplitude))
    return Bbox([[x - _MARK, y - _MARK], [x + _MARK, y + _MARK]])


def _touch(one: Bbox, other: Bbox) -> bool:
    beside, above = _ROOM
    apart = (one.x0 - other.x1, other.x0 - one.x1, one.y0 - other.y1, other.y0 - one.y1)
    return bool(max(apart[:2]) < beside and max(apart[2:]) < above)


def _criterion_lines(axes: Axes, data: PlanFigureData) -> None:
    """Draw the tests at Dean number 100, by either convention, where they lie on the axes."""
    lowest, highest = speed_range(axes)
    styles: tuple[tuple[str, float | None, Any], ...] = (
        ("paper", data.dean_per_speed_paper, (0, (5, 2.5))),
        ("standard", data.dean_per_speed_standard, DOTTED),
    )
    for convention, per_speed, linestyle in styles:
        if per_speed and lowest < _CRITERION / per_speed < highest:
            text = f"De {_CRITERION:g}"
            look = {"color": MUTED, "linestyle": linestyle, "linewidth": 1.2}
            dean_line(axes, _CRITERION / per_speed, text, **look)
            axes.plot([], [], label=f"{text}, {convention} convention", **look)

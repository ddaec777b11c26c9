"""What the model misses in each record, beside that record's noise floor."""

from __future__ import annotations

from collections.abc import Sequence

from discover.figure_data import RecordCurves, StudyFigureData
from discover.plots.loops import record_label
from discover.plots.style import (
    INK,
    MUTED,
    house_style,
    legend_above,
    new_figure,
    plain_log_axis,
    record_marker,
)
from discover.plots.svg import series, to_svg

_IN_ONE = 18
_ROW = 18.0  # CSS pixels
_LONGEST_NAME = 26
_EDGE = 0.06  # of the range of errors (logarithms), free at each side
_LEAST_EDGE = 1.02


def error_by_record(data: StudyFigureData) -> list[str]:
    """Draw the relative error of every record and its noise floor, one row a record.

    Many records are shared out over two pictures with the same axis, to stand side by side; the
    list is empty where no record has an error.
    """
    records = [r for r in data.records if r.relative_error_percent is not None]
    if not records:
        return []
    values = [r.relative_error_percent or 0.0 for r in records]
    values += [r.noise_percent for r in records if r.noise_percent]
    positive = [v for v in values if v > 0.0] or [1.0]
    edge = max((max(positive) / min(positive)) ** _EDGE, _LEAST_EDGE)
    limits = (min(positive) / edge, max(positive) * edge)
    half = len(records) if len(records) <= _IN_ONE else -(-len(records) // 2)
    parts = [records[i : i + half] for i in range(0, len(records), half)]
    return [
        _rows(part, limits, height=half, name=f"errors-{i}")
        for i, part in enumerate(parts, start=1)
    ]


def _rows(
    records: Sequence[RecordCurves], limits: tuple[float, float], *, height: int, name: str
) -> str:
    with house_style():
        figure = new_figure(620, 96 + _ROW * max(height, 3))
        axes = figure.add_subplot()
        axes.set_xscale("log")
        axes.set_xlim(*limits)
        floors = [(i, r.noise_percent) for i, r in enumerate(records) if r.noise_percent]
        axes.plot(
            [floor for _, floor in floors],
            [i for i, _ in floors],
            linestyle="none",
            marker="|",
            markersize=11,
            markeredgewidth=2.2,
            color=MUTED,
            label="noise floor",
        )
        for row, record in enumerate(records):
            floor = record.noise_percent or limits[0]
            axes.plot(
                [floor, record.relative_error_percent or floor],
                [row, row],
                color="#c5cdd6",
                linewidth=1.6,
                zorder=1,
            )
        series(axes.lines[0], "noise floor")
        for structure, held_out in sorted({(r.structure, r.held_out) for r in records}):
            group = [
                (r.relative_error_percent, i)
                for i, r in enumerate(records)
                if (r.structure, r.held_out) == (structure, held_out)
            ]
            look = record_marker(structure, held_out=held_out)
            series(axes.plot(*zip(*group, strict=True), **look), str(look["label"]))
        axes.set_ylim(max(height, len(records), 3) - 0.4, -0.6)
        axes.set_yticks(range(len(records)), [_label(r) for r in records])
        axes.tick_params(axis="y", length=0, labelsize=10, labelcolor=INK)
        axes.grid(visible=False, axis="y")
        axes.spines["left"].set_visible(False)
        plain_log_axis(axes, which="x")
        axes.set_xlabel("‖error‖ / ‖force‖ (%)")
        legend_above(figure, ncols=3, columnspacing=1.2, handletextpad=0.4)
        return to_svg(figure, name=name, title="Relative error of each record and its noise")


def _label(record: RecordCurves) -> str:
    name = record_label(record)
    return name if len(name) <= _LONGEST_NAME else name[: _LONGEST_NAME - 1] + "…"

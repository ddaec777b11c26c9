"""What the model misses in each record, beside that record's noise floor."""

from __future__ import annotations

from discover.figure_data import RecordCurves, StudyFigureData
from discover.plots.style import (
    MUTED,
    house_style,
    new_figure,
    plain_log_axis,
    record_marker,
    to_svg,
)


def error_by_record(data: StudyFigureData) -> str | None:
    """Draw the relative error of every record and its noise floor; None where none has one."""
    records = [r for r in data.records if r.relative_error_percent is not None]
    if not records:
        return None
    with house_style():
        figure = new_figure(min(1120, max(420, 160 + 34 * len(records))), 300)
        axes = figure.add_subplot()
        axes.set_yscale("log")
        floors = [(i, r.noise_percent) for i, r in enumerate(records) if r.noise_percent]
        for position, floor in floors:
            axes.plot(
                [position - 0.42, position + 0.42],
                [floor, floor],
                color=MUTED,
                linewidth=2.2,
                solid_capstyle="butt",
                label="noise floor" if position == floors[0][0] else None,
            )
        for structure, held_out in sorted({(r.structure, r.held_out) for r in records}):
            group = [
                (i, r.relative_error_percent)
                for i, r in enumerate(records)
                if (r.structure, r.held_out) == (structure, held_out)
            ]
            axes.plot(*zip(*group, strict=True), **record_marker(structure, held_out=held_out))
        axes.set_xlim(-0.8, len(records) - 0.2)
        axes.set_ylabel("‖error‖ / ‖force‖ (%)")
        plain_log_axis(axes, which="y")
        every = max(1, -(-len(records) // 48))
        ticks = range(0, len(records), every)
        axes.set_xticks(ticks, [_label(records[i]) for i in ticks], rotation=90)
        axes.tick_params(axis="x", labelsize=7.5, length=2)
        axes.grid(visible=False, axis="x")
        figure.legend(loc="outside upper left", ncols=6, columnspacing=1.2, handletextpad=0.4)
        return to_svg(figure, name="errors", title="Relative error of each record and its noise")


def _label(record: RecordCurves) -> str:
    if record.frequency and record.amplitude:
        return f"{record.frequency:.3g} Hz, {1e3 * record.amplitude:.3g} mm"
    return record.file if len(record.file) <= 22 else record.file[:21] + "…"

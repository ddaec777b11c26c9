"""One record: force over time, displacement and velocity, measured beside models."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from discover.figure_data import ShownRecord
from discover.plots.style import (
    INK,
    MODEL_OVER_MANY,
    graded_colours,
    house_style,
    legend_above,
    new_figure,
    prediction_look,
    scaled,
)
from discover.plots.svg import series, to_svg
from models.checks import Array

MOST_LOOPS = 24
"""Sine tests whose loops are drawn over each other."""
_LOOP_POINTS = 120
_GAP = 3.0  # times the middle step between samples that are shown, where a stretch ends


def record_curves(record: ShownRecord, *, name: str) -> str:
    """Draw a record beside models: loops of a sine test, stretches of any other, one ``<svg>``.

    Parameters
    ----------
    record : ShownRecord
        Measured and model force over one or two cycles, or stretches of the record.
    name : str
        Prefix of the picture's ids, unique on the page.
    """
    return _loops(record, name) if record.frequency is not None else _stretches(record, name)


def _loops(record: ShownRecord, name: str) -> str:
    with house_style():
        figure = new_figure(620, 275)
        over_time, over_path, over_speed = panels = figure.subplots(
            1, 3, width_ratios=(1.25, 1.0, 1.0), sharey=True
        )
        scale, unit = _force_scale(record)
        start = record.time - record.time[0]
        over_time.set(xlabel="Time (s)", ylabel=f"Force ({unit})")
        for axes, values, si, quantity in (
            (over_time, start, "", ""),
            (over_path, record.displacement, "m", "Displacement"),
            (over_speed, record.velocity, "m/s", "Velocity"),
        ):
            factor, scaled_unit = scaled(_peak(values), si) if si else (1.0, "s")
            if quantity:
                axes.set_xlabel(f"{quantity} ({scaled_unit})")
            for label, force, look in _curves(record):
                (line,) = axes.plot(factor * values, scale * force, label=label, **look)
                series(line, label)
        for axes in panels:
            axes.locator_params(axis="x", nbins=3)
            axes.locator_params(axis="y", nbins=5)
        handles, labels = over_time.get_legend_handles_labels()
        legend_above(figure, handles, labels, ncols=4)
        title = f"Force of {record.file} over time, displacement and velocity, measured and model"
        return to_svg(figure, name=name, title=title)


def _stretches(record: ShownRecord, name: str) -> str:
    """Draw stretches of time: loops of motion that holds many frequencies show nothing."""
    parts = _parts(record.time)
    with house_style():
        figure = new_figure(620, 275)
        panels = figure.subplots(1, len(parts), sharey=True, squeeze=False)[0]
        scale, unit = _force_scale(record)
        for axes, part in zip(panels, parts, strict=True):
            for label, force, look in _curves(record):
                (line,) = axes.plot(record.time[part], scale * force[part], label=label, **look)
                series(line, label)
            axes.set_xlabel("Time (s)")
            axes.locator_params(axis="x", nbins=4)
        panels[0].set_ylabel(f"Force ({unit})")
        handles, labels = panels[0].get_legend_handles_labels()
        legend_above(figure, handles, labels, ncols=4)
        title = f"Force of {record.file} in stretches of time, measured and model"
        return to_svg(figure, name=name, title=title)


def all_loops(records: Sequence[ShownRecord], *, name: str) -> str | None:
    """Draw the loops of many sine tests over each other, each with a name; None for under two.

    Parameters
    ----------
    records : sequence of ShownRecord
        Of them at most 24, from the slowest to the fastest, are drawn.
    name : str
        Prefix of the picture's ids.
    """
    sines = sorted((r for r in records if r.frequency is not None and r.force.size), key=top_speed)
    if len(sines) < 2:
        return None
    places = np.unique(np.linspace(0, len(sines) - 1, min(len(sines), MOST_LOOPS)).astype(int))
    shown = [sines[i] for i in places]
    force, unit = scaled(max(_peak(r.force) for r in shown), "N")
    with house_style():
        figure = new_figure(620, 330)
        over_path, over_speed = panels = figure.subplots(1, 2, sharey=True)
        for axes, quantity, si in (
            (over_path, "displacement", "m"), (over_speed, "velocity", "m/s"),
        ):  # fmt: skip
            factor, scaled_unit = scaled(max(_peak(getattr(r, quantity)) for r in shown), si)
            axes.set_xlabel(f"{quantity.capitalize()} ({scaled_unit})")
            for record, colour in zip(shown, graded_colours(len(shown)), strict=True):
                thin = _one_cycle(record)
                along = factor * getattr(record, quantity)[thin]
                lines = axes.plot(along, force * record.force[thin], color=colour, linewidth=1.8)
                for _, values in record.predictions[:1]:
                    lines += axes.plot(along, force * values[thin], **MODEL_OVER_MANY)
                series(lines, record_label(record))
        over_path.set_ylabel(f"Force ({unit})")
        for axes in panels:
            axes.locator_params(axis="x", nbins=4)
        return to_svg(figure, name=name, title="Loops of the sine tests, measured and model")


def record_label(record: ShownRecord) -> str:
    """Return a record's short name: of a sine test its frequency and amplitude."""
    if record.frequency and record.amplitude:
        return f"{record.frequency:.3g} Hz, {1e3 * record.amplitude:.3g} mm"
    return record.file


def _curves(record: ShownRecord) -> list[tuple[str, Array, dict[str, object]]]:
    measured: dict[str, object] = {"color": INK, "linewidth": 1.3}
    found = [("measured", record.force, measured)]
    for number, (label, force) in reversed(list(enumerate(record.predictions))):
        found.append((label, force, prediction_look(label, number)))
    return found


def _force_scale(record: ShownRecord) -> tuple[float, str]:
    return scaled(_peak(record.force, *(f for _, f in record.predictions)), "N")


def _parts(time: Array) -> list[slice]:
    """Return the stretches of shown times, at most three."""
    steps = np.diff(time)
    if steps.size < 1:
        return [slice(None)]
    ends = np.sort(np.argsort(steps)[-2:])
    cuts = [int(i) + 1 for i in ends if steps[i] > _GAP * float(np.median(steps))]
    return [slice(a, b) for a, b in zip([0, *cuts], [*cuts, time.size], strict=True)]


def _one_cycle(record: ShownRecord) -> Array:
    stop = record.time.size
    if record.frequency:
        cycle = record.time[0] + 1.0 / record.frequency
        stop = min(stop, int(np.searchsorted(record.time, cycle)) + 2)
    return np.unique(np.linspace(0, stop - 1, min(stop, _LOOP_POINTS)).astype(int))


def _peak(*curves: Array) -> float:
    return max((float(np.nanmax(np.abs(c))) for c in curves if np.isfinite(c).any()), default=0.0)


def top_speed(record: ShownRecord) -> float:
    """Return the greatest speed that is shown, m/s."""
    return float(np.max(np.abs(record.velocity))) if record.velocity.size else 0.0

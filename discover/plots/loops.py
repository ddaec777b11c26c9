"""One record: force over time, displacement and velocity, measured beside the model."""

from __future__ import annotations

import numpy as np

from discover.figure_data import RecordCurves
from discover.plots.style import INK, MODEL, house_style, new_figure, scaled, to_svg


def loops(record: RecordCurves, *, name: str) -> str:
    """Draw force over time, displacement and velocity of `record` as one ``<svg>`` element.

    Parameters
    ----------
    record : RecordCurves
        Measured and model force over one or two cycles, or the whole record.
    name : str
        Prefix of the picture's ids, unique on the page.
    """
    with house_style():
        figure = new_figure(620, 265)
        over_time, over_path, over_speed = figure.subplots(
            1, 3, width_ratios=(1.25, 1.0, 1.0), sharey=True
        )
        force_scale, force_unit = scaled(_peak(record.force, record.model_force), "N")
        measured = force_scale * record.force
        model = force_scale * record.model_force
        start = record.time - record.time[0]
        over_time.plot(start, measured, color=INK, linewidth=1.3, label="measured")
        over_time.plot(start, model, color=MODEL, linewidth=1.5, dashes=(4, 2), label="model")
        over_time.set(xlabel="Time (s)", ylabel=f"Force ({force_unit})")
        for axes, values, unit, quantity in (
            (over_path, record.displacement, "m", "Displacement"),
            (over_speed, record.velocity, "m/s", "Velocity"),
        ):
            scale, scaled_unit = scaled(_peak(values), unit)
            axes.plot(scale * values, measured, color=INK, linewidth=1.3)
            axes.plot(scale * values, model, color=MODEL, dashes=(4, 2))
            axes.set_xlabel(f"{quantity} ({scaled_unit})")
        for axes in (over_time, over_path, over_speed):
            axes.locator_params(axis="x", nbins=3)
            axes.locator_params(axis="y", nbins=5)
        figure.legend(loc="outside upper left", ncols=2)
        title = f"Force of {record.file} over time, displacement and velocity, measured and model"
        return to_svg(figure, name=name, title=title)


def _peak(*curves: np.ndarray) -> float:
    return max((float(np.nanmax(np.abs(c))) for c in curves if np.isfinite(c).any()), default=0.0)


def representative(records: tuple[RecordCurves, ...], *, most: int = 4) -> list[RecordCurves]:
    """Return a few records that show the most: the ends of each band, and a held-out one.

    Within a band the slowest and the fastest test are taken (by speed amplitude); where there is
    room, the record that the model misses most and a held-out one come in.
    """
    with_force = [r for r in records if r.force.size and r.model_force.size]
    chosen: list[RecordCurves] = []

    def take(record: RecordCurves | None) -> None:
        if record is not None and record not in chosen and len(chosen) < most:
            chosen.append(record)

    bands = sorted({r.band for r in with_force if r.band is not None})
    for band in bands:
        inside = sorted((r for r in with_force if r.band == band), key=_speed)
        if len(bands) > 1:
            take(inside[len(inside) // 2])
        else:
            take(inside[0])
            take(inside[-1])
    misses = [r for r in with_force if r.relative_error_percent is not None]
    take(max((r for r in with_force if r.held_out), key=_speed, default=None))
    take(max(misses, key=_excess, default=None))
    for record in sorted(with_force, key=_speed, reverse=True):
        take(record)
    position = {id(r): i for i, r in enumerate(records)}
    return sorted(chosen, key=lambda r: (_speed(r), position[id(r)]))


def _speed(record: RecordCurves) -> float:
    return float(np.max(np.abs(record.velocity))) if record.velocity.size else 0.0


def _excess(record: RecordCurves) -> float:
    return (record.relative_error_percent or 0.0) - (record.noise_percent or 0.0)

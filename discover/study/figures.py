"""Curves of a study's records, decimated for pictures."""

from __future__ import annotations

from discover.figure_data import RecordCurves
from discover.record_curves import record_view, response
from discover.rows import Accuracy
from models.device import Device
from models.flow import dean_per_speed


def record_curves(
    accuracy: Accuracy, *, band: int | None, structure: str, device: Device | None
) -> RecordCurves:
    """Return a record's curves: two cycles of a sine test, else a stretch."""
    o = accuracy.observation
    dean = {
        convention: None if device is None else o.speed * dean_per_speed(
            device, convention=convention
        )
        for convention in ("paper", "standard")
    }
    view = record_view(accuracy)
    return RecordCurves(
        **view.measured,
        responses=(response(accuracy),),
        band=band,
        structure=structure,
        dean_paper=dean["paper"],
        dean_standard=dean["standard"],
        model_force=accuracy.model_force[view.chosen],
        error_percent=accuracy.of_peak_percent,
        relative_error_percent=accuracy.relative_percent,
    )

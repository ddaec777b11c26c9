"""Curves of a study's records, decimated for pictures."""

from __future__ import annotations

from discover.figure_data import RecordCurves
from discover.rows import Accuracy
from discover.shown_samples import shown_samples
from models.device import Device
from models.flow import dean_per_speed


def record_curves(
    accuracy: Accuracy, *, band: int | None, structure: str, device: Device | None
) -> RecordCurves:
    """Return a record's curves: two cycles of a sine test, else a stretch."""
    o = accuracy.observation
    sine = o.kind == "sine"
    chosen = shown_samples(o)
    dean = {
        convention: None if device is None else o.speed * dean_per_speed(
            device, convention=convention
        )
        for convention in ("paper", "standard")
    }
    return RecordCurves(
        file=o.file,
        kind=o.kind,
        held_out=o.held_out,
        band=band,
        structure=structure,
        frequency=o.frequency if sine else None,
        amplitude=o.amplitude if sine else None,
        dean_paper=dean["paper"],
        dean_standard=dean["standard"],
        time=o.time[chosen] - o.time[0],
        displacement=o.at_samples(o.motion.displacement)[chosen],
        velocity=o.at_samples(o.motion.velocity)[chosen],
        force=o.measured[chosen],
        model_force=accuracy.model_force[chosen],
        error_percent=accuracy.of_peak_percent,
        relative_error_percent=accuracy.relative_percent,
        noise_percent=accuracy.noise_percent,
    )

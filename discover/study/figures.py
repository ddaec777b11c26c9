"""Curves of a study's records, decimated for pictures."""

from __future__ import annotations

import numpy as np

from discover.figure_data import RecordCurves
from discover.rows import Accuracy
from models.device import Device
from models.flow import dean_per_speed

_POINTS = 600
_CYCLES = 2.0


def record_curves(
    accuracy: Accuracy, *, band: int | None, structure: str, device: Device | None
) -> RecordCurves:
    """Return a record's curves: two cycles of a sine test, else the whole record."""
    o = accuracy.observation
    sine = o.kind == "sine"
    stop = o.time.size
    if sine:
        step = float((o.time[-1] - o.time[0]) / (o.time.size - 1))
        stop = min(stop, int(np.ceil(_CYCLES / (o.frequency * step))) + 1)
    chosen = np.unique(np.linspace(0, stop - 1, min(_POINTS, stop)).astype(int))
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

"""What a picture shows of a record, whatever the verb: its name, its place, decimated samples."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from discover.record_curves.shown_samples import shown_samples
from discover.rows import Accuracy


@dataclass(frozen=True)
class RecordView:
    """A record's part in every verb's picture data."""

    chosen: NDArray[np.intp]
    """(n,) indices of the usable samples that are shown."""
    measured: dict[str, Any]
    """Fields of `discover.figure_data.ShownRecord`."""


def record_view(accuracy: Accuracy) -> RecordView:
    """Return what all verbs show of a record."""
    o = accuracy.observation
    sine = o.kind == "sine"
    chosen = shown_samples(o)
    return RecordView(
        chosen,
        {
            "file": o.file,
            "kind": o.kind,
            "held_out": o.held_out,
            "frequency": o.frequency if sine else None,
            "amplitude": o.amplitude if sine else None,
            "time": o.time[chosen] - o.time[0],
            "displacement": o.at_samples(o.motion.displacement)[chosen],
            "velocity": o.at_samples(o.motion.velocity)[chosen],
            "force": o.measured[chosen],
            "noise_percent": accuracy.noise_percent,
        },
    )

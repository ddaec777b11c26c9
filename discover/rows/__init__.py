"""A campaign's records as rows, and models on them: reduced once, for every verb."""

from discover.motion_fit import Observation
from discover.rows.accuracy import (
    Accuracy,
    Unexplained,
    accuracy,
    alike_percent,
    compared_with,
    noise_percent,
    pooled_percent,
    unexplained,
)
from discover.rows.band_rows import band_rows
from discover.rows.force import RecordForces, force_at_samples, force_rows
from discover.rows.own_values import with_own_values
from discover.rows.record_rows import RecordRows
from discover.rows.sine_rows import sine_rows


def record_rows(observation: Observation) -> RecordRows:
    """Return the rows of a record of any kind."""
    return sine_rows(observation) if observation.kind == "sine" else band_rows(observation)


__all__ = [
    "Accuracy",
    "RecordForces",
    "RecordRows",
    "Unexplained",
    "accuracy",
    "alike_percent",
    "compared_with",
    "force_at_samples",
    "force_rows",
    "noise_percent",
    "pooled_percent",
    "record_rows",
    "unexplained",
    "with_own_values",
]

"""From a record to its motion and the spectral lines of its force, by kind of record."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from joblib import Parallel, delayed

from discover.motion_fit.band import observe_band
from discover.motion_fit.cycle_sums import POINTS
from discover.motion_fit.harmonic import observe_sine
from discover.motion_fit.long_sine import observe_long_sine
from discover.motion_fit.motion_noise import with_motion_noise
from discover.motion_fit.observation import Lines, Observation, Window, real_rows
from discover.motion_fit.periodic import observe_periodic
from discover.record_kind import classify
from discover.records import Record
from models.checks import InputError


def observe(record: Record) -> Observation:
    """Return the observation of a record of any kind.

    Parameters
    ----------
    record : Record
        Measured record.

    Returns
    -------
    Observation
        Motion by harmonics for a sine test, by spectrum for a periodic record, band-limited
        otherwise.

    Raises
    ------
    InputError
        Where the record can't be used, with its name.
    """
    kind = classify(record)
    if kind.kind == "sine":
        frequency = kind.frequency or record.frequency
        if frequency is None:
            raise InputError("frequency", expected="found or given", where=record.file)
        if record.long is not None and kind.sine is not None:
            return observe_long_sine(record, record.long, kind.usable, kind.sine)
        return observe_sine(record, kind.usable, frequency, kind.sine)
    if record.even is not record:
        if record.gaps:
            raise InputError(
                "time", expected="without gaps in what is no sine test",
                found=f"{record.gaps} of them", where=record.file,
            )
        record = record.even
        kind = classify(record)
    if kind.kind == "periodic" and kind.period is not None:
        return observe_periodic(record, kind.usable, round(kind.period / record.step))
    return observe_band(record, kind.usable, kind.kind)


def observe_all(records: Sequence[Record], jobs: int) -> tuple[Observation, ...]:
    """Return the observation of every record of a campaign, numbered, over `jobs` threads."""
    if jobs <= 1 or len(records) < 2:
        seen = [observe(r) for r in records]
    else:
        seen = Parallel(n_jobs=jobs, prefer="threads")(delayed(observe)(r) for r in records)
    return with_motion_noise([replace(o, test=p) for p, o in enumerate(seen, start=1)])


__all__ = ["POINTS", "Lines", "Observation", "Window", "observe", "observe_all", "real_rows"]

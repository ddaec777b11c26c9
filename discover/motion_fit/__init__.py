"""From a record to its motion and the spectral lines of its force, by kind of record."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import replace
from typing import Any

from threadpoolctl import threadpool_limits

from discover.executor import Lost, executor
from discover.motion_fit.band import BandFound, find_band, observe_band
from discover.motion_fit.clear_samples import Clear
from discover.motion_fit.cycle_sums import POINTS
from discover.motion_fit.harmonic import find_sine, observed
from discover.motion_fit.long_sine import find_long_sine
from discover.motion_fit.motion_noise import with_motion_noise
from discover.motion_fit.observation import Lines, Observation, Window, real_rows
from discover.motion_fit.periodic import observe_periodic
from discover.motion_fit.sine_found import SineFound
from discover.record_kind import classify
from discover.records import Record
from models.checks import InputError

Found = Mapping[Callable[[Record], Any], Any]
"""What was found in a record, by what found it."""


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
        clear = None
        if _sine not in record.found:
            found, clear = _sine_and_clear(record)
            record.learn({_sine: found})
        return observed(record, record.once(_sine), clear)
    even = record.even
    if even is not record:
        if record.gaps:
            raise InputError(
                "time", expected="without gaps in what is no sine test",
                found=f"{record.gaps} of them", where=record.file,
            )
        kind = classify(even)
    if kind.kind == "periodic" and kind.period is not None:
        return observe_periodic(even, kind.usable, round(kind.period / even.step))
    motion = None
    if _band not in record.found:
        band, motion = find_band(even, kind.usable)
        record.learn({_band: band})
    return observe_band(even, kind.usable, kind.kind, record.once(_band), motion)


def _sine(record: Record) -> SineFound:
    return _sine_and_clear(record)[0]


def _sine_and_clear(record: Record) -> tuple[SineFound, Clear | None]:
    """Return what is found in a sine test, and which samples are clear where all are held."""
    kind = classify(record)
    frequency = kind.frequency or record.frequency
    if frequency is None:
        raise InputError("frequency", expected="found or given", where=record.file)
    if record.long is not None and kind.sine is not None:
        return find_long_sine(record, record.long, kind.usable, kind.sine), None
    return find_sine(record, kind.usable, frequency, kind.sine)


def _band(record: Record) -> BandFound:
    return find_band(record.even, classify(record.even).usable)[0]


def found_in(record: Record) -> Found:
    """Return what is found in a record on the way to its observation; it can go to any process.

    A record that can't be used is found out where it is observed.
    """
    with suppress(InputError), threadpool_limits(1):
        observe(record)
    return dict(record.found)


def stands_for_samples(record: Record) -> bool:
    """Tell whether what was found in a record stands for its samples: in a longer sine test.

    A carried system is moved by all samples of its input.
    """
    found = record.found.get(_sine)
    return found is not None and found.sums is not None and not record.inputs


def observe_all(records: Sequence[Record], jobs: int = 1) -> tuple[Observation, ...]:
    """Return the observation of every record of a campaign, numbered, over `jobs` processes."""
    unseen = [r for r in records if not (_sine in r.found or _band in r.found)]
    if jobs > 1 and len(unseen) > 1:
        with executor(jobs) as where:
            for place, found in where.finished(found_in, unseen):
                if isinstance(found, Lost):
                    raise InputError("record", expected="worked on", found=found.reason,
                                     where=unseen[place].file)  # fmt: skip
                unseen[place].learn(found)
    with threadpool_limits(1):  # so that one process finds what several do
        seen = [observe(r) for r in records]
    return with_motion_noise([replace(o, test=p) for p, o in enumerate(seen, start=1)])


__all__ = [
    "POINTS",
    "Found",
    "Lines",
    "Observation",
    "Window",
    "found_in",
    "observe",
    "observe_all",
    "real_rows",
    "stands_for_samples",
]

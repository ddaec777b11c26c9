"""What checks ask of all samples of a record, once: the answers go with it to other processes."""

from __future__ import annotations

import hashlib

import numpy as np

from discover.record_checks.apparent import Apparent, apparent
from discover.record_checks.loop_work import LoopWork, loop_work
from discover.record_checks.one_way import comes_back, turns_back
from discover.record_kind import classify
from discover.records import Record


def work_of(record: Record) -> LoopWork | None:
    """Return the work over closed loops; None where none closes, or nothing tells the motion."""
    return record.once(_work)


def apparent_of(record: Record) -> Apparent | None:
    """Return apparent mass and damping; None without a displacement.

    Raises
    ------
    InputError
        Where the record can't be classified.
    """
    return record.once(_apparent)


def digest_of(record: Record) -> str:
    """Return what tells the samples of force and displacement from others."""
    return record.once(_digest)


def returns(record: Record) -> bool:
    """Return whether a record's motion comes back, or nothing tells it."""
    return record.once(_returns)


def turns(record: Record) -> bool:
    """Return whether a record's displacement both rises and falls, or nothing tells it."""
    return record.once(_turns)


def force_deviation(record: Record) -> float:
    """Return the force's root mean square about its mean, N."""
    return record.once(_force_deviation)


def _work(record: Record) -> LoopWork | None:
    even = record.even
    if even.displacement is None:
        return None
    return loop_work(even.displacement, even.force)


def _apparent(record: Record) -> Apparent | None:
    return apparent(record, classify(record))


def _returns(record: Record) -> bool:
    even = record.even
    return even.displacement is None or comes_back(even.displacement)


def _turns(record: Record) -> bool:
    even = record.even
    return even.displacement is None or turns_back(even.displacement)


def _digest(record: Record) -> str:
    digest = hashlib.sha256(record.force.tobytes())
    if record.displacement is not None:
        digest.update(record.displacement.tobytes())
    return digest.hexdigest()


def _force_deviation(record: Record) -> float:
    return float(np.std(record.force))

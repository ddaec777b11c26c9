"""Samples of a sine test that lie clear of the reversals of motion."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from discover.motion_fit.sine_found import Lines
from discover.sine_fit import Harmonics, Moments, harmonic_series, moments
from models.checks import Array

_REVERSAL = 3e-3  # of the speed amplitude
_GRID = 1024  # points of a cycle, among which the speed amplitude is found
BoolArray = NDArray[np.bool_]


@dataclass(frozen=True)
class Clear:
    """Samples that lie clear of the reversals of motion."""

    kept: BoolArray
    """(N,) which of the usable ones."""
    at: Moments
    """Of those that are kept."""


def clear_samples(time: Array, frequency: float, displacement: Lines | None) -> Clear:
    """Return which samples at times (N,), s, lie clear; arguments as of `moving`."""
    every = moments(time)
    kept = moving(every, frequency, displacement)
    return Clear(kept, every.of(kept))


def moving(at: Moments, frequency: float, displacement: Lines | None) -> BoolArray:
    """Return which samples lie clear of the reversals of motion.

    Where friction reverses, a sample is on one side or the other by chance: where sampling and
    test are in step, always the same ones. They are a five-hundredth of the samples.
    """
    if displacement is None:
        return np.ones(at.time.size, dtype=bool)
    phasors = 1j * np.arange(displacement.size) * displacement
    cycle = harmonic_series(np.arange(_GRID) / (_GRID * frequency), frequency, phasors)
    velocity = Harmonics(at, frequency).series(phasors)
    return np.asarray(np.abs(velocity) > _REVERSAL * float(np.abs(cycle).max()))

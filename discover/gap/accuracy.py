"""How far a model's force is from the measured one, in one record."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from discover.motion_fit import Observation
from models.checks import Array


@dataclass(frozen=True)
class Misfit:
    """Mean squares of one record, N^2."""

    error: float
    """Measured less model, over the band."""
    force: float
    """Measured."""
    noise: float
    """The force's noise."""
    samples: int
    """Number of usable samples."""

    @property
    def percent(self) -> float:
        """100 ||F - model||/||F||."""
        return pooled([self])

    @property
    def noise_percent(self) -> float:
        """100 ||noise||/||F||."""
        return pooled([self], noise=True)


def misfit(observation: Observation, force: Array) -> Misfit:
    """Compare a force (N,) on the motion's grid with the measured one.

    A sine test is compared sample by sample; other records over the lines of their band.
    """
    noise = sum(w.share * w.noise_power for w in observation.windows)
    size = observation.measured.size
    if observation.kind == "sine":
        left = sample_misfit(observation, force)
        square = float(np.mean(observation.measured**2))
        return Misfit(float(np.mean(left**2)), square, float(noise), size)
    error, power = 0.0, 0.0
    for w in observation.windows:
        lines = w.force - w.project(force)
        error += w.share * (float(np.sum(np.abs(lines) ** 2)) + w.rest)
        power += w.share * w.power
    return Misfit(error, power, float(noise), size)


def sample_misfit(observation: Observation, force: Array) -> Array:
    """Return the measured force less another (N,) on the motion's grid, at the samples, N."""
    return observation.measured - observation.at_samples(force)


def pooled(misfits: Sequence[Misfit], *, noise: bool = False) -> float:
    """Return 100 ||e||/||F|| over the samples of several records together."""
    error = sum(m.samples * (m.noise if noise else m.error) for m in misfits)
    force = sum(m.samples * m.force for m in misfits)
    return 100.0 * float(np.sqrt(error / force)) if force else 0.0


def records_alike(misfits: Sequence[Misfit]) -> float:
    """Return the root mean square of records' own relative gaps, %: the quiet count as the loud."""
    squares = [m.error / max(m.force, 1e-300) for m in misfits]
    return 100.0 * float(np.sqrt(np.mean(squares))) if squares else 0.0

"""How far a model's force is from the measured one, record by record."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from discover.motion_fit import Observation
from models.checks import Array
from models.constitutive import FittedTerm, ForceModel


@dataclass(frozen=True)
class Accuracy:
    """Model and measurement of one record, compared over its band."""

    observation: Observation
    """The record."""
    model_force: Array
    """(M,) N, at the usable samples."""
    error_power: float
    """N^2, mean square of measured less model: over the lines, and what is in none of them."""
    force_power: float
    """N^2, mean square of the measured force, likewise."""
    noise_power: float
    """N^2, mean square of the force's noise."""

    @property
    def samples(self) -> int:
        """Number of usable samples."""
        return self.observation.measured.size

    @property
    def relative_percent(self) -> float:
        """100 ||e||/||F||."""
        return pooled_percent([self])

    @property
    def peak(self) -> float:
        """N, of the model's force."""
        return float(np.abs(self.model_force).max())

    @property
    def of_peak_percent(self) -> float:
        """Root mean square error over the model force's peak, percent (the paper's e_d)."""
        return 100.0 * float(np.sqrt(self.error_power)) / self.peak if self.peak else float("inf")

    @property
    def noise_percent(self) -> float:
        """100 ||noise||/||F||."""
        return noise_percent([self])


def compare(observation: Observation, force: Array) -> Accuracy:
    """Return how a force (N,) on the motion's grid compares with the measured one.

    A sine test is compared sample by sample; other records over the lines of their band.
    """
    noise = sum(w.share * w.noise_power for w in observation.windows)
    model_force = observation.at_samples(force)
    if observation.kind == "sine":
        misfit = observation.measured - model_force
        square = float(np.mean(observation.measured**2))
        return Accuracy(observation, model_force, float(np.mean(misfit**2)), square, noise)
    error, power = 0.0, 0.0
    for w in observation.windows:
        lines = w.force - w.project(force)
        error += w.share * (float(np.sum(np.abs(lines) ** 2)) + w.rest)
        power += w.share * w.power
    return Accuracy(observation, model_force, error, power, noise)


def predict(observation: Observation, model: ForceModel, delay: float = 0.0) -> Accuracy:
    """Return the model's force for the record's motion, as late as its force channel is."""
    terms = model.terms
    if delay and observation.at is not None:
        return compare(observation, model.force(observation.at(observation.time - delay)))
    if delay:
        terms = (*terms, FittedTerm("time-delay", delay))
    return compare(observation, ForceModel(terms).force(observation.motion))


def _pooled(accuracies: Sequence[Accuracy], part: Callable[[Accuracy], float]) -> float:
    total = sum(a.samples * part(a) for a in accuracies)
    force = sum(a.samples * a.force_power for a in accuracies)
    return 100.0 * float(np.sqrt(total / force)) if force else float("inf")


def pooled_percent(accuracies: Sequence[Accuracy]) -> float:
    """Return 100 ||e||/||F|| over the samples of several records together."""
    return _pooled(accuracies, lambda a: a.error_power)


def noise_percent(accuracies: Sequence[Accuracy]) -> float:
    """Return 100 ||noise||/||F|| over the samples of several records together."""
    return _pooled(accuracies, lambda a: a.noise_power)

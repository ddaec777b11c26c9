"""How far a model's force is from the measured one, in each record: once, for every verb."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from discover.motion_fit import Observation
from discover.rows.force import force_at_samples, misfit_power
from discover.rows.record_rows import RecordRows
from models.checks import Array
from models.constitutive import ForceModel

_FADES = 0.1  # of a record that does not repeat, over which its ends count less
_DROWNED = 100.0  # times the median row's noise, above which a row may show nothing


@dataclass(frozen=True)
class Accuracy:
    """Model and measurement of one record, compared over its band."""

    observation: Observation
    """The record."""
    model_force: Array
    """(M,) N, at the usable samples."""
    error_power: float
    """N^2, mean square of measured less model."""
    force_power: float
    """N^2, mean square of the measured force."""
    noise_power: float
    """N^2, mean square of the force's noise."""

    @property
    def samples(self) -> int:
        """Number of usable samples."""
        return self.observation.samples

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


def accuracy(observation: Observation, model: ForceModel) -> Accuracy:
    """Return how a model's force compares with the measured one, sample by sample.

    Of a record of which the first samples are held the powers are of all, the force is at these.
    """
    here = compared_with(observation, force_at_samples(observation, model))
    if observation.whole:
        return here
    return replace(here, error_power=misfit_power(observation, model))


def compared_with(observation: Observation, force: Array) -> Accuracy:
    """Return how a force at the usable samples (M,) compares with the measured one, N."""
    noise = sum(w.share * w.noise_power for w in observation.windows)
    left = observation.measured - force
    sums = observation.sums
    if observation.whole or sums is None:
        measured = _power(observation, observation.measured)
    else:
        measured = sums.power / sums.samples
    return Accuracy(observation, force, _power(observation, left), measured, float(noise))


def _power(observation: Observation, signal: Array) -> float:
    """Return the mean square of a signal at the usable samples, over the band where it has an end.

    A filter's slope lies beyond the band, and the ends of a record that does not repeat rest on
    motion that is not there: neither counts.
    """
    if observation.cutoff is None or observation.kind == "periodic":
        return float(np.mean(signal**2))
    from scipy.signal.windows import tukey  # loaded here: sine tests do without

    taper = tukey(signal.size, _FADES)
    spectrum = np.abs(np.fft.rfft(signal * taper)) ** 2
    spectrum[1:] *= 2.0
    inside = np.fft.rfftfreq(signal.size, observation.record.even.step) <= observation.cutoff
    return float(np.sum(spectrum[inside]) / (signal.size * np.sum(taper**2)))


def _pooled(accuracies: Sequence[Accuracy], part: Callable[[Accuracy], float]) -> float:
    total = sum(a.samples * part(a) for a in accuracies)
    force = sum(a.samples * a.force_power for a in accuracies)
    return 100.0 * float(np.sqrt(total / force)) if force else 0.0


def pooled_percent(accuracies: Sequence[Accuracy]) -> float:
    """Return 100 ||e||/||F|| over the samples of several records together."""
    return _pooled(accuracies, lambda a: a.error_power)


def noise_percent(accuracies: Sequence[Accuracy]) -> float:
    """Return 100 ||noise||/||F|| over the samples of several records together."""
    return _pooled(accuracies, lambda a: a.noise_power)


def alike_percent(accuracies: Sequence[Accuracy]) -> float:
    """Return the root mean square of records' own relative errors: the quiet count as the loud."""
    squares = [a.error_power / max(a.force_power, 1e-300) for a in accuracies]
    return 100.0 * float(np.sqrt(np.mean(squares))) if squares else 0.0


@dataclass(frozen=True)
class Unexplained:
    """What a model leaves beyond noise."""

    percent: float
    """100 times its root mean square over the force's."""
    interval: tuple[float, float]
    """95 %, as the noise leaves it open."""

    def to_dict(self) -> dict[str, object]:
        """Return the document's entry."""
        return {"value": self.percent, "interval": list(self.interval)}


def unexplained(rows: Sequence[RecordRows], forces: Sequence[Array]) -> Unexplained:
    """Return what models' rows (R_r,) leave of records, the noise that rows hold taken off.

    Each record counts alike. Rows of far more noise than most only widen what is known, and are
    left out, unless all rows tell of more.
    """
    whole = _left_of(rows, forces, most=np.inf)
    clear = _left_of(rows, forces, most=_DROWNED)
    return whole if whole.interval[0] > clear.interval[1] else clear


def _left_of(rows: Sequence[RecordRows], forces: Sequence[Array], *, most: float) -> Unexplained:
    """Return `unexplained` of rows with less than `most` times the median row's noise."""
    square = doubt = 0.0
    for r, force in zip(rows, forces, strict=True):
        shown = 1.0 / np.maximum(r.size, 1e-300) ** 2
        shown = np.where(shown < most * float(np.median(shown)), shown, 0.0)
        whole = (r.target - force) ** 2
        share = np.ones(whole.size)
        for w, part in zip(r.observation.windows, r.windows, strict=True):
            share[part] = w.share
        above = np.maximum(whole - 1.0, 0.0)
        square += float(np.sum(share * shown * (whole - 1.0)))
        doubt += float(np.sum((share * shown) ** 2 * (2.0 + 4.0 * above)))
    count = max(len(rows), 1)
    half = 1.96 * float(np.sqrt(doubt))
    low, middle, high = (
        100.0 * float(np.sqrt(max(v, 0.0) / count)) for v in (square - half, square, square + half)
    )
    return Unexplained(middle, (low, high))

"""Bands of a study: which coordinate, where the boundaries lie, what holds in each."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from discover.dean import AmplitudeExponent, amplitude_exponent
from discover.regression.support import SupportFit
from discover.segmentation import MIN_WINDOWS, Segmentation, segment
from discover.selection.discrepancy import with_discrepancy
from discover.selection.judge import Judgement, judge
from discover.selection.structures import NUISANCE, named_supports
from discover.study.options import StudyOptions
from discover.study.preparation import Prepared
from discover.triangle import WindowRows
from models.checks import Array
from models.device import Device
from models.flow import dean_per_speed

_CLEARLY_BETTER = 5.0  # nats by which frequency must beat speed to become the coordinate


@dataclass(frozen=True)
class Bands:
    """The division of a study and the verdict on each band."""

    coordinate: str
    """"dean", "speed" or "frequency"."""
    segmentation: Segmentation
    """On the fitted windows."""
    judgements: tuple[Judgement, ...]
    """Of each band."""
    exponent: AmplitudeExponent | None
    """How the lowest boundary follows the amplitude; None without one, or with one amplitude."""
    frequency_advantage: float
    """Nats by which the division by frequency beats that by speed; 0 where not compared."""
    single: bool
    """True where one record, or too few, allow one band only."""


def coordinate_values(
    windows: Sequence[WindowRows], coordinate: str, device: Device | None, convention: str
) -> Array:
    """Return the coordinate of each window."""
    if coordinate == "frequency":
        return np.array([w.frequency for w in windows])
    speed = np.array([w.speed for w in windows])
    if coordinate == "dean" and device is not None:
        return speed * dean_per_speed(device, convention=convention)
    return speed


def _search(prepared: Prepared, coordinate: Array, bands: int | None) -> Segmentation:
    """Return the division, its nuisance terms settled by the bands' own verdicts."""
    windows = prepared.fitted
    dictionary = prepared.dictionary
    if len(prepared.supports) == 1:
        supports = list(prepared.supports)
    else:
        supports = named_supports(dictionary, ())
    weighed = with_discrepancy(windows, dictionary, coordinate, supports)
    return segment(weighed, coordinate, dictionary, supports, bands=bands)


def _log_likelihood(windows: Sequence[WindowRows], fit: SupportFit) -> Array:
    combined = np.append(-fit.combined, 1.0)
    return np.array([-0.5 * np.sum((w.whitened(1.0) @ combined) ** 2) for w in windows])


def find_bands(prepared: Prepared, device: Device | None, options: StudyOptions) -> Bands:
    """Return the bands of a study."""
    windows = prepared.fitted
    records = {w.record for w in windows}
    default = "dean" if device is not None else "speed"
    chosen = options.coordinate or default
    if chosen == "dean" and device is None:
        chosen = "speed"
    advantage = 0.0
    single = len(records) == 1 or len(windows) < 2 * MIN_WINDOWS
    bands = 1 if single else options.bands
    values = coordinate_values(windows, chosen, device, options.convention)
    division = _search(prepared, values, bands)
    if not single and options.coordinate is None and options.bands is None:
        other = coordinate_values(windows, "frequency", device, options.convention)
        by_frequency = _search(prepared, other, None)
        advantage = float(by_frequency.log_evidence.max() - division.log_evidence.max())
        if advantage > _CLEARLY_BETTER and by_frequency.bands > 1:
            chosen, values, division = "frequency", other, by_frequency
    judgements = tuple(
        judge(
            [windows[i] for i in division.members(b)],
            prepared.dictionary,
            prepared.supports,
            values[division.members(b)],
            keep_all=len(prepared.supports) == 1,
        )
        for b in range(division.bands)
    )
    exponent = None
    if division.bands > 1:
        inside = np.concatenate([division.members(0), division.members(1)])
        weighed = _weighed(windows, judgements, division)
        lower, upper = judgements[0].fit, judgements[1].fit
        some = [weighed[i] for i in inside]
        exponent = amplitude_exponent(
            some, _log_likelihood(some, lower), _log_likelihood(some, upper)
        )
    return Bands(chosen, division, judgements, exponent, advantage, single)


def _weighed(
    windows: Sequence[WindowRows], judgements: Sequence[Judgement], division: Segmentation
) -> dict[int, WindowRows]:
    result: dict[int, WindowRows] = {}
    for band, judgement in enumerate(judgements):
        members = division.members(band)
        result.update(zip((int(i) for i in members), judgement.windows, strict=True))
    return result


def nuisance_terms(judgement: Judgement) -> tuple[str, ...]:
    """Return the ids of nuisance terms in a band's verdict."""
    return tuple(i for i in judgement.support.ids if i in NUISANCE)

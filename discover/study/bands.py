"""Bands of a study: which coordinate, where the boundaries lie, what holds in each."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from discover.dean import AmplitudeExponent, amplitude_exponent
from discover.regression.support import Support, SupportFit
from discover.segmentation import MIN_WINDOWS, Segmentation, segment
from discover.selection.discrepancy import with_discrepancy
from discover.selection.judge import Judgement, judge
from discover.selection.structures import EXTRAS, named_supports
from discover.study.options import StudyOptions
from discover.study.preparation import Prepared
from discover.transition import Transition, find_transition
from discover.triangle import WindowRows
from models.checks import Array, Indices
from models.device import Device
from models.flow import dean_per_speed

_CLEARLY_GRADUAL = 3.0  # nats by which a gradual change must beat the sharp division
_PURE = 0.25  # share of the other band's model up to which a test counts for its own
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
    """How the lowest boundary follows the amplitude; None where nothing tells."""
    frequency_advantage: float
    """Nats by which the division by frequency beats that by speed; 0 where not compared."""
    single: bool
    """True where one record, or too few, allow one band only."""
    transition: Transition | None = None
    """The lowest boundary as a gradual change; None where it is sharp."""


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


def _weigh(
    prepared: Prepared, coordinate: Array
) -> tuple[list[WindowRows], list[Support]]:
    """Return windows with their model error, and the supports that a band may hold."""
    dictionary = prepared.dictionary
    if len(prepared.supports) == 1:
        supports = list(prepared.supports)
    else:
        extras = _extras(prepared, coordinate)
        plain = named_supports(dictionary, ())
        supports = list(dict.fromkeys([*plain, *named_supports(dictionary, extras)]))
    return with_discrepancy(prepared.fitted, dictionary, coordinate, supports), supports


def _extras(prepared: Prepared, coordinate: Array) -> tuple[str, ...]:
    """Return the extra terms that the best model of all windows together has."""
    whole = judge(
        prepared.fitted, prepared.dictionary, prepared.supports, coordinate
    ).support
    return tuple(i for i in whole.plain if i in EXTRAS)


def _log_likelihood(windows: Sequence[WindowRows], fit: SupportFit) -> Array:
    combined = np.append(-fit.combined, 1.0)
    return np.array([-0.5 * np.sum((w.whitened @ combined) ** 2) for w in windows])


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
    weighed, supports = _weigh(prepared, values)
    division = segment(weighed, values, prepared.dictionary, supports, bands=bands)
    if not single and options.coordinate is None and options.bands is None:
        other = coordinate_values(windows, "frequency", device, options.convention)
        by_frequency = segment(weighed, other, prepared.dictionary, supports)
        advantage = float(by_frequency.log_evidence.max() - division.log_evidence.max())
        if advantage > _CLEARLY_BETTER and by_frequency.bands > 1:
            chosen, values, division = "frequency", other, by_frequency
    transition = None
    if division.bands > 1 and options.bands is None:
        transition = _gradual(weighed, values, division)
        if transition is not None and division.bands > 2:
            division = segment(weighed, values, prepared.dictionary, supports, bands=2)
    judgements = tuple(
        judge(
            [windows[i] for i in members],
            prepared.dictionary,
            prepared.supports,
            values[members],
            keep_all=len(prepared.supports) == 1,
            seed=options.seed,
        )
        for members in (_clear(division, values, b, transition) for b in range(division.bands))
    )
    exponent = None
    if division.bands > 1:
        inside = np.concatenate([division.members(0), division.members(1)])
        lower, upper = judgements[0].fit, judgements[1].fit
        some = [weighed[int(i)] for i in inside]
        exponent = amplitude_exponent(
            some, _log_likelihood(some, lower), _log_likelihood(some, upper)
        )
    return Bands(chosen, division, judgements, exponent, advantage, single, transition)


def _gradual(
    windows: Sequence[WindowRows], values: Array, division: Segmentation
) -> Transition | None:
    """Return a gradual change between the outer bands where it beats the sharp division."""
    found = find_transition(windows, values, division.best[0].fit, division.best[-1].fit)
    sharp = float(division.log_evidence[division.bands - 1])
    return found if found.log_evidence > sharp + _CLEARLY_GRADUAL else None


def _clear(
    division: Segmentation, values: Array, band: int, transition: Transition | None
) -> Indices:
    """Return a band's windows, those in the middle of a gradual change left out where it can be."""
    members = division.members(band)
    if transition is None:
        return members
    share = transition.share(values[members])
    inside = members[(share < _PURE) if band == 0 else (share > 1.0 - _PURE)]
    return inside if inside.size >= MIN_WINDOWS else members

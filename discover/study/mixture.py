"""Numbers over the variants of a structure: with and without a term that the records leave open."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.special import logsumexp, ndtr

from discover.bands.found import Found
from discover.posterior.model import Number
from discover.posterior.spread import Spread, spread_of
from models.checks import Array

_LEAST = 0.05  # of a structure's probability, from which another set of its terms counts
_TAIL = 0.025  # of the probability, outside each end of an interval of 95 %
_FAR = 6.0  # standard deviations
_POINTS = 4001  # of the grid that the mixture is summed up on


@dataclass(frozen=True)
class Normal:
    """A part of a mixture."""

    weight: float
    """Of any sum."""
    mean: float
    """Of the number."""
    deviation: float
    """Standard deviation."""


def interval_of(parts: Sequence[Normal], low: float, high: float) -> tuple[float, float]:
    """Return the 95 % interval of a mixture, of a number that lies between bounds.

    Examples
    --------
    >>> low, high = interval_of([Normal(1.0, 0.0, 1.0), Normal(1.0, 4.0, 1.0)], -10.0, 10.0)
    >>> round(low, 1), round(high, 1)
    (-1.6, 5.6)
    """
    means = np.array([p.mean for p in parts])
    wide = np.maximum([p.deviation for p in parts], 1e-300)
    share = np.array([p.weight for p in parts])
    share = share / share.sum()
    grid = np.linspace(np.min(means - _FAR * wide), np.max(means + _FAR * wide), _POINTS)
    narrow = (means[:, None] + wide[:, None] * np.linspace(-3.0, 3.0, 121)).ravel()
    at = np.sort(np.concatenate([grid, narrow]))
    below: Array = share @ ndtr((at - means[:, None]) / wide[:, None])
    ends = np.interp([_TAIL, 1.0 - _TAIL], below, at)
    return float(np.clip(ends[0], low, high)), float(np.clip(ends[1], low, high))


def normals(
    found: Found, spread: Spread, band: int
) -> dict[tuple[str, str | None], list[Normal]]:
    """Return each number of a band's structure over the sets of terms that it may have.

    Parameters
    ----------
    found : Found
        The answer.
    spread : Spread
        Of the answer's own model.
    band : int
        Its place.

    Returns
    -------
    dict
        By a term's id and a shape parameter, None for the coefficient; the answer's own first.
    """
    known: dict[tuple[str, str | None], list[Normal]] = {}
    first, others = _sets(found, band)
    _take(known, found, spread, band, first)
    for weight, place in others:
        variants = list(found.banded.variants)
        variants[band] = place
        way = replace(found, banded=replace(found.banded, variants=tuple(variants)))
        own = spread_of(way.assessed, way.assessed.predicting.model)
        _take(known, way, own, band, weight)
    return known


def _sets(found: Found, band: int) -> tuple[float, list[tuple[float, int]]]:
    """Return the share of the answer's set of terms in its structure, and the others' best."""
    values = found.banded.by_variant[band]
    best = found.banded.variants[band]
    core = found.variants[best].core
    groups: dict[tuple[str, ...], list[int]] = {}
    for place, variant in enumerate(found.variants):
        if variant.core == core and np.isfinite(values[place]):
            groups.setdefault(tuple(p.id for p in variant.parts), []).append(place)
    total = {ids: float(logsumexp(values[places])) for ids, places in groups.items()}
    whole = float(logsumexp(list(total.values())))
    own = tuple(p.id for p in found.variants[best].parts)
    others = [
        (float(np.exp(total[ids] - whole)), max(places, key=lambda v: float(values[v])))
        for ids, places in groups.items() if ids != own
    ]
    return float(np.exp(total[own] - whole)), [o for o in others if o[0] > _LEAST]


def _take(
    known: dict[tuple[str, str | None], list[Normal]], way: Found, spread: Spread, band: int,
    weight: float,
) -> None:
    for number, name in _of_band(way, spread, band):
        at = spread.numbers.index(number)
        part = Normal(weight, float(spread.mean[at]), float(spread.deviation[at]))
        known.setdefault((name, number.shape), []).append(part)


def _of_band(way: Found, spread: Spread, band: int) -> Iterator[tuple[Number, str]]:
    """Yield the numbers of a band's own terms with these terms' ids."""
    own = [way.variants[v].parts for v in way.banded.variants]
    ids = [[t.id for p in parts for t in p.terms] for parts in own]
    first = sum(len(some) for some in ids[:band])
    for number in spread.numbers:
        if first <= number.term < first + len(ids[band]):
            yield number, ids[band][number.term - first]

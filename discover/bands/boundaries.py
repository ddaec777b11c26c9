"""Where a band ends and the next begins: the posterior of the place, sharp or gradual."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.special import logsumexp

from discover.bands.divisions import gradual, refined, sharp
from discover.bands.found import Found
from discover.bands.search import Banded, BandSearch
from models.checks import Array

_PLACES, _WIDTHS = 61, np.geomspace(0.1, 4.0, 16)  # tried: how many, and of the logarithm


@dataclass(frozen=True)
class Boundary:
    """Where one band ends and the next begins."""

    value: float
    """Of the coordinate: the geometric middle of the bracket, or where models share alike if the
    search found that the change is gradual."""
    bracket: tuple[float, float]
    """Coordinates of the tests on either side."""
    interval: tuple[float, float]
    """95 %; never narrower than the bracket."""
    width: float | None
    """Where gradual: range of the coordinate's natural logarithm from 10 to 90 % of the upper
    band's model."""


def boundaries_of(found: Found) -> tuple[Boundary, ...]:
    """Return the boundaries of an answer's bands, each with the others held.

    A place is no surer than the structures: its likelihood is taken to the same power.
    """
    return tuple(
        _boundary(found.search, found.banded, b, found.power)
        for b in range(found.banded.bands - 1)
    )


def _boundary(search: BandSearch, banded: Banded, lower: int, power: float) -> Boundary:
    values = search.coordinates[banded.coordinate]
    whole = _merged(banded.shares, lower)
    parts, ends = sharp(values)
    shares, kept = refined(whole, lower, parts)
    few = search.only(banded.variants)
    start = np.tile(np.arange(banded.bands), (len(shares), 1))
    found = power * few.many(banded.place, banded.scale, shares, start).value
    chances = np.exp(found - logsumexp(found))
    ends = ends[kept]
    bracket = banded.brackets[lower]
    total = np.cumsum(chances)
    first = int(np.searchsorted(total, 0.025))
    last = min(int(np.searchsorted(total, 0.975)), kept.size - 1)
    interval = (min(float(ends[first, 0]), bracket[0]), max(float(ends[last, 1]), bracket[1]))
    middle = float(np.sqrt(bracket[0] * bracket[1]))
    own = banded.shares[lower]
    if not np.any((own > 0.0) & (own < whole[lower])):
        return Boundary(middle, bracket, interval, None)
    place, width, near = _gradual(few, banded, lower, whole, values, power)
    low, high = min(interval[0], near[0]), max(interval[1], near[1])
    return Boundary(place, bracket, (low, high), width)


def _merged(shares: Array, lower: int) -> Array:
    """Return a division with two neighbouring bands as one."""
    return np.concatenate(
        [shares[:lower], shares[lower : lower + 1] + shares[lower + 1 : lower + 2],
         shares[lower + 2 :]]
    )


def _gradual(
    search: BandSearch, banded: Banded, lower: int, whole: Array, values: Array, power: float
) -> tuple[float, float, tuple[float, float]]:
    """Return the place of a gradual change, its width, and the place's interval."""
    inside = values[whole[lower] > 0.5]
    low, high = np.log(inside.min()), np.log(inside.max())
    places = np.exp(np.linspace(low, high, _PLACES)[1:-1])
    place, width = (g.ravel() for g in np.meshgrid(places, _WIDTHS))
    both = gradual(values, place, width) * whole[lower]
    rest_below = np.broadcast_to(whole[:lower], (len(both), lower, values.size))
    rest_above = np.broadcast_to(
        whole[lower + 1 :], (len(both), whole.shape[0] - lower - 1, values.size)
    )
    shares = np.concatenate([rest_below, both, rest_above], axis=1)
    start = np.tile(np.arange(banded.bands), (len(shares), 1))
    found = power * search.many(banded.place, banded.scale, shares, start).value
    best = int(found.argmax())
    of_place = logsumexp(found.reshape(_WIDTHS.size, places.size), axis=0)
    total = np.cumsum(np.exp(of_place - logsumexp(of_place)))
    first = int(np.searchsorted(total, 0.025))
    last = min(int(np.searchsorted(total, 0.975)), places.size - 1)
    near = float(places[first]), float(places[last])
    return float(place[best]), float(width[best]), near


def line_evidence(found: Found, upper: Array) -> Array:
    """Return the log evidence (D,), to the answer's power, of other divisions of its lowest bands.

    Parameters
    ----------
    found : Found
        Of two bands or more: those between the two lowest ones are divided anew.
    upper : ndarray of bool, shape (D, U)
        Which of their units would be in the upper one.
    """
    search, banded = found.search, found.banded
    whole = banded.shares[0] + banded.shares[1]
    above = np.where(upper, whole, 0.0)
    rest = np.broadcast_to(banded.shares[2:], (len(upper), banded.bands - 2, whole.size))
    shares = np.concatenate([np.stack([whole - above, above], axis=1), rest], axis=1)
    start = np.tile(np.arange(banded.bands), (len(shares), 1))
    few = search.only(banded.variants)
    return found.power * few.many(banded.place, banded.scale, shares, start).value

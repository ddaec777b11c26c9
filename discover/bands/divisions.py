"""Where bands end: every division of the tests along a coordinate, sharp or gradual."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.special import logsumexp

from models.checks import Array, Indices

TEN_TO_NINETY = float(2.0 * np.log(9.0))
"""Width of a logistic curve from a tenth to nine tenths, in its scales."""
FEWEST = 2
"""Units in a band."""
Brackets = tuple[tuple[float, float], ...]
"""Coordinates of the units beside each boundary, in rising order."""

_THERE = 0.9
"""Share of a unit that is in a band, from which the unit counts as one of it: beyond a gradual
change. A change that no record is beyond on either side is no boundary, but a sum of two laws."""
_ALIKE = 1e-3  # of a coordinate, by which units differ that are at one place: a rig's set point
_PLACES = 9  # of a gradual change that are tried, even in the logarithm
_WIDTHS = (0.6, 1.2, 2.4)
"""Of gradual changes that are weighed beside sharp ones: finer ones follow around the best."""
_FINER = 3  # times, in place and width, that the next look around the best is
_GRADUAL = 0.1
"""Chance beforehand that a boundary is gradual."""


@dataclass(frozen=True)
class Cut:
    """Where a band is divided in two."""

    coordinate: str
    """Along which; "" for a division that has one band only."""
    band: int
    """That is divided."""
    place: float
    """Logarithm of the coordinate in the middle."""
    width: float
    """Of the coordinate's logarithm, from a tenth to nine tenths; 0 where sharp."""
    steps: tuple[float, float]
    """To neighbouring gradual ones: of `place`, and of the logarithm of `width`."""


@dataclass(frozen=True)
class Divisions:
    """Ways to divide units into one number of bands."""

    cuts: tuple[Cut, ...]
    """The last one of each of the D ways."""
    shares: Array
    """(D, B, U) how much of each unit is in each band."""
    brackets: tuple[Brackets, ...]
    """Of each way."""
    log_prior: Array
    """(D,) nats."""

    def only(self, ways: Sequence[int]) -> Divisions:
        """Return some of the ways."""
        some = list(ways)
        return Divisions(
            tuple(self.cuts[i] for i in some), self.shares[some],
            tuple(self.brackets[i] for i in some), self.log_prior[some],
        )  # fmt: skip


def ordered(coordinate: Array) -> Indices:
    """Return the order of units along a coordinate (U,)."""
    return np.argsort(coordinate, kind="stable")


def sharp(coordinate: Array, *, fewest: int = FEWEST) -> tuple[Array, Array]:
    """Return every division of units in two, and where it lies.

    Parameters
    ----------
    coordinate : ndarray, shape (U,)
        Above zero.
    fewest : int
        Units in a band.

    Returns
    -------
    shares : ndarray, shape (D, 2, U)
        1 where a unit is in the band, else 0. Units of one coordinate stay together.
    brackets : ndarray, shape (D, 2)
        Coordinates of the units beside the division.
    """
    order = ordered(coordinate)
    sorted_values = coordinate[order]
    shares, brackets = [], []
    for position in range(fewest, order.size - fewest + 1):
        low, high = sorted_values[position - 1], sorted_values[position]
        if high <= low * (1.0 + _ALIKE):
            continue
        upper = np.zeros(order.size)
        upper[order[position:]] = 1.0
        shares.append(np.stack([1.0 - upper, upper]))
        brackets.append((low, high))
    count = order.size
    return (
        np.array(shares).reshape(-1, 2, count),
        np.array(brackets, dtype=np.float64).reshape(-1, 2),
    )


def refined(shares: Array, band: int, parts: Array) -> tuple[Array, Indices]:
    """Return divisions in which one band is divided again, and which of the parts these are.

    Parameters
    ----------
    shares : ndarray, shape (B, U)
        Of a division.
    band : int
        That is divided.
    parts : ndarray, shape (D, 2, U)
        How all units are divided in two.

    Returns
    -------
    shares : ndarray, shape (E, B + 1, U)
        Those that leave enough of the units on either side.
    kept : ndarray of int, shape (E,)
        Their places among the parts.
    """
    both = parts * shares[band]
    kept = np.flatnonzero(np.all(np.count_nonzero(both > _THERE, axis=2) >= FEWEST, axis=1))
    below = np.broadcast_to(shares[:band], (kept.size, band, shares.shape[1]))
    above = np.broadcast_to(
        shares[band + 1 :], (kept.size, shares.shape[0] - band - 1, shares.shape[1])
    )
    return np.concatenate([below, both[kept], above], axis=1), kept


def gradual(coordinate: Array, places: Array, widths: Array) -> Array:
    """Return divisions in which the upper band's share rises along a logistic curve.

    Parameters
    ----------
    coordinate : ndarray, shape (U,)
        Above zero.
    places : ndarray, shape (D,)
        Coordinate of equal shares.
    widths : ndarray, shape (D,)
        Of the coordinate's logarithm, from a tenth to nine tenths.

    Returns
    -------
    ndarray, shape (D, 2, U)
    """
    distance = np.log(coordinate)[None] - np.log(places)[:, None]
    argument = np.clip(distance * (TEN_TO_NINETY / widths)[:, None], -60.0, 60.0)
    upper = 1.0 / (1.0 + np.exp(-argument))
    return np.stack([1.0 - upper, upper], axis=1)


def undivided(units: int) -> Divisions:
    """Return the one way to have all units in one band."""
    cut = Cut("", 0, 0.0, 0.0, (0.0, 0.0))
    return Divisions((cut,), np.ones((1, 1, units)), ((),), np.zeros(1))


def divided_again(
    shares: Array, brackets: Brackets, coordinates: Mapping[str, Array]
) -> Divisions | None:
    """Return every way to divide a band of a division (B, U); None where there is none.

    A tenth of the prior is that of all gradual ones.
    """
    found = []
    for name, values in coordinates.items():
        parts, ends = sharp(values)
        if not len(parts):
            continue
        inside = np.linspace(np.log(ends[0, 0]), np.log(ends[-1, 1]), _PLACES + 2)
        steps = float(inside[1] - inside[0]), float(np.log(_WIDTHS[1] / _WIDTHS[0]))
        for band in range(shares.shape[0]):
            whole, kept = refined(shares, band, parts)
            cuts = [Cut(name, band, float(np.log(ends[k]).mean()), 0.0, steps) for k in kept]
            own = tuple(_with(brackets, ends[k]) for k in kept)
            found.append(_even(cuts, whole, own, 1.0 - _GRADUAL))
            cuts = [Cut(name, band, float(p), w, steps) for w in _WIDTHS for p in inside[1:-1]]
            found.append(_along(cuts, shares, brackets, values, _GRADUAL))
    found = [f for f in found if f.cuts]
    if not found:
        return None
    log_prior = np.concatenate([f.log_prior for f in found])
    return Divisions(
        tuple(c for f in found for c in f.cuts), np.concatenate([f.shares for f in found]),
        tuple(b for f in found for b in f.brackets), log_prior - logsumexp(log_prior),
    )  # fmt: skip


def finer(
    cut: Cut, shares: Array, brackets: Brackets, coordinates: Mapping[str, Array]
) -> Divisions:
    """Return gradual ways around one of them, a third as far apart; each has its part of the prior.

    Parameters
    ----------
    cut : Cut
        A gradual one.
    shares, brackets, coordinates
        Of the division whose band it divides.
    """
    steps = cut.steps[0] / _FINER, cut.steps[1] / _FINER
    around = np.arange(-_FINER + 1, _FINER)
    cuts = [
        replace(cut, place=cut.place + i * steps[0], width=cut.width * np.exp(j * steps[1]),
                steps=steps)
        for i in around for j in around
    ]  # fmt: skip
    found = _along(cuts, shares, brackets, coordinates[cut.coordinate])
    return replace(found, log_prior=np.full(len(found.cuts), -2.0 * np.log(_FINER)))


def _along(
    cuts: Sequence[Cut], shares: Array, brackets: Brackets, values: Array, chance: float = 1.0
) -> Divisions:
    """Return gradual ways along a coordinate (U,)."""
    _, ends = sharp(values)
    places, widths = np.exp([c.place for c in cuts]), np.array([c.width for c in cuts])
    whole, kept = refined(shares, cuts[0].band, gradual(values, places, widths))
    far = [np.abs(np.log(ends) - cuts[k].place).max(axis=1).argmin() for k in kept]
    own = tuple(_with(brackets, ends[e]) for e in far)
    return _even([cuts[k] for k in kept], whole, own, chance)


def _even(
    cuts: Sequence[Cut], shares: Array, brackets: tuple[Brackets, ...], chance: float
) -> Divisions:
    prior = np.full(len(cuts), float(np.log(chance / max(len(cuts), 1))))
    return Divisions(tuple(cuts), shares, brackets, prior)


def _with(brackets: Brackets, ends: Array) -> Brackets:
    return tuple(sorted((*brackets, (float(ends[0]), float(ends[1])))))

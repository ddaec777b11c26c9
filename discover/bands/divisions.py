"""Where bands end: every division of the tests along a coordinate, sharp or gradual."""

from __future__ import annotations

import numpy as np

from models.checks import Array, Indices

TEN_TO_NINETY = float(2.0 * np.log(9.0))
"""Width of a logistic curve from a tenth to nine tenths, in its scales."""
FEWEST = 2
"""Units in a band."""


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
        if high <= low * (1.0 + 1e-6):
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


def refined(shares: Array, band: int, parts: Array) -> Array:
    """Return divisions in which one band is divided again.

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
    ndarray, shape (E, B + 1, U)
        Those that leave enough units on either side.
    """
    inside = shares[band]
    found = []
    for lower, upper in parts:
        both = np.stack([inside * lower, inside * upper])
        if np.all(np.count_nonzero(both, axis=1) >= FEWEST):
            found.append(np.concatenate([shares[:band], both, shares[band + 1 :]]))
    return np.array(found).reshape(-1, shares.shape[0] + 1, shares.shape[1])


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

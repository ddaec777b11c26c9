"""Values of many devices put together, and those among them that stand apart."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from statistics import NormalDist

import numpy as np

from models.checks import Array

FEWEST = 5
"""Values from which one of them can be said to stand apart."""
FAR = 3.5
"""Robust standard deviations from the median (Iglewicz and Hoaglin 1993)."""
_NORMAL = NormalDist()
_END = _NORMAL.inv_cdf(0.975)
_ROBUST = 1.0 / _NORMAL.inv_cdf(0.75)  # of the median deviation, to the standard deviation


@dataclass(frozen=True)
class Pooled:
    """What devices have in common, and how much they differ."""

    mean: float
    """Over devices."""
    interval: tuple[float, float]
    """95 %, of the mean."""
    spread: float
    """Standard deviation between devices, their measurements' own uncertainty taken off."""


def standard_errors(lower: Array, upper: Array) -> Array:
    """Return the standard errors (N,) of 95 % intervals."""
    return np.asarray((upper - lower) / (2.0 * _END))


def normals_of(
    values: Array, lower: Array, upper: Array, bounds: tuple[float, float]
) -> tuple[Array, Array]:
    """Return the normals whose 95 % intervals these are: their means and standard errors, (N,).

    A value need not be in the middle of its interval. One that a bound cuts off, as that of a
    coefficient near zero, is as wide about the value as on its other side.

    Examples
    --------
    >>> mean, error = normals_of(
    ...     np.array([0.5, 0.5]), np.array([0.0, 0.04]), np.array([2.46, 3.96]), (0.0, np.inf)
    ... )
    >>> mean, error.round(3)
    (array([0.5, 2. ]), array([1., 1.]))
    """
    cut = (lower <= bounds[0]) | (upper >= bounds[1])
    mean = np.where(cut, values, 0.5 * (lower + upper))
    return mean, np.asarray(np.maximum(mean - lower, upper - mean) / _END)


def pooled(values: Array, errors: Array) -> Pooled:
    """Return the mean of a fleet whose devices differ (DerSimonian and Laird 1986).

    Parameters
    ----------
    values : array
        (N,), of the devices, N > 1.
    errors : array
        (N,) standard errors above 0.

    Examples
    --------
    >>> same = pooled(np.array([1.0, 1.1, 0.9]), np.array([0.2, 0.2, 0.2]))
    >>> round(same.mean, 6), same.spread
    (1.0, 0.0)
    """
    weight = errors**-2.0
    total = weight.sum()
    mean = float(weight @ values / total)
    apart = float(weight @ (values - mean) ** 2)
    within = values.size - 1
    between = max(0.0, (apart - within) / float(total - weight @ weight / total))
    weight = 1.0 / (errors**2 + between)
    mean = float(weight @ values / weight.sum())
    reach = _END * float(weight.sum()) ** -0.5
    return Pooled(mean, (mean - reach, mean + reach), between**0.5)


def far_from_rest(values: Array, errors: Array) -> list[tuple[int, float]]:
    """Return the places of values that stand apart, with how many deviations, farthest first.

    The deviation is the fleet's robust one and the value's own error together: a value that is
    measured badly is no outlier.

    Examples
    --------
    >>> values = np.array([1.0, 1.1, 0.9, 1.05, 0.95, 4.0])
    >>> [place for place, _ in far_from_rest(values, np.full(6, 0.01))]
    [5]
    """
    if values.size < FEWEST:
        return []
    off = values - np.median(values)
    deviation = np.hypot(_ROBUST * np.median(np.abs(off)), errors)
    score = off / deviation
    places: Sequence[int] = np.argsort(-np.abs(score)).tolist()
    return [(int(i), float(score[i])) for i in places if abs(score[i]) > FAR]

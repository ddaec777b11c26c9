"""Numbers of like devices pooled in part: each device's own answer beside what the others say.

Device i's number is θᵢ, its own estimate yᵢ ~ N(θᵢ, sᵢ²), and the devices' numbers are spread over
their type, θᵢ ~ N(μ, τ²). Neither μ nor τ is given. μ is flat; τ has the reference prior of this
model, p(τ) ∝ (Σᵢ (τ / (sᵢ² + τ²))²)^½ (Bodnar, Link, Arendacká, Possolo and Elster, *Stat. Med.* 36
(2017) 378–399), which holds no scale of anybody's choice. The prior of a device is the others'
prediction of it, p(θᵢ | y of the others), a mixture over τ of normals; it is summed over a grid.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq
from scipy.special import logsumexp, ndtr

from models.checks import Array

_POINTS = 400  # of the spread's grid, even in its logarithm
_LEAST = 1e-2  # of the surest value's error, where the grid begins: nothing differs less
_MOST = 1e2  # of the values' range and errors, where the grid ends
_FAR = 9.0  # standard deviations, beyond which a normal has nothing
ENDS = (0.025, 0.975)
"""Of the probability, at the ends of an interval of 95 %."""


@dataclass(frozen=True)
class Told:
    """A number as it is stated."""

    value: float
    """Its mean."""
    interval: tuple[float, float]
    """95 %, between its tails."""


@dataclass(frozen=True)
class PartlyPooled:
    """A fleet's values, each beside what the others say."""

    values: tuple[Told, ...]
    """N of them, in the order given."""
    spread: Told
    """Standard deviation between devices (the median), from all values."""


def partly_pooled(values: Array, errors: Array, devices: Sequence[str]) -> PartlyPooled:
    """Return each value with the prior that the other devices give it.

    Parameters
    ----------
    values : array
        (N,), any unit.
    errors : array
        (N,) standard errors above 0, same unit.
    devices : sequence of str
        N names, at least two that differ. Values of one device do not tell each other.

    Returns
    -------
    PartlyPooled
        Same unit.

    Examples
    --------
    The third device hardly knows; the others agree.

    >>> found = partly_pooled(
    ...     np.array([1.0, 1.02, 1.5, 0.99]), np.array([0.02, 0.02, 0.5, 0.02]), list("abcd")
    ... )
    >>> third = found.values[2]
    >>> round(third.value, 2), third.interval[1] - third.interval[0] < 0.4
    (1.01, True)
    """
    spread = _grid(values, errors)
    prior = reference_prior(spread, errors)
    names = np.array(devices)
    told = []
    for i in range(values.size):
        others = names != names[i]
        weight, mean, wide = _evidence(values[others], errors[others], spread)
        wide = wide + spread**2  # what the others predict of this one, at each spread
        own = errors[i] ** 2
        weight = weight + prior + _log_normal(values[i] - mean, own + wide)
        both = 1.0 / (1.0 / own + 1.0 / wide)
        told.append(
            _mixture(_shares(weight), both * (values[i] / own + mean / wide), np.sqrt(both))
        )
    whole, mean, wide = _evidence(values, errors, spread)
    return PartlyPooled(tuple(told), median_of(_shares(whole + prior), spread))


def _grid(values: Array, errors: Array) -> Array:
    """Return standard deviations between devices (T,) to sum over."""
    most = _MOST * max(float(np.ptp(values)), float(errors.max()))
    return np.geomspace(_LEAST * float(errors.min()), most, _POINTS)


def reference_prior(spread: Array, errors: Array) -> Array:
    """Return the log of the reference prior (T,), for a grid that is even in the logarithm.

    Parameters
    ----------
    spread : array
        (T,) standard deviations between devices.
    errors : array
        (N,) of the devices' values, same unit.
    """
    each = spread[:, None] / (errors**2 + spread[:, None] ** 2)
    return np.asarray(0.5 * np.log(np.sum(each**2, axis=1)) + np.log(spread))


def _evidence(values: Array, errors: Array, spread: Array) -> tuple[Array, Array, Array]:
    """Return the log evidence (T,) of some values, and their mean with its variance (T,)."""
    weight = 1.0 / (errors**2 + spread[:, None] ** 2)
    total = weight.sum(axis=1)
    mean = weight @ values / total
    apart = np.sum(weight * (values - mean[:, None]) ** 2, axis=1)
    found = 0.5 * (np.log(weight).sum(axis=1) - np.log(total) - apart)
    return found, mean, 1.0 / total


def _log_normal(off: Array, variance: Array) -> Array:
    return np.asarray(-0.5 * (np.log(variance) + off**2 / variance))


def _shares(log_weight: Array) -> Array:
    return np.asarray(np.exp(log_weight - logsumexp(log_weight)))


def _mixture(share: Array, means: Array, deviations: Array) -> Told:
    """Return the mean and the interval of a mixture of normals, each (T,)."""
    low = float(np.min(means - _FAR * deviations))
    high = float(np.max(means + _FAR * deviations))

    def below(at: float, part: float) -> float:
        return float(share @ ndtr((at - means) / deviations)) - part

    first, last = (float(brentq(below, low, high, args=(part,))) for part in ENDS)
    return Told(float(share @ means), (first, last))


def median_of(share: Array, grid: Array) -> Told:
    """Return the median and the interval of a distribution over a grid.

    Parameters
    ----------
    share : array
        (T,) probabilities.
    grid : array
        (T,) values above 0, rising.
    """
    total = np.cumsum(share) - 0.5 * share
    low, middle, high = np.exp(np.interp([ENDS[0], 0.5, ENDS[1]], total, np.log(grid)))
    return Told(float(middle), (float(low), float(high)))

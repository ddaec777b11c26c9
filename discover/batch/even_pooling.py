"""Numbers that are known only to lie between two ends, pooled in part over like devices.

A boundary lies between two tests, the size over which friction turns between two steps of a scale.
Devices tested by one plan have the same ends, so what is unknown between these is not averaged out
by more devices: a normal error would say it is. Device i's number θᵢ lies between aᵢ and bᵢ, all
places alike, and the devices' numbers are spread over their type, θᵢ ~ N(μ, τ²), as in
`discover.batch.partial_pooling`; μ is flat, τ has the same prior, with the even spread's standard
deviation (bᵢ − aᵢ) / √12 as the error. Both are summed over a grid.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.special import logsumexp, ndtr

from discover.batch.partial_pooling import (
    ENDS,
    PartlyPooled,
    Told,
    median_of,
    reference_prior,
)
from models.checks import Array

_SPREADS = 32  # points of the spread's grid, even in its logarithm
_LEAST, _MOST = 0.02, 20.0  # its ends: of the narrowest width, of the range of all ends
_MEANS = 240  # points of the mean's grid among the ends, about
_TAIL = 16  # points beyond them, either way
_PLACES = 31  # between the ends of one device's number
_NOTHING = 1e-9  # of the greatest weight, below which mean and spread count for nothing
_NONE = 1e-300  # probability that stands for none, so that its logarithm is finite


def evenly_pooled(lower: Array, upper: Array, devices: Sequence[str]) -> PartlyPooled:
    """Return each number with the prior that the other devices give it.

    Parameters
    ----------
    lower, upper : array
        (N,) ends that each device's number lies between, any unit.
    devices : sequence of str
        N names, at least two that differ. Numbers of one device do not tell each other.

    Returns
    -------
    PartlyPooled
        Same unit; each value is the mean.

    Examples
    --------
    Three devices by one plan of tests, and one with a test less.

    >>> ends = np.array([[1.0, 2.0], [1.0, 2.0], [1.0, 2.0], [1.0, 4.0]])
    >>> first, *_, last = evenly_pooled(ends[:, 0], ends[:, 1], list("abcd")).values
    >>> first.interval[1] - first.interval[0] > 0.9, last.value < 2.2
    (True, True)
    """
    width = upper - lower
    reach = float(upper.max() - lower.min())
    spread = np.geomspace(_LEAST * float(width.min()), _MOST * reach, _SPREADS)
    mean, log_step = _means(np.concatenate([lower, upper]), reach)
    log_prior = reference_prior(spread, width / np.sqrt(12.0))[:, None] + log_step
    each = [
        np.log(np.maximum(_within(a, b, mean, spread), _NONE))
        for a, b in zip(lower, upper, strict=True)
    ]
    names = np.array(devices)
    told = []
    for i in range(width.size):
        weight = log_prior + sum(each[j] for j in np.flatnonzero(names != names[i]))
        told.append(_place(np.exp(weight - weight.max()), (lower[i], upper[i]), mean, spread))
    whole = logsumexp(log_prior + sum(each), axis=1)
    return PartlyPooled(tuple(told), median_of(np.exp(whole - logsumexp(whole)), spread))


def _means(ends: Array, reach: float) -> tuple[Array, Array]:
    """Return means (M,) to sum over, with the logarithm of how much each stands for.

    They are dense among the ends, however near some of these are to each other.
    """
    ends = np.unique(ends)
    parts = max(2, _MEANS // ends.size)
    pairs = zip(ends, ends[1:], strict=False)
    inside = [np.linspace(a, b, parts, endpoint=False) for a, b in pairs]
    tail = np.geomspace(1e-3, 10.0 * _MOST, _TAIL) * reach
    mean = np.concatenate([ends[0] - tail[::-1], *inside, ends[-1:], ends[-1] + tail])
    return mean, np.log(np.gradient(mean))


def _within(low: float, high: float, mean: Array, spread: Array) -> Array:
    """Return how probable it is (T, M) that a device's number lies between two ends."""
    # By the tails on the far side of the mean, which keep their digits.
    near, far = ((end - mean) / spread[:, None] for end in (low, high))
    turned = np.where(near > 0.0, -1.0, 1.0)
    return np.abs(ndtr(turned * far) - ndtr(turned * near))


def _place(weight: Array, ends: tuple[float, float], mean: Array, spread: Array) -> Told:
    """Return where between its ends a number lies, given weights (T, M) of mean and spread."""
    places = np.linspace(*ends, _PLACES)
    kept = weight > _NOTHING
    at, wide = (v[kept] for v in np.broadcast_arrays(mean, spread[:, None]))
    below = (places[:, None] - at) / wide
    # By the tails on the far side of the mean, which keep their digits.
    turned = np.where(below[0] > 0.0, -1.0, 1.0)
    mass = np.abs(np.diff(ndtr(turned * below), axis=0)) @ weight[kept]
    total = np.concatenate([[0.0], np.cumsum(mass)]) / mass.sum()
    low, high = np.interp(ENDS, total, places)
    value = float(mass @ (places[:-1] + places[1:]) / (2.0 * mass.sum()))
    return Told(value, (float(low), float(high)))

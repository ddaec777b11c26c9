"""What is told where more is left than noise: no term that predicts nothing, nothing for sure.

No structure is right there, and evidence is sure of whichever is a little less wrong: it takes each
line of a record's misfit for news. But the lines in which a record's misfit shows miss the same
thing: together they say as much as the members of a cluster do.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.special import logsumexp

from discover.bands.found import Found
from discover.posterior.left_out import predicted, predicts_best
from discover.posterior.own_share import own_lines
from models.checks import Array

Mask = NDArray[np.bool_]
_LEAST = 1e-300  # of a probability, so that it has a logarithm


def told(found: Found) -> Found:
    """Return the answer; where more is left than noise it is told with less surety.

    The likelihood of each structure is taken to a power, `Found.power`. A way that was looked for
    beside one family is told with the most probable structure of any.
    """
    if found.quiet:
        return found if found.device.family is None else found.with_values(found.banded.by_variant)
    power = found.power
    alike = [way for way in found.rivals if way.banded.bands == found.banded.bands == 1]
    first, *others = (_at_power(way, power) for way in (found, *alike))
    return _mixed([first, *others]) if others else first


def _at_power(found: Found, power: float) -> Found:
    """Return the answer with its structures weighed at a power."""
    banded = found.banded
    _, _, answer = found.search.one(
        banded.place, banded.shares, np.array(banded.variants), power=power
    )
    by_variant = banded.by_variant.copy()
    for own in _cores(found).values():
        possible = np.where(np.isfinite(by_variant[:, own]), answer.by_variant[0][:, own], -np.inf)
        by_variant[:, own] += _total(possible) - _total(by_variant[:, own])
    return found.with_values(by_variant)


def _mixed(ways: Sequence[Found]) -> Found:
    """Return the way that holds the most probable structure, its structures weighed over all ways.

    What has joined besides is no surer than the structure: two structures, each with what helps it
    most, may predict as well as each other. A way counts by how well it predicts.
    """
    errors = [predicted(way.assessed) for way in ways]
    prior = np.array([sum(j.log_prior for j in way.joined) for way in ways])
    lines = own_lines(ways[0].assessed.predicting, errors[0].size)
    chances = predicts_best(errors, prior, lines, ways[0].device.seed)
    values = np.array([way.banded.by_variant[0] for way in ways])
    values += (np.log(np.maximum(chances, _LEAST)) - logsumexp(values, axis=1))[:, None]
    by_variant = np.full((1, values.shape[1]), -np.inf)
    way_of = np.zeros(values.shape[1], dtype=int)
    for own in _cores(ways[0]).values():
        weights = logsumexp(values[:, own], axis=1)
        way_of[own] = most = int(np.argmax(weights))
        if np.isfinite(weights[most]):
            by_variant[0, own] = values[most, own] + logsumexp(weights) - weights[most]
    best = ways[0].search.of_best_core(by_variant[0])
    return ways[int(way_of[best])].with_values(by_variant)


def _cores(found: Found) -> dict[str, Mask]:
    """Return which variants (V,) have each core."""
    cores = np.array([v.core for v in found.variants])
    return {str(core): cores == core for core in dict.fromkeys(cores)}


def _total(values: Array) -> Array:
    """Return the logarithm (B, 1) of the sum of exponentials (B, V), 0 where all are none."""
    total = logsumexp(values, axis=1, keepdims=True)
    return np.where(np.isfinite(total), total, 0.0)

"""Which of several ways holds for each of like devices: its own answer beside the others'.

A type has shares π of K ways, π ~ Dirichlet(α/K, …, α/K), and each device has one way, drawn with
these shares. The first device may have any; the second has the same one for the type's sake with
probability a = 1/(1 + α), which is flat between 0 (devices say nothing of each other) and 1 (a type
has one way). A device's own study weighs the ways, all alike beforehand. The prior of a device is
what the others predict (Pólya's urn), summed over a and over what each of them may be by sequential
imputation (Kong, Liu and Wong, *J. Am. Stat. Assoc.* 89 (1994) 278–288).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.special import gammaln

from models.checks import Array

_DRAWS = 4000  # of agreement and of what unsure devices may be


@dataclass(frozen=True)
class SharedChoice:
    """Ways of devices, each device beside what the others say."""

    chances: Array
    """(N, K) probabilities; a row has the sum that it was given."""
    agreement: float
    """Probability that two devices share their way for their type's sake, 0 to 1."""


def shared_choice(alone: Array, generator: np.random.Generator) -> SharedChoice:
    """Return each device's probabilities with the prior that the other devices give it.

    Parameters
    ----------
    alone : array
        (N, K) probabilities of K ways as each device's own study gives them. What is 0 is ruled
        out, and stays so; what a row lacks to 1 belongs to ways that are not told, and stays too.
    generator : numpy.random.Generator
        Of the draws.

    Examples
    --------
    >>> alone = np.array([[1.0, 0.0], [1.0, 0.0], [1.0, 0.0], [0.4, 0.6]])
    >>> found = shared_choice(alone, np.random.default_rng(0))
    >>> round(float(found.chances[3, 0]), 1)
    0.8
    """
    total = alone.sum(axis=1, keepdims=True)
    likely = alone / total
    sure = likely.max(axis=1) == 1.0
    known = likely[sure].sum(axis=0)
    agreement = generator.permutation((np.arange(_DRAWS) + 0.5) / _DRAWS)
    chances = likely.copy()
    open_ways = np.flatnonzero(~sure)
    for i in open_ways:
        others = likely[open_ways[open_ways != i]]
        weight, counts = _imputed(known, others, agreement, generator)
        both = likely[i] * (weight @ _predicted(counts, agreement))
        chances[i] = both / both.sum()
    weight, _ = _imputed(known, likely[open_ways], agreement, generator)
    return SharedChoice(chances * total, float(weight @ agreement))


def _predicted(counts: Array, agreement: Array) -> Array:
    """Return the shares (D, K) of the next device's ways after counts (D, K) of others."""
    alpha = (1.0 / agreement - 1.0)[:, None]
    return np.asarray((counts + alpha / counts.shape[1]) / (counts.sum(1, keepdims=True) + alpha))


def _imputed(
    known: Array, likely: Array, agreement: Array, generator: np.random.Generator
) -> tuple[Array, Array]:
    """Return draws' weights (D,) and their counts of devices' ways (D, K).

    The sure devices' counts (K,) are given; those with likelihoods (N, K) are drawn one by one,
    the surest first.
    """
    draws = np.arange(agreement.size)
    counts = np.tile(known, (agreement.size, 1))
    log_weight = _log_evidence(known, agreement)
    for own in likely[np.argsort(-likely.max(axis=1), kind="stable")]:
        chance = _predicted(counts, agreement) * own
        whole = chance.sum(axis=1)
        log_weight += np.log(whole)
        drawn = generator.random(agreement.size) * whole
        way = (np.cumsum(chance, axis=1) <= drawn[:, None]).sum(axis=1)
        counts[draws, np.minimum(way, known.size - 1)] += 1.0
    weight = np.exp(log_weight - log_weight.max())
    return weight / weight.sum(), counts


def _log_evidence(counts: Array, agreement: Array) -> Array:
    """Return the log probability (D,) of counts (K,) in one order (Dirichlet-multinomial)."""
    alpha = 1.0 / agreement - 1.0
    part = alpha[:, None] / counts.size
    ways = (gammaln(counts + part) - gammaln(part)).sum(axis=1)
    return np.asarray(ways + gammaln(alpha) - gammaln(alpha + counts.sum()))

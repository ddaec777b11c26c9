"""How surely a model's numbers are known: their posterior, over the sizes of what it leaves."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass

import numpy as np
from scipy.special import logsumexp

from discover.posterior.assess import Assessed
from discover.posterior.local import judged
from discover.posterior.model import Composite, Number
from models.checks import Array

SURE = 1.96  # standard deviations, at which 95 % are of one sign
_LEAST = 0.01  # of the posterior, from which sizes count


@dataclass(frozen=True)
class Spread:
    """The posterior of a model's numbers.

    What predicts best and what is most probable beside a remainder differ as far as the remainder
    stands for a part of a term. The number is anywhere between the two.
    """

    numbers: tuple[Number, ...]
    """P of them."""
    mean: Array
    """(P,) that predict best."""
    beside: Array
    """(P,) most probable beside a remainder."""
    own: Array
    """(P,) standard deviations from either."""
    covariance: Array
    """(P, P) about the mean."""

    @property
    def deviation(self) -> Array:
        """(P,) standard deviations."""
        return np.asarray(np.sqrt(np.maximum(np.diagonal(self.covariance), 0.0)))

    def interval(self, place: int, low: float, high: float) -> tuple[float, float]:
        """Return the 95 % interval of a number that lies between bounds."""
        half = SURE * float(self.own[place])
        ends = sorted((float(self.mean[place]), float(self.beside[place])))
        return float(np.clip(ends[0] - half, low, high)), float(np.clip(ends[1] + half, low, high))


def spread_of(assessed: Assessed, predicting: Composite) -> Spread:
    """Return the posterior of a model's numbers: a mixture over the sizes that were visited.

    It is centred on the numbers that predict best; how far these are from the mixture's own, as a
    remainder may stand for a part of a term, widens it.
    """
    local = assessed.local
    start = np.array([local.model.value(n) for n in local.numbers])
    shaped = np.array([n.shape is not None for n in local.numbers])
    places = list(assessed.visited)
    values = np.array([assessed.visited[p] for p in places])
    weights = np.exp(values - logsumexp(values))
    kept = [i for i in np.argsort(-weights) if weights[i] >= _LEAST] or [int(weights.argmax())]
    share = weights[kept] / weights[kept].sum()
    means, covariances = [], []
    beside = local.beside(assessed.space, assessed.curve)
    for i in kept:
        sizes = places[i].sizes(assessed.assessor.space.own_unit)
        found = judged(local, beside, sizes).solved
        means.append(np.where(shaped, start + found.mean, found.mean))
        covariances.append(found.covariance)
    mean = np.einsum("w,wp->p", share, means)
    between = np.array(means) - mean
    whole = np.einsum("w,wpq->pq", share, covariances)
    whole = whole + np.einsum("w,wp,wq->pq", share, between, between)
    centre = np.array([predicting.value(n) for n in local.numbers])
    own = np.sqrt(np.maximum(np.diagonal(whole), 0.0))
    around = whole + np.outer(mean - centre, mean - centre)
    return Spread(local.numbers, centre, mean, own, around)


def idle(predicting: Assessed) -> list[int]:
    """Return the places of terms that may as well be nothing where terms alone predict.

    The least sure comes first; a coefficient of the wrong sign counts as nothing. So does a term
    whose shape is not told from an end of its range, where it is another term: a derivative of
    order zero is a spring.
    """
    local, solved = predicting.local, predicting.judged.solved
    wide = np.sqrt(np.maximum(np.diagonal(solved.covariance), 1e-300))
    found: dict[int, float] = {}
    for n, mean, own, sign in zip(local.numbers, solved.mean, wide, local.sign, strict=True):
        if n.shape is None:
            away = abs(mean) if sign == 0.0 else sign * mean
        else:
            term = local.model.terms[n.term].fitted.term
            low, high = next((p.lower, p.upper) for p in term.parameters if p.name == n.shape)
            value = local.model.value(n) + mean
            away = min(value - low, high - value)
        found[n.term] = min(found.get(n.term, np.inf), float(away / own))
    return sorted((p for p, s in found.items() if s <= SURE), key=lambda p: found[p])


def is_told(assessed: Assessed, terms: Collection[int]) -> bool:
    """Tell whether the records tell the sign of a coefficient among some of a model's terms.

    A term that is probable beside a remainder, but that a model which has to predict by itself
    may as well do without, stands for a part of that remainder.
    """
    spread = spread_of(assessed, assessed.predicting.model)
    own = [i for i, n in enumerate(spread.numbers) if n.term in terms and n.shape is None]
    return bool(np.any(np.abs(spread.mean[own]) > SURE * spread.deviation[own]))

"""Terms that may join a model: every shape that is tried, weighed at once beside it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.special import log_ndtr

from discover.posterior.covariance import Sizes
from discover.posterior.evidence import without
from discover.posterior.local import Local
from discover.posterior.metric import compared
from discover.posterior.space import Part, Space
from models.checks import Array, Indices
from models.constitutive import FittedTerm

_LOG_2 = float(np.log(2.0))


@dataclass(frozen=True)
class Trial:
    """A shape of a term as it is tried: one column, or several that are fitted together."""

    terms: tuple[FittedTerm, ...]
    """With the coefficients at which changes of motion or force were tried; else 1."""
    places: Indices
    """Its columns among those of all trials."""
    log_prior: float
    """Nats: of its term, and of its shape among the term's."""

    @property
    def id(self) -> str:
        """Id of its terms."""
        return self.terms[0].id


@dataclass(frozen=True)
class Trials:
    """What may join a model."""

    entries: tuple[Trial, ...]
    """Of all terms."""
    columns: Array
    """(U, T, R) in every unit, over the coefficient."""


@dataclass(frozen=True)
class Gain:
    """What a trial adds to a model's log evidence."""

    trial: Trial
    """The trial."""
    value: float
    """Nats, with its prior."""
    coefficients: tuple[float, ...]
    """Of its terms, at their most probable."""


def gains(
    space: Space, trials: Trials, local: Local, sizes: Sizes, curve: Part | None
) -> list[Gain]:
    """Return what each trial adds to the log evidence of a model, the greatest first.

    Parameters
    ----------
    space : Space
        Of the records.
    trials : Trials
        What may join.
    local : Local
        The model.
    sizes : Sizes
        Of what no term explains.
    curve : Part, optional
        Whose departures are marginalised, at the scale that suits the model best.
    """
    free = local.spread.size
    target = local.target(space.sheet.target)[:, None]
    columns = np.concatenate([local.slopes, target, trials.columns], axis=1)
    best, most = None, -np.inf
    for at in compared(space, sizes, columns, curve):
        plain = at.gram[: free + 1, : free + 1]
        left, gained = without(plain, np.arange(free), local.spread)
        value = at.log_normal - 0.5 * float(plain[-1, -1]) + gained
        if value > most:
            best, most = at.gram, value
    if best is None:
        return []
    spread = local.spread
    inner = np.eye(free) + spread[:, None] * best[:free, :free] * spread
    half = np.linalg.solve(np.linalg.cholesky(inner), spread[:, None] * best[:free])
    left = best[free:, free:] - half[:, free:].T @ half[:, free:]
    side, gram = left[1:, 0], left[1:, 1:]
    size = space.sheet.scale(trials.columns)
    sign = np.zeros(size.size)
    for entry in trials.entries:
        low, high = entry.terms[0].term.coefficient_bounds(entry.terms[0].shape)
        sign[entry.places] = float(low >= 0.0) - float(high <= 0.0)
        size[entry.places] = np.minimum(size[entry.places], max(-low, high))
    single, mean = _single(np.diagonal(gram), side, size, sign)
    found = []
    for entry in trials.entries:
        own = entry.places
        many: tuple[float, ...]
        if own.size == 1:
            one, many = float(single[own[0]]), (float(mean[own[0]]),)
        else:
            one, many = _several(gram[np.ix_(own, own)], side[own], size[own])
        found.append(Gain(entry, one + entry.log_prior, many))
    return sorted(found, key=lambda g: -g.value)


def _several(gram: Array, side: Array, size: Array) -> tuple[float, tuple[float, ...]]:
    """Return the gain of columns together, and their coefficients."""
    inner = np.eye(side.size) + size[:, None] * gram * size
    factor = np.linalg.cholesky(inner)
    half = np.linalg.solve(factor, size * side)
    value = 0.5 * float(half @ half) - float(np.sum(np.log(np.diag(factor))))
    mean = size * np.linalg.solve(factor.T, half)
    return value, tuple(float(m) for m in mean)


def _single(power: Array, side: Array, size: Array, sign: Array) -> tuple[Array, Array]:
    """Return the gain of every column by itself, (T,) nats, and its coefficient."""
    there = power > 0.0
    size = np.where(there, size, 0.0)
    grown = 1.0 + size**2 * np.maximum(power, 0.0)
    mean = size**2 * side / grown
    deviation = size / np.sqrt(grown)
    ratio = np.where(there, sign * mean / np.where(there, deviation, 1.0), 0.0)
    value = 0.5 * mean * side - 0.5 * np.log(grown)
    value = value + np.where((sign == 0.0) | ~there, 0.0, _LOG_2 + log_ndtr(ratio))
    return np.asarray(np.where(there, value, -np.inf)), mean

"""Terms that may join a model: every shape that is tried, weighed at once beside it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.special import log_ndtr

from discover.posterior.covariance import Sizes
from discover.posterior.evidence import root_of, without
from discover.posterior.local import Local
from discover.posterior.metric import Compared, Comparison
from discover.posterior.space import Part, Space
from models.checks import Array, Indices
from models.constitutive import FittedTerm

_LOG_2 = float(np.log(2.0))  # nats: a coefficient of known sign has half the places
_TOGETHER = 64  # columns of trials that are weighed at once


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
    target = local.target(space.sheet.target)[:, None]
    free = np.flatnonzero(~local.held)  # else these would take from what joins what they may not be
    model = np.concatenate([local.slopes[:, free], target], axis=1)
    found: list[Gain] = []
    for some in _in_turn(trials.entries):
        columns = np.concatenate(
            [model, trials.columns[:, np.concatenate([e.places for e in some])]], axis=1
        )
        at = Comparison(space, columns, curve).at(sizes)
        left = _beside_model(at, local.spread[free])
        found += _gains(left, some, space.sheet.scale(columns[:, model.shape[1] :]))
    return sorted(found, key=lambda g: -g.value)


def _in_turn(entries: Sequence[Trial]) -> Iterator[list[Trial]]:
    """Yield some trials after the other: trials need no products with each other."""
    some: list[Trial] = []
    count = 0
    for entry in entries:
        some.append(entry)
        count += entry.places.size
        if count >= _TOGETHER:
            yield some
            some, count = [], 0
    if some:
        yield some


def _beside_model(at: Compared, spread: Array) -> Array:
    """Return products of the measured force and trials (1 + T, 1 + T), the model taken out.

    At the scale of the curve that suits the model best.
    """
    free = spread.size
    values = []
    for some, normal in zip(at.gram, at.log_normal, strict=True):
        plain = some[: free + 1, : free + 1]
        _, gained = without(plain, np.arange(free), spread)
        values.append(normal - 0.5 * float(plain[-1, -1]) + gained)
    return without(at.gram[int(np.argmax(values))], np.arange(free), spread)[0][free:, free:]


def _gains(left: Array, entries: Sequence[Trial], size: Array) -> list[Gain]:
    """Return what trials gain, from products (1 + T, 1 + T) and sizes (T,) of their columns."""
    side, gram = left[1:, 0], left[1:, 1:]
    sign = np.zeros(size.size)
    ends = np.cumsum([0, *(e.places.size for e in entries)])
    own = [np.arange(low, high) for low, high in pairwise(ends)]
    for entry, at in zip(entries, own, strict=True):
        low, high = entry.terms[0].term.coefficient_bounds(entry.terms[0].shape)
        sign[at] = float(low >= 0.0) - float(high <= 0.0)
        size[at] = np.minimum(size[at], max(-low, high))
    single, mean = _single(np.diagonal(gram), side, size, sign)
    found = []
    for entry, at in zip(entries, own, strict=True):
        many: tuple[float, ...]
        if at.size == 1:
            one, many = float(single[at[0]]), (float(mean[at[0]]),)
        else:
            one, many = _several(gram[np.ix_(at, at)], side[at], size[at])
        found.append(Gain(entry, one + entry.log_prior, many))
    return found


def _several(gram: Array, side: Array, size: Array) -> tuple[float, tuple[float, ...]]:
    """Return the gain of columns together, and their coefficients."""
    factor = root_of(gram, size)
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

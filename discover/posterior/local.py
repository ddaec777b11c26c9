"""A model near its best values: linear in its numbers there, and fitted at given sizes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.optimize import lsq_linear

from discover.posterior.covariance import Sizes
from discover.posterior.evidence import Solved, root_of, solved
from discover.posterior.metric import Comparison
from discover.posterior.model import Composite, Evaluator, Number
from discover.posterior.space import Part, Space
from models.checks import Array, Indices
from models.terms import Scales

_ITERATIONS = 12  # steps of the climb in shape parameters at most
_ENOUGH = 0.001  # nats, of a step's gain, or of what its linear form promises
_NOTHING = 1e-200  # of a coefficient, in its unit: bounds are kept to 1e-300
_SHORTENED = 6  # times at most that a step which gains nothing is tried
_SHORTER = 0.4  # of its length, each time
_STRIDE = 0.5  # of a shape parameter's value, or of its range, in one step at most


@dataclass(frozen=True)
class Local:
    """A model with its slopes."""

    model: Composite
    """At the values around which it is linear."""
    numbers: tuple[Number, ...]
    """P of them that are free."""
    force: Array
    """(U, R) its rows."""
    slopes: Array
    """(U, P, R)."""
    spread: Array
    """(P,) standard deviation of each number beforehand: of a coefficient from zero, of a shape
    parameter from where it is."""
    sign: Array
    """(P,) 1 where a coefficient can't be negative, -1 where not positive, else 0."""

    @property
    def values(self) -> Array:
        """(P,) of the numbers; shape parameters count from where they are."""
        return np.array(
            [0.0 if n.shape is not None else self.model.value(n) for n in self.numbers]
        )

    @property
    def held(self) -> Indices:
        """(P,) True for a coefficient that its sign holds at zero."""
        return np.asarray((self.sign != 0.0) & (self.sign * self.values <= _NOTHING))

    def target(self, measured: Array) -> Array:
        """Return what the slopes times the numbers shall make (U, R) of a measured force."""
        return np.asarray(measured - self.force + np.einsum("p,upr->ur", self.values, self.slopes))

    def beside(self, space: Space, curve: Part | None) -> Comparison:
        """Return its slopes, and what they shall make of the measured force, to be compared."""
        target = self.target(space.sheet.target)[:, None]
        return Comparison(space, np.concatenate([self.slopes, target], axis=1), curve)


@dataclass(frozen=True)
class Judged:
    """A model's evidence at some sizes, its numbers' posterior, and the curve's scale."""

    value: float
    """Log evidence, nats, averaged over the curve's scales."""
    scale: float
    """Of the curve, where most of the evidence is."""
    solved: Solved
    """At that scale."""
    gram: Array
    """(P, P) products of the slopes under the inverse covariance, likewise."""
    side: Array
    """(P,) likewise, with what the slopes shall make."""


def local_of(
    space: Space,
    evaluator: Evaluator,
    model: Composite,
    numbers: Sequence[Number] | None = None,
) -> Local:
    """Return a model's linear form around its values; all its numbers are free by default."""
    free = model.numbers if numbers is None else tuple(numbers)
    at = evaluator.force(model)
    slopes = evaluator.slopes(model, free)
    spread, sign = np.ones(len(free)), np.zeros(len(free))
    sizes = space.sheet.scale(slopes)
    for i, n in enumerate(free):
        fitted = model.terms[n.term].fitted
        if n.shape is None:
            low, high = fitted.term.coefficient_bounds(fitted.shape)
            spread[i] = min(sizes[i], max(-low, high))
            sign[i] = float(low >= 0.0) - float(high <= 0.0)
        else:
            low, high = shape_bounds(model, n, space.scales)
            spread[i] = (high - low) / np.sqrt(12.0)
    return Local(model, free, at, slopes, spread, sign)


def shape_bounds(model: Composite, number: Number, scales: Scales) -> tuple[float, float]:
    """Return the sensible range of a shape parameter, that holds its value."""
    fitted = model.terms[number.term].fitted
    parameter = next(p for p in fitted.term.parameters if p.name == number.shape)
    size = scales.size(parameter.scaled_by)
    value = fitted.shape[parameter.name]
    return min(parameter.lower * size, value), max(parameter.upper * size, value)


def judged(local: Local, beside: Comparison, sizes: Sizes) -> Judged:
    """Return a model's evidence at some sizes; `beside` is its `Local.beside`."""
    at = beside.at(sizes)
    gram, side = at.gram[:, :-1, :-1], at.gram[:, :-1, -1]
    normal = at.log_normal - 0.5 * at.gram[:, -1, -1]
    found = solved(gram, side, local.spread, local.sign, normal)
    k = int(np.argmax(found.log_evidence))
    value = float(np.logaddexp.reduce(found.log_evidence)) - float(np.log(at.scales.size))
    one = Solved(found.log_evidence[k], found.mean[k], found.covariance[k])
    return Judged(value, float(at.scales[k]), one, gram[k], side[k])


def fitted(
    space: Space,
    evaluator: Evaluator,
    here: Local,
    sizes: Sizes,
    curve: Part | None,
    *,
    iterations: int = _ITERATIONS,
) -> Local:
    """Return a model at the values that are most probable at some sizes, from where it is.

    By Gauss and Newton: a step to where the linear form is most probable, shortened where that is
    no better, as long as the linear form promises enough of it.
    """
    if not here.numbers:
        return here
    best = _density(space, here, sizes, curve)
    for _ in range(iterations):
        answer = judged(here, here.beside(space, curve), sizes)
        if answer.value == -np.inf:
            return here
        wanted = _within_bounds(here, answer, space.scales)
        promised = _promised(here, answer, wanted)
        share, there, value = 1.0, here, best
        for _ in range(_SHORTENED):
            if promised * share * (2.0 - share) < _ENOUGH:
                return here
            values = _bounded(here, wanted, share, space.scales)
            trial = here.model.with_values(here.numbers, values)
            # A prior only takes away, so where the fit is no better the slopes are not needed.
            if fit_of(space, evaluator.force(trial), sizes, curve) > best:
                there = local_of(space, evaluator, trial, here.numbers)
                value = _density(space, there, sizes, curve)
                if value > best:
                    break
            share *= _SHORTER
        else:
            return here
        gained, here, best = value - best, there, value
        if gained < _ENOUGH:
            break
    return here


def _within_bounds(local: Local, answer: Judged, scales: Scales) -> Array:
    """Return the most probable values (P,) within bounds, and no stride too long.

    Numbers are bounded together: where one stays at its bound, the others make up for it.
    """
    low, high = np.array([_range(local, n, scales) for n in local.numbers]).T
    spread = local.spread
    factor = root_of(answer.gram, spread)
    goal = np.linalg.solve(factor, spread * answer.side)
    found = lsq_linear(factor.T, goal, (low / spread, high / spread), method="bvls")
    return np.asarray(found.x) * spread


def _promised(local: Local, answer: Judged, wanted: Array) -> float:
    """Return the log density that the linear form gains from where it is to values (P,), nats."""
    step = wanted - local.values
    middle = 0.5 * (wanted + local.values)
    return float(step @ (answer.side - answer.gram @ middle - middle / local.spread**2))


def _range(local: Local, number: Number, scales: Scales) -> tuple[float, float]:
    """Return what a number may be in the next step; a shape parameter counts from where it is."""
    fitted_term = local.model.terms[number.term].fitted
    if number.shape is None:
        low, high = fitted_term.term.coefficient_bounds(fitted_term.shape)
        at = local.model.value(number)
        return min(low, at) - 1e-300, max(high, at) + 1e-300
    old = fitted_term.shape[number.shape]
    low, high = shape_bounds(local.model, number, scales)
    stride = _STRIDE * max(abs(old), 0.1 * (high - low))
    return max(low - old, -stride) - 1e-300, min(high - old, stride) + 1e-300


def _bounded(local: Local, wanted: Array, share: float, scales: Scales) -> list[float]:
    """Return values part of the way to those wanted."""
    result = []
    for n, at, goal in zip(local.numbers, local.values, wanted, strict=True):
        value = at + share * (goal - at)
        if n.shape is None:
            fitted_term = local.model.terms[n.term].fitted
            low, high = fitted_term.term.coefficient_bounds(fitted_term.shape)
            value = float(np.clip(value, min(low, at), max(high, at)))
        else:
            low, high = shape_bounds(local.model, n, scales)
            value = float(np.clip(local.model.value(n) + value, low, high))
        result.append(float(value))
    return result


def _density(space: Space, local: Local, sizes: Sizes, curve: Part | None) -> float:
    """Return the log density of a model at its very values, with their prior, nats."""
    prior = -0.5 * float(np.sum((local.values / local.spread) ** 2))
    return fit_of(space, local.force, sizes, curve) + prior


def fit_of(space: Space, force: Array, sizes: Sizes, curve: Part | None) -> float:
    """Return the log density of the measured force beside a model's (U, R), nats."""
    left = (space.sheet.target - force)[:, None]
    if not np.all(np.isfinite(left)):
        return -np.inf
    at = Comparison(space, left, curve).at(sizes)
    return float(np.logaddexp.reduce(at.log_normal - 0.5 * at.gram[:, 0, 0]))

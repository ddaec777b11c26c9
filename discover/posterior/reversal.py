"""Friction's curve as it was found: which curves make it, over what length or speed it turns."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.special import logsumexp

from discover.posterior.assess import Assessed, Assessor
from discover.posterior.covariance import Sizes
from discover.posterior.local import Local, fit_of, fitted, judged, local_of
from discover.posterior.metric import curve_given
from discover.posterior.model import Composite, Number
from discover.posterior.own_curve import curves, each_alone
from discover.posterior.own_share import own_share
from discover.posterior.space import Part, Space
from discover.regression.best_subset import best_subsets
from models.checks import Array
from models.constitutive import FittedTerm

_MOST = 3  # curves that a model is given
_NOTHING = 1e-3  # of friction, below which a curve is left out
_ROUNDING = 1e-6  # of friction's greatest curve: so small a one is not seen in the records
_ENOUGH = 0.05  # of a row's noise, that these may leave of the whole curve


@dataclass(frozen=True)
class Fading:
    """What friction's curve holds of terms that need it, which falls away from its reversal.

    Their curves stand as differences from friction's own, whose coefficient is therefore what
    slides and what falls away together.
    """

    numbers: tuple[Number, ...]
    """P of the model."""
    slope: Array
    """(P,) how far what falls away moves with each."""
    variance: float
    """Of what falls away, these given."""
    main: Number
    """Friction's own coefficient."""

    def deviations(self, numbers: Sequence[Number], covariance: Array) -> tuple[float, float]:
        """Return the standard deviations of what slides and of what falls away.

        Parameters
        ----------
        numbers : sequence of Number
            Q of the model.
        covariance : ndarray, shape (Q, Q)
            Of these.
        """
        known = dict(zip(self.numbers, self.slope, strict=True))
        falling = np.array([known.get(n, 0.0) for n in numbers])
        sliding = np.array([float(n == self.main) for n in numbers]) - falling
        first, second = (float(np.sqrt(self.variance + g @ covariance @ g))
                         for g in (sliding, falling))  # fmt: skip
        return first, second


@dataclass(frozen=True)
class Reversal:
    """Friction by its curve."""

    name: str
    """Id of the term that it is."""
    terms: tuple[FittedTerm, ...]
    """Few curves that together make it: its own, and of terms that need it."""
    follows: str
    """"path" where it turns over a displacement, "motion" over a speed."""
    sure: float
    """Probability of that."""
    size: float
    """m, or m/s: of the curve alone that fits best."""
    interval: tuple[float, float]
    """95 %."""
    differs: float
    """Standard deviation between records, over the friction or its own deviation, the greater: of
    what may be nothing there is no share."""
    fading: Fading
    """What falls away beside it."""
    beside: tuple[float, float] | None = None
    """N: standard deviations of what slides and of what falls away, these curves given; None where
    the whole curve is what counts."""

    def deviations(self, numbers: Sequence[Number], covariance: Array) -> tuple[float, float]:
        """Return the standard deviations of what slides and falls away, as `Fading` does."""
        return self.beside or self.fading.deviations(numbers, covariance)

    @property
    def sliding(self) -> float:
        """N, of its own curves: those of others fade away from its reversal."""
        return sum(t.coefficient for t in self.terms if t.id == self.name)


def with_few_curves(
    assessor: Assessor, assessed: Assessed, predicting: Assessed
) -> tuple[Reversal | None, Composite]:
    """Return friction by few curves, and the model with its numbers fitted beside these.

    Its terms are those of `predicting`, friction whole at its place: what `Reversal.terms` add up
    to. A model that is stated has few curves and nothing beside its terms, neither a remainder nor
    friction of each record's own: its numbers are the best so. How surely friction is known the
    whole curve tells, where nothing is left to a remainder.
    """
    ways = [
        _with_curves(assessor, assessed, predicting, found)
        for found in reversals_of(assessor, assessed, predicting)
    ]
    if not ways:
        return None, predicting.model
    found, model, _ = max(ways, key=lambda way: way[2])
    return found, model


def _with_curves(
    assessor: Assessor, assessed: Assessed, predicting: Assessed, found: Reversal
) -> tuple[Reversal, Composite, float]:
    """Return friction by its few curves, the model fitted beside these, and its log density."""
    model, space = predicting.model, predicting.space
    name = found.name
    at = next(i for i, p in enumerate(model.terms) if p.fitted.id == name)
    whole, (first, *more) = model.terms[at], found.terms
    terms = [replace(p, fitted=first) if i == at else p for i, p in enumerate(model.terms)]
    wide = Composite((*terms, *(replace(whole, fitted=t) for t in more)))
    given = (at, *range(len(terms), len(wide.terms)))
    free = [n for n in wide.numbers if n.shape is None or n.term not in given]
    begun = local_of(space, assessor.evaluator, wide, free)
    unaided = [place.sizes(space.own_unit) for place in predicting.place.unaided]
    sizes = max(unaided, key=lambda s: fit_of(space, begun.force, s, None))
    best = fitted(space, assessor.evaluator, begun, sizes, None)
    value = max(fit_of(space, best.force, s, None) for s in unaided)
    parts = [best.model.terms[i].fitted for i in given]
    sliding = [i for i, t in zip(given, parts, strict=True) if t.id == name]
    surely = None
    if predicting is not assessed:
        surely = _deviations(assessed, best, sliding, set(given) - set(sliding))
    least = _NOTHING * sum(t.coefficient for t in parts)
    kept = tuple(t for t in parts if t.coefficient > least) or (parts[0],)
    own = FittedTerm(name, replace(found, terms=kept).sliding, whole.fitted.shape)
    aligned = [
        replace(whole, fitted=own) if i == at else p
        for i, p in enumerate(best.model.terms[: len(terms)])
    ]
    return replace(found, terms=kept, beside=surely), Composite(tuple(aligned)), value


def _deviations(
    assessed: Assessed, local: Local, sliding: Collection[int], falling: Collection[int]
) -> tuple[float, float]:
    """Return the standard deviations of two sums of terms, by places, beside what a model leaves.

    How far a sum is from what is most probable there widens it.
    """
    space = assessed.space
    sizes = assessed.place.sizes(space.own_unit)
    solved = judged(local, local.beside(space, None), sizes).solved
    away = solved.mean - local.values
    whole = solved.covariance + np.outer(away, away)

    def deviation(places: Collection[int]) -> float:
        own = [n.shape is None and n.term in places for n in local.numbers]
        return float(np.sqrt(max(whole[np.ix_(own, own)].sum(), 0.0)))

    return deviation(sliding), deviation(falling)


def reversals_of(
    assessor: Assessor, assessed: Assessed, predicting: Assessed
) -> list[Reversal]:
    """Return friction as it was found; none where a model has none, or one of its own curve.

    By the few curves that come nearest to it but for what other terms make of it: how far these
    can is told by their slopes, and only so. Where these differ, also by those that do so as it is.

    Parameters
    ----------
    assessor : Assessor
        Of the records.
    assessed : Assessed
        The model.
    predicting : Assessed
        The same at the numbers that predict best: its friction is given.
    """
    curve, own = assessor.friction, assessor.curve_of(assessed.model)
    if curve is None or own is None:
        return []
    at = [i for i, p in enumerate(assessed.model.terms) if p.fitted.id == curve.id]
    space = predicting.space
    main = predicting.model.terms[at[0]].fitted
    left = space.sheet.target - predicting.local.force
    departing, covariance, leaning = curve_given(
        space, predicting.place.sizes(space.own_unit), left, own, predicting.judged.scale,
        predicting.local.slopes,
    )  # fmt: skip
    falls = np.array([t.id != curve.id for t in own.terms])
    fading = Fading(
        predicting.local.numbers, leaning[falls].sum(axis=0),
        float(covariance[np.ix_(falls, falls)].sum()), Number(at[0], None),
    )  # fmt: skip
    one = FittedTerm(main.id, 1.0, main.shape)
    plain = space.sheet.stack([space.columns_of(r, [one]) for r in space.sheet.rows])[:, 0]
    whole = curves(space, curve)
    departed = np.searchsorted(curve.columns, own.columns)
    total = main.coefficient * plain
    total = total + np.einsum("k,ukr->ur", departing, whole[:, departed] - whole[:, :1])
    few, columns = [curve.terms[k] for k in (0, *departed)], whole[:, [0, *departed]]
    if any(main.shape.values()):  # a fitted curve of its own, beside the plainest
        few, columns = [one, *few], np.concatenate([plain[:, None], columns], axis=1)
    others = [i for i, n in enumerate(predicting.local.numbers) if n.term != at[0]]
    slopes = predicting.local.slopes
    sets = [_few(columns, total, few, slopes[:, some]) for some in (others, [])]
    slides, _ = fading.deviations(fading.numbers, predicting.judged.solved.covariance)
    without = left + main.coefficient * plain
    sizes = assessed.place.sizes(space.own_unit)
    power = 1.0 if assessed.quiet else own_share(predicting)
    follows, sure, size, interval = _turning(space, sizes, without, whole, curve, power)
    result = []
    for terms in sets[:1] if sets[0] == sets[1] else sets:
        found = Reversal(curve.id, terms, follows, sure, size, interval, 0.0, fading)
        if found.sliding > 0.0:
            found = replace(found, differs=sizes.friction / max(found.sliding, slides))
        result.append(found)
    return result


def _few(
    whole: Array, total: Array, curves: Sequence[FittedTerm], others: Array
) -> tuple[FittedTerm, ...]:
    """Return the fewest curves, with positive shares, that leave next to nothing of the whole.

    But for what other terms (U, P, R) make of it: these are fitted anew beside the curves.
    """
    columns, goal = _rows(whole), total.ravel()
    base, _ = np.linalg.qr(_rows(others))
    greatest = np.linalg.norm(columns, axis=0).max()
    columns, goal = (part - base @ (base.T @ part) for part in (columns, goal))
    columns[:, np.linalg.norm(columns, axis=0) < _ROUNDING * greatest] = 0.0
    every = range(columns.shape[1])
    path = best_subsets(columns, goal, max_terms=_MOST, nonnegative=every, keep=1)
    chosen = None
    for size in range(1, _MOST + 1):
        best = path.best(size)
        if best is None or (chosen is not None and best.misfit >= chosen.misfit):
            continue  # one curve more that may not be negative
        chosen = best
        if best.misfit < _ENOUGH * goal.size:
            break
    if chosen is None:
        return (replace(curves[0], coefficient=0.0),)
    return tuple(
        replace(curves[i], coefficient=float(c))
        for i, c in zip(chosen.indices, chosen.coefficients, strict=True)
    )


def _rows(columns: Array) -> Array:
    """Return columns (U, K, R) as a matrix (U R, K)."""
    units, count, rows = columns.shape
    return columns.transpose(0, 2, 1).reshape(units * rows, count)


def _turning(
    space: Space, sizes: Sizes, left: Array, whole: Array, curve: Part, power: float
) -> tuple[str, float, float, tuple[float, float]]:
    """Return what friction turns over, how surely, and over how much, from each curve alone.

    Likelihoods are taken to a power, the share of the lines that say something of their own.
    """
    values = each_alone(space, sizes, left, whole, power)
    kinds: dict[str, list[int]] = {}
    widths = [_width(t) for t in curve.terms]
    for k, t in enumerate(curve.terms):
        if t.id == curve.id:
            kinds.setdefault(t.term.remembers(t.shape), []).append(k)
    means = {
        kind: float(logsumexp(values[some])) - float(np.log(len(some)))
        for kind, some in kinds.items()
    }
    best = max(means, key=lambda kind: means[kind])
    sure = float(np.exp(means[best] - logsumexp(list(means.values()))))
    some = [k for k in kinds[best] if widths[k] > 0.0] or kinds[best]
    chances = np.exp(values[some] - logsumexp(values[some]))
    order = np.argsort([widths[k] for k in some])
    sorted_widths = np.array([widths[k] for k in some])[order]
    total = np.cumsum(chances[order])
    low = float(sorted_widths[np.searchsorted(total, 0.025)])
    high = float(sorted_widths[min(int(np.searchsorted(total, 0.975)), order.size - 1)])
    top = float(np.array([widths[k] for k in some])[int(chances.argmax())])
    half = float(np.sqrt(2.0))  # curves are a factor of two apart
    return best, sure, top, (low / half, high * half)


def _width(fitted: FittedTerm) -> float:
    """Return the shape parameter, with a unit, that a curve has beside its limits; 0 for none."""
    named = {p.name for p in fitted.term.parameters if p.unit and p.fitted}
    values = [v for n, v in fitted.shape.items() if n in named and v > 0.0]
    return values[0] if values else 0.0




"""What holds in each band, in numbers: the model, its terms with intervals, what it leaves."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from discover.bands.found import Found
from discover.posterior.assess import Assessed, Assessor
from discover.posterior.model import Composite, Number
from discover.posterior.reversal import Reversal, with_few_curves
from discover.posterior.spread import SURE, Spread, spread_of
from discover.study.mixture import Normal, interval_of, normals
from discover.study.prepare import Prepared
from discover.study.result import Interval, TermEstimate
from models.constitutive import FittedTerm, ForceModel


@dataclass(frozen=True)
class Estimates:
    """The bands' model as it was found."""

    assessor: Assessor
    """Of the records."""
    assessed: Assessed
    """The model, friction by its whole curve."""
    spread: Spread
    """Posterior of its numbers."""
    reversal: Reversal | None
    """Friction's curve; None without friction."""
    terms: tuple[tuple[TermEstimate, ...], ...]
    """Of each band: its structure's, what the device has besides, and friction."""

    @property
    def models(self) -> tuple[ForceModel, ...]:
        """Of each band."""
        return tuple(ForceModel(tuple(t.fitted for t in terms)) for terms in self.terms)

    @property
    def untold(self) -> frozenset[str]:
        """Ids of terms none of which is told from zero.

        What friction's curve may hold as well, a fall with speed, is told by the need of it: how
        the fall is shared out between its own term and the curve says nothing, unless the term
        predicts best without any.
        """
        curve = self.assessor.friction
        shared = {t.id for t in curve.terms} if curve is not None else set[str]()
        every = [t for terms in self.terms for t in terms]
        told = {
            t.fitted.id for t in every
            if t.interval[0] > 0.0 or t.interval[1] < 0.0
            or (t.fitted.id in shared and t.fitted.coefficient != 0.0)
        }
        return frozenset(t.fitted.id for t in every) - told


def estimated(prepared: Prepared, found: Found) -> Estimates:
    """Return what holds in each band, in numbers."""
    assessor = prepared.device.assessor
    assessed = found.assessed
    best = assessed.predicting
    reversal, model = None, best.model
    if prepared.device.with_friction:
        reversal, model = with_few_curves(assessor, assessed, best)
    none = reversal is not None and not any(t.coefficient for t in reversal.terms)
    spread = spread_of(assessed, model)
    shares = found.banded.shares
    by_band: list[list[TermEstimate]] = [[] for _ in range(found.banded.bands)]
    mixed = [normals(found, spread, b) for b in range(found.banded.bands)]
    for place, placed in enumerate(model.terms):
        if none and placed.fitted.id == prepared.device.friction.id:
            continue  # the records are best predicted without friction
        whole = reversal is not None and placed.fitted.id == prepared.device.friction.id
        if whole and reversal is not None:
            own = _friction(reversal, spread)
        else:
            own = [_estimate(model, spread, place)]
        for band, terms in enumerate(by_band):
            if placed.share is None or np.allclose(placed.share, shares[band]):
                terms += [_over_variants(t, mixed[band]) for t in own]
    return Estimates(
        assessor, best, spread, None if none else reversal,
        tuple(tuple(terms) for terms in by_band),
    )  # fmt: skip


def _estimate(model: Composite, spread: Spread, place: int) -> TermEstimate:
    """Return a term with its intervals."""
    fitted = model.terms[place].fitted
    low, high = fitted.term.coefficient_bounds(fitted.shape)
    at = _place(spread, Number(place, None))
    if at is None:
        return TermEstimate(fitted, 0.0, (fitted.coefficient,) * 2, {})
    shapes = {}
    for p in fitted.term.parameters:
        own = _place(spread, Number(place, p.name))
        if own is not None:
            shapes[p.name] = spread.interval(own, *_bounds(fitted, p.name))
    return TermEstimate(
        fitted, float(spread.deviation[at]), spread.interval(at, low, high), shapes
    )


def _over_variants(
    term: TermEstimate, known: Mapping[tuple[str, str | None], Sequence[Normal]]
) -> TermEstimate:
    """Return a term whose intervals hold what other sets of its structure's terms would give."""

    def interval(name: str | None, alone: Interval) -> Interval:
        parts = known.get((term.fitted.id, name), ())
        if len(parts) < 2:
            return alone
        low, high = _bounds(term.fitted, name)
        return interval_of(parts, low, high)

    return replace(
        term,
        interval=interval(None, term.interval),
        shape_intervals={n: interval(n, i) for n, i in term.shape_intervals.items()},
    )


def _bounds(fitted: FittedTerm, name: str | None) -> Interval:
    if name is None:
        return fitted.term.coefficient_bounds(fitted.shape)
    p = next(p for p in fitted.term.parameters if p.name == name)
    return (0.0, np.inf) if p.scaled_by else (p.lower, p.upper)


def _place(spread: Spread, number: Number) -> int | None:
    return spread.numbers.index(number) if number in spread.numbers else None


def _friction(reversal: Reversal, spread: Spread) -> Sequence[TermEstimate]:
    """Return the few curves that make friction.

    How surely is known what slides, the curves of friction itself share; what falls away, others.
    """
    surely = reversal.deviations(spread.numbers, spread.covariance)
    result = []
    for t in reversal.terms:
        alike = [o for o in reversal.terms if (o.id == reversal.name) == (t.id == reversal.name)]
        share = t.coefficient / (sum(o.coefficient for o in alike) or 1.0)
        error = abs(share) * surely[int(t.id != reversal.name)]
        half = SURE * error
        ends = (max(t.coefficient - half, 0.0), t.coefficient + half)
        result.append(TermEstimate(t, error, ends, {}))
    return result

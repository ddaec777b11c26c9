"""By how much the formulas of added effects may be wrong: what they leave is no further effect."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from discover.gap.accuracy import pooled
from discover.gap.baseline import Baseline
from discover.gap.stages import Stage, record_misfit, seen_gap
from discover.naming.fit import ModelFit, fit_model, free_parameters, misfits
from discover.naming.forces import is_joint
from discover.naming.rows import RecordRows
from models.checks import Array
from models.constitutive import FittedTerm, ForceModel

_SHAPE = 0.045  # of an effect's amplitude: no formula follows a measured shape closer
_JOINT = 0.1  # likewise of what moves the device otherwise: contact and loss are simplified
# Of one form only: they leave no doubt of shape.
_EXACT = ("inertia", "viscous-damping", "stiffness", "force-offset", "time-delay")
_STEPS = 4


@dataclass(frozen=True)
class Doubt:
    """What of a misfit the formulas of added effects may be wrong by."""

    by_record: Array
    """(N,) chi-square of each fitted record."""
    square: float = 0.0
    """Of the gap in percent, squared."""


def share_of(effect: str) -> float:
    """Return the share of an effect's amplitude by which its shape may be wrong.

    Examples
    --------
    >>> share_of("stiffness"), share_of("end-stop"), share_of("backlash")
    (0.0, 0.045, 0.1)
    """
    if effect in _EXACT:
        return 0.0
    return _JOINT if is_joint(effect) else _SHAPE


def doubt_of_added(baseline: Baseline, fit: ModelFit) -> Doubt:
    """Return the doubt of effects that an earlier search added to a given model.

    Parameters
    ----------
    baseline : Baseline
        Where the search begins.
    fit : ModelFit
        Its model, fitted to the records that are not held out.
    """
    rows: Sequence[RecordRows] = baseline.fitted_rows
    by_record, square = np.zeros(len(rows)), 0.0
    if not any(share_of(effect) for effect in baseline.added):
        return Doubt(by_record)
    now, left = fit, list(baseline.added)
    for effect in list(dict.fromkeys(left))[::-1]:
        fewer, before = _without(rows, now, effect, len(left))
        gained = np.maximum(misfits(fewer, before) - misfits(rows, now), 0.0)
        closed = _gap(fewer, before) ** 2 - _gap(rows, now) ** 2
        by_record = by_record + share_of(effect) ** 2 * gained
        square += share_of(effect) ** 2 * max(closed, 0.0)
        rows, now, left = fewer, before, [e for e in left if e != effect]
    return Doubt(by_record, square)


def _without(
    rows: Sequence[RecordRows], fit: ModelFit, effect: str, last: int
) -> tuple[list[RecordRows], ModelFit]:
    """Return records and fit without an effect among the last terms, held or fitted."""
    def fewer(terms: Sequence[FittedTerm]) -> tuple[FittedTerm, ...]:
        first = len(terms) - last
        return tuple(t for i, t in enumerate(terms) if i < first or t.id != effect)

    if not fit.model.terms:
        less = [replace(r, held=fewer(r.held)) for r in rows]
        return less, fit_model(less, fit.model, ())
    model = ForceModel(fewer(fit.model.terms), fit.model.name)
    return list(rows), fit_model(rows, model, free_parameters(model), iterations=_STEPS)


def _gap(rows: Sequence[RecordRows], fit: ModelFit) -> float:
    return pooled([record_misfit(r, fit.model) for r in rows])


def within_doubt(
    rows: Sequence[RecordRows], now: Stage, given: Doubt, rounds: Iterable[tuple[str, Stage, Stage]]
) -> bool:
    """Tell whether what is left is no more than the shapes of what was added may be wrong by.

    Parameters
    ----------
    rows : sequence of RecordRows
        All records.
    now : Stage
        The model as it is.
    given : Doubt
        Of the model that the search began with.
    rounds : iterable
        Effect, stage before and stage after of each round.
    """
    seen = [m for r, m in zip(rows, now.misfits, strict=True) if not r.observation.held_out]
    left = seen_gap(rows, now) ** 2 - pooled(seen, noise=True) ** 2
    tolerated = given.square + sum(
        share_of(effect) ** 2 * (seen_gap(rows, before) ** 2 - seen_gap(rows, after) ** 2)
        for effect, before, after in rounds
    )
    return left < tolerated

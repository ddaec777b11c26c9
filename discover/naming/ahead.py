"""What is searched before a misfit is called unknown: other starts of joints, and pairs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from discover.naming.columns import CandidateColumns
from discover.naming.contest import Contest, pair_evidence, run_contest
from discover.naming.evidence import Entry
from discover.naming.fit import ModelFit, fit_model, free_parameters, kind_of
from discover.naming.forces import DELAY, has_joint, is_joint
from discover.naming.refine import extended, refine
from discover.naming.restart import restarted
from discover.naming.rows import RecordRows
from models.constitutive import FittedTerm, ForceModel

_FIRST = 2  # effects, beside which a second is sought
_SECOND = 2  # that are kept beside each
_STEPS = 15
_KINDS = 3  # of shapes of the first, that are fitted beside the second
_SHARED = 0.6  # of what the best alone leaves, that a pair may leave
_PAIRED, _PAIRED_BY_JOINT = 0.12, 0.3  # of the misfit, likewise
_BEGUN = 0.85  # of the misfit, that an effect leaves at most, for a second to be sought beside it
_NEAR = 2.0  # times what a pair may leave, that its second leaves along a straight line


def every_joint(
    rows: Sequence[RecordRows], fit: ModelFit, contest: Contest, fits: Mapping[str, ModelFit]
) -> dict[str, ModelFit]:
    """Return the fits with those of every joint from many starts.

    A joint's first start seldom leads to its best fit.

    Parameters
    ----------
    rows : sequence of RecordRows
        Records that are fitted.
    fit : ModelFit
        Without the joint.
    contest : Contest
        That has starts of each.
    fits : mapping
        Of the effects that were refined.
    """
    found = dict(fits)
    for name in (e for e in contest.starts if is_joint(e)):
        models = [extended(fit.model, start) for start in contest.starts[name]]
        begun = fits.get(name)
        if begun is None:
            begun = fit_model(rows, models[0], (), exact=False)
        kinds = {kind_of(m.terms[-1].shape): m.terms[-1] for m in models[::-1]}
        kinds.pop(kind_of(begun.model.terms[-1].shape), None)
        besides = tuple(kinds.values())
        found[name] = restarted(rows, begun, instead_of=fit, besides=besides)
    return found


def pairs_ahead(
    rows: Sequence[RecordRows],
    contest: Contest,
    fits: Mapping[str, ModelFit],
    effects: Sequence[str],
    columns: CandidateColumns | None = None,
) -> tuple[Entry, ...]:
    """Return pairs that leave much less than any effect alone, each fitted for real.

    The contest weighs pairs along straight lines, which is not where two large effects lead.

    Parameters
    ----------
    rows : sequence of RecordRows
        Records that are fitted.
    contest : Contest
        With its effects' fits weighed.
    fits : mapping
        The fit with each leading effect.
    effects : sequence of str
        Ids that were weighed.
    columns : CandidateColumns, optional
        Of these records, where other contests share them.
    """
    left_by = {name: fit.chi2 - contest.noise for name, fit in fits.items()}
    begun_by = [name for name in fits if left_by[name] <= _BEGUN * contest.excess]
    leading = sorted(begun_by, key=lambda name: left_by[name])
    if not leading or left_by[leading[0]] <= 0.0:
        return ()
    found = []
    for place, name in enumerate(leading[:_FIRST]):
        others = [e for e in effects if e != name]
        most = {
            other: min(_SHARED * left_by[leading[0]], _paired(name, other) * contest.excess)
            for other in others
        }
        begun = _settled(rows, fits[name])
        second = run_contest(rows, begun, others, columns=columns)
        near = [
            e.effects[0]
            for e in second.entries
            if len(e.effects) == 1 and e.chi2 - second.noise <= _NEAR * most[e.effects[0]]
        ]
        second, refined = refine(rows, begun, second, others, only=near)
        if place == 0 and name != DELAY and not is_joint(name):  # two at once take minutes
            refined = every_joint(rows, begun, second, refined)
        for other in sorted(refined, key=lambda e: refined[e].chi2)[:_SECOND]:
            first, entry = contest.best(name), second.best(other)
            if refined[other].chi2 - contest.noise <= most[other] and first and entry:
                left = refined[other].chi2
                if not has_joint(refined[other].model):
                    starts = [e for e in contest.starts[name] if len(e.variants[0].parts) == 1]
                    left = _of_any_kind(rows, refined[other], starts[:_KINDS])
                found.append(_pair(rows, contest, first, entry, left))
    return tuple(found)


def _settled(rows: Sequence[RecordRows], fit: ModelFit) -> ModelFit:
    return fit_model(rows, fit.model, free_parameters(fit.model), iterations=_STEPS)


def _of_any_kind(rows: Sequence[RecordRows], fit: ModelFit, starts: Sequence[Entry]) -> float:
    """Return the least chi-square of a pair, whose first effect's shape was chosen alone before."""
    *rest, first, second = fit.model.terms
    models = [fit.model]
    for start in starts:
        (part,), (value, *_) = start.variants[0].parts, start.coefficients[0]
        other = FittedTerm(part.id, value, part.shape)
        if other.id == first.id and kind_of(other.shape) != kind_of(first.shape):
            models.append(ForceModel((*rest, other, second), fit.model.name))
    fits = [fit_model(rows, m, free_parameters(m), iterations=_STEPS) for m in models]
    return float(np.nanmin([f.chi2 for f in fits]))


def _pair(
    rows: Sequence[RecordRows], contest: Contest, first: Entry, second: Entry, chi2: float
) -> Entry:
    shapes = (*first.variants, *second.variants)
    return Entry(
        (*first.effects, *second.effects),
        shapes,
        (*first.coefficients, *second.coefficients),
        chi2,
        pair_evidence(rows, contest, chi2, shapes),
    )


def _paired(*effects: str) -> float:
    return _PAIRED_BY_JOINT if any(is_joint(e) for e in effects) else _PAIRED

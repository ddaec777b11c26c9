"""The gap search from a campaign and a model to the answer."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from threadpoolctl import threadpool_limits

from discover.figure_data import GapFigureData
from discover.gap.accuracy import pooled
from discover.gap.baseline import Baseline, prepare_baseline
from discover.gap.figures import added_to, curves, shape_of
from discover.gap.findings import findings_of
from discover.gap.leftover import leftover_in_words
from discover.gap.result import (
    CLOSED,
    CorrectedCurve,
    Gap,
    MendedTerm,
    NamedEffect,
    RecordGap,
)
from discover.gap.rounds import Round
from discover.gap.search import Search, search
from discover.gap.stages import Stage, seen_alike, seen_gap
from discover.gap.standard_error import standard_errors
from discover.gap.where import places, surface, where_in_words
from discover.motion_fit import observe_all
from discover.naming.contest import Contest
from discover.naming.evidence import AGREES, UNKNOWN
from discover.naming.fit import ModelFit
from discover.naming.forces import model_force
from discover.naming.unit_rows import whole_model
from discover.record_checks import data_errors
from discover.records import Campaign
from models.checks import InputError, one_of
from models.constitutive import Band, ForceModel, SegmentedModel
from models.terms import TERMS

_STATED = 0.97  # of the probability that the alternatives add up to
_LEAST_STATED = 0.02
_MOST_STATED = 6
_EQUAL = 0.2  # of the named effect's probability: then they can't be told apart
_CLOSED_BY_SHAPES = 1.5  # of the noise, where nothing but the shapes' own error is left


def close_gap(
    campaign: Campaign,
    model: str | ForceModel | SegmentedModel,
    *,
    fixed: bool = False,
    effects: Sequence[str] | None = None,
    seed: int = 0,
    jobs: int = 1,
    tell: Callable[[str], None] | None = None,
) -> Gap:
    """Find where model and measurement disagree, name what is missing, add it, judge.

    Parameters
    ----------
    campaign : Campaign
        Records; those held out are only predicted. Where none is marked, each is left out in
        turn.
    model : str, ForceModel or SegmentedModel
        ``fit:TERM,TERM,...``, ``foim``, ``sfoim`` (coefficients fitted first) or a model.
    fixed : bool
        Hold the model's coefficients instead of refitting them with each effect.
    effects : sequence of str, optional
        Ids that may be named; the whole vocabulary where not given, with what is added by
        `models.terms.own_terms`.
    seed : int
        Kept in the document; the search draws nothing at random.
    jobs : int
        Threads for reading the records.
    tell : callable, optional
        Is told in words what each round added: a search takes seconds to minutes.

    Returns
    -------
    Gap
        With ``to_dict()``, the document ``gap.json``.

    Raises
    ------
    InputError
        Where no record may be fitted, or for an unknown effect.
    """
    if not campaign.fitted:
        raise InputError(
            "records", expected="at least one that is not held out", found="none",
            where=campaign.source,
        )
    known = tuple(sorted(TERMS))
    chosen = known if effects is None else tuple(effects)
    for name in chosen:
        one_of("effect", name, known, where="effects")
    with threadpool_limits(1):  # its matrices are small: more threads take longer
        observations = observe_all(campaign.records, jobs)
        baseline = prepare_baseline(observations, model, fixed=fixed, device=campaign.device)
        found = search(baseline, chosen, tell=tell)
        return _answer(campaign, baseline, found, seed)


def _unseen(stage: Stage) -> float | None:
    return pooled(stage.unseen) if stage.unseen else None


def _answer(campaign: Campaign, baseline: Baseline, found: Search, seed: int) -> Gap:
    rows, start, final = baseline.rows, found.baseline, found.final
    seen = [i for i, r in enumerate(rows) if not r.observation.held_out]
    noise = pooled([final.misfits[i] for i in seen], noise=True)
    rounds = tuple(_named(baseline, entry) for entry in found.rounds)
    located = places(rows, start.fit.model)
    left = places(rows, final.fit.model)
    final_gap = seen_gap(baseline.rows, final)
    verdict = _verdict(baseline, found, final_gap, noise)
    unexplained = float(np.sqrt(max(final_gap**2 - noise**2, 0.0)))
    shape = ""
    if verdict not in ("agrees", "closed"):
        told = (where_in_words(left).rstrip("."), leftover_in_words(rows, left, final.fit.model))
        shape = "; ".join(t for t in told if t)
    records = tuple(
        RecordGap(
            r.observation.file, r.observation.held_out, now.noise_percent, was.percent, now.percent
        )
        for r, was, now in zip(rows, start.misfits, final.misfits, strict=True)
    )
    return Gap(
        title=campaign.title,
        content_hash=campaign.content_hash,
        seed=seed,
        baseline=baseline.terms,
        fitted=baseline.fitted,
        fixed=baseline.fixed,
        gap_percent=seen_gap(baseline.rows, start),
        held_out_gap_percent=_unseen(start),
        noise_percent=noise,
        where=located,
        where_text=where_in_words(located),
        rounds=rounds,
        mended=_mended_terms(baseline, found.final.fit),
        records=records,
        verdict=verdict,
        final_gap_percent=final_gap,
        final_held_out_gap_percent=_unseen(final),
        unexplained_percent=unexplained,
        shape=shape,
        last=_stated(found.last, ""),
        leave_one_out=not campaign.held_out,
        findings=(
            *data_errors(campaign),
            *findings_of(baseline, found, rounds, where_in_words(located), noise),
        ),
        given=baseline.whole,
        model=_mended(campaign, baseline, found),
        figure_data=_figures(baseline, found, rounds),
    )


def _verdict(baseline: Baseline, found: Search, gap: float, noise: float) -> str:
    """Return the verdict; of effects that were added before as of those that are added now."""
    ended = found.last.ranked[0][0]
    if not found.rounds:
        most = _CLOSED_BY_SHAPES * noise if baseline.added else np.inf
        return "agrees" if ended == AGREES and gap <= most else "unexplained"
    closed = _CLOSED_BY_SHAPES if ended == AGREES else CLOSED
    return "closed" if gap <= closed * noise else "reduced"


def _stated(contest: Contest, name: str) -> tuple[tuple[str, float], ...]:
    """Return what else it may be, until nearly all of the probability is stated."""
    stated: list[tuple[str, float]] = []
    total = contest.probabilities.get(name, 0.0)
    for other, probability in contest.ranked:
        if other == name:
            continue
        if total > _STATED or probability < _LEAST_STATED or len(stated) >= _MOST_STATED:
            break
        stated.append((other, probability))
        total += probability
    return tuple(stated)


def _named(baseline: Baseline, entry: Round) -> NamedEffect:
    fit, before, after = entry.stage.fit, entry.before, entry.after
    index = next(i for i, t in enumerate(fit.model.terms) if t.id == entry.effect)
    term = fit.model.terms[index]
    error = standard_errors(baseline.fitted_rows, fit).get(index, 0.0)
    probability = float(entry.contest.probabilities[entry.effect])
    alternatives = _stated(entry.contest, entry.effect)
    return NamedEffect(
        effect=entry.effect,
        parameters=dict(term.shape),
        coefficient=term.coefficient,
        interval=(term.coefficient - 1.96 * error, term.coefficient + 1.96 * error),
        unit=term.unit,
        probability=probability,
        alternatives=alternatives,
        indistinguishable=tuple(
            e for e, p in alternatives if p > _EQUAL * probability and e not in (AGREES, UNKNOWN)
        ),
        gap=(seen_gap(baseline.rows, before), seen_gap(baseline.rows, after)),
        alike=(seen_alike(baseline.rows, before), seen_alike(baseline.rows, after)),
        unseen=(_unseen(before), _unseen(after)),
        dropped=entry.dropped,
        corrected=None if entry.corrected is None else CorrectedCurve(
            entry.corrected.effects,
            seen_gap(baseline.rows, entry.stage),
            _unseen(entry.stage),
            entry.corrected.reversal,
        ),
    )


def _mended_terms(baseline: Baseline, fit: ModelFit) -> tuple[MendedTerm, ...]:
    errors = standard_errors(baseline.fitted_rows, fit)
    result = [MendedTerm(t, None) for t in (baseline.terms if baseline.fixed else ())]
    for index, term in enumerate(fit.model.terms):
        half = 1.96 * errors.get(index, 0.0)
        interval = (term.coefficient - half, term.coefficient + half) if index in errors else None
        result.append(MendedTerm(term, interval))
    return tuple(result)


def _mended(campaign: Campaign, baseline: Baseline, found: Search) -> SegmentedModel:
    terms = found.final.fit.model.terms
    if isinstance(baseline.whole, SegmentedModel) and len(baseline.whole.bands) > 1:
        return added_to(baseline.whole, terms)
    held = baseline.terms if baseline.fixed else ()
    model = ForceModel((*held, *terms), "mended")
    new = tuple(t.id for t in terms[len(baseline.model.terms) :])
    return SegmentedModel(
        (Band(None, None, model),), "speed", "paper", campaign.device, "mended",
        (*baseline.added, *new),
    )


def _figures(
    baseline: Baseline, found: Search, rounds: Sequence[NamedEffect]
) -> GapFigureData:
    rows = baseline.rows
    before, after = found.baseline.fit.model, found.final.fit.model
    drawn = tuple(
        curves(
            r,
            model_force(r.observation, whole_model(r, before)),
            model_force(r.observation, whole_model(r, after)),
            was,
            now,
        )
        for r, was, now in zip(rows, found.baseline.misfits, found.final.misfits, strict=True)
    )
    shapes = tuple(
        shape_of(baseline.fitted_rows, entry, i, _relative(named))
        for i, (entry, named) in enumerate(zip(found.rounds, rounds, strict=True))
    )
    return GapFigureData(drawn, shapes, surface(rows, before))


def _relative(named: NamedEffect) -> float:
    if not named.coefficient:
        return 0.0
    return (named.interval[1] - named.interval[0]) / 3.92 / abs(named.coefficient)

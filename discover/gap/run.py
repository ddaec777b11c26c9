"""The gap search from a campaign and a model to the answer."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from threadpoolctl import threadpool_limits

from discover.figure_data import GapFigureData
from discover.gap.baseline import Baseline, added_to, prepare_baseline
from discover.gap.figures import curves, shape_of
from discover.gap.findings import findings_of
from discover.gap.leftover import leftover_in_words
from discover.gap.result import Gap, MendedTerm, NamedEffect, RecordGap
from discover.gap.search import Round, Search, Stage, search
from discover.gap.verdict import CLOSED
from discover.gap.where import places, surface, where_in_words
from discover.motion_fit import observe_all
from discover.named_model import FROM_GEOMETRY, named_model
from discover.posterior.model import Number
from discover.posterior.spread import Spread, spread_of
from discover.posterior.step import Step
from discover.record_checks import data_errors, differing_records
from discover.records import Campaign, checked_campaign
from discover.rows import Unexplained, force_rows, noise_percent, unexplained
from models.checks import InputError, one_of
from models.constitutive import Band, FittedTerm, ForceModel, SegmentedModel
from models.terms import TERMS
from models.terms.between_tests import is_alike

AGREES, UNKNOWN = "agrees", "unknown"
_STATED = 0.97  # of the probability that the alternatives add up to
_LEAST_STATED = 0.02  # probability from which an alternative is listed
_MOST_STATED = 6  # alternatives that are listed
_EQUAL = 0.2  # of the named effect's probability: then they can't be told apart
_SHAPE_HOLDS = 0.1  # of an effect's size, that its shape may be wrong by


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
        ``fit:TERM,TERM,...``, ``foim``, ``sfoim`` (coefficients fitted first), ``ioim-laminar`` or
        ``ioim-turbulent`` (from the campaign's device), the path of a ``model.json``, or a model.
    fixed : bool
        Hold the model's coefficients instead of refitting them with each effect.
    effects : sequence of str, optional
        Ids that may be named; the whole vocabulary where not given, with what is added by
        `models.terms.own_terms`.
    seed : int
        Of the draws of records by which effects are compared that leave more than noise.
    jobs : int
        Processes that observe the records.
    tell : callable, optional
        Is told in words what each round added: a search takes seconds to minutes.

    Returns
    -------
    Gap
        With ``to_dict()``, the document ``gap.json``.

    Raises
    ------
    InputError
        Where no record may be fitted, for an unknown effect, or a name that needs a device.

    Examples
    --------
    >>> import discover
    >>> campaign = discover.read_campaign("data/hidden-effect")
    >>> gap = close_gap(campaign, "fit:inertia,viscous-damping", effects=["force-offset"])
    >>> round(gap.to_dict()["noise_percent"], 1)
    1.1
    """
    if not checked_campaign(campaign).fitted:
        raise InputError(
            "records", expected="at least one that is not held out", found="none",
            where=campaign.source,
        )
    if isinstance(model, str) and (model in FROM_GEOMETRY or model.endswith(".json")):
        model = named_model(model, campaign.device, where="model")
    known = tuple(sorted(TERMS))
    chosen = known if effects is None else tuple(effects)
    for name in chosen:
        one_of("effect", name, known, where="effects")
    with threadpool_limits(1):  # its matrices are small: more threads take longer
        observations = observe_all(campaign.records, jobs)
        baseline = prepare_baseline(
            observations, model, fixed=fixed, device=campaign.device, seed=seed
        )
        return _answer(campaign, baseline, search(baseline, chosen, tell=tell), seed)


def _answer(campaign: Campaign, baseline: Baseline, found: Search, seed: int) -> Gap:
    start, final = found.given, found.final
    noise = noise_percent(final.seen)
    spread = spread_of(final.assessed, final.predicting)
    located = places(baseline.rows, start.models)
    left = places(baseline.rows, final.models)
    remainder = _remainder(baseline, final)
    verdict = _verdict(found, noise, remainder)
    rounds = tuple(_named(baseline, r, i, found) for i, r in enumerate(found.rounds))
    shape = ""
    if verdict not in ("agrees", "closed"):
        told = (
            where_in_words(left).rstrip(".") if any(p.significant for p in left) else "",
            leftover_in_words(baseline.rows, left, final.models),
        )
        shape = "; ".join(t for t in told if t)
    one_law = final.assessed.quiet and all(is_alike(t.shape) for t in final.terms)
    differing = () if one_law else differing_records(baseline.rows)
    records = tuple(
        RecordGap(
            a.observation.file, a.observation.held_out, a.noise_percent, was.relative_percent,
            a.relative_percent,
        )
        for was, a in zip(start.accuracies, final.accuracies, strict=True)
    )
    return Gap(
        title=campaign.title,
        content_hash=campaign.content_hash,
        seed=seed,
        baseline=baseline.terms,
        fitted=baseline.fitted,
        fixed=baseline.fixed,
        gap_percent=start.gap,
        held_out_gap_percent=start.unseen_gap,
        noise_percent=noise,
        where=located,
        where_text=where_in_words(located),
        rounds=rounds,
        mended=_mended_terms(baseline, final, spread),
        records=records,
        verdict=verdict,
        final_gap_percent=final.gap,
        final_held_out_gap_percent=final.unseen_gap,
        unexplained_percent=float(np.sqrt(max(final.gap**2 - noise**2, 0.0))),
        remainder=remainder,
        shape=shape,
        last=_contest(found, verdict),
        leave_one_out=not campaign.held_out,
        findings=(
            *data_errors(campaign),
            *(d.finding for d in differing),
            *findings_of(baseline, found, rounds, where_in_words(located), noise, verdict),
        ),
        given=baseline.whole,
        model=_mended(campaign, baseline, found),
        figure_data=_figures(baseline, found, rounds),
    )


def _remainder(baseline: Baseline, at: Stage) -> Unexplained:
    pairs = [
        (r, m) for r, m in zip(baseline.rows, at.models, strict=True)
        if not r.observation.held_out
    ]
    return unexplained([r for r, _ in pairs], [force_rows(r, m) for r, m in pairs])


def _verdict(found: Search, noise: float, remainder: Unexplained) -> str:
    final = found.final
    quiet = final.assessed.quiet
    each = [a.relative_percent / max(a.noise_percent, 1e-300) for a in final.seen]
    alike = float(np.exp(np.mean(np.log(np.maximum(each, 1e-300)))))  # every record counts alike
    near = final.gap <= CLOSED * noise and alike <= CLOSED
    if not found.rounds:
        nothing = near and remainder.interval[0] == 0.0
        return "agrees" if quiet or nothing else "unexplained"
    return "closed" if quiet or near else "reduced"


def _contest(found: Search, verdict: str) -> tuple[tuple[str, float], ...]:
    """Return the contest that ended the search, most probable first."""
    if found.last is None:
        return ((AGREES, 1.0),)
    as_it_is = AGREES if verdict in ("agrees", "closed") else UNKNOWN
    ranked = sorted(found.last.probabilities.items(), key=lambda item: -item[1])
    return tuple(
        (name or as_it_is, p) for name, p in ranked[:_MOST_STATED]
        if p >= _LEAST_STATED or name == ranked[0][0]
    )


def _alternatives(step: Step, effect: str, at: Stage) -> tuple[tuple[str, float], ...]:
    """Return what else it may be, until nearly all of the probability is stated."""
    chances = step.probabilities
    as_it_is = AGREES if at.assessed.quiet else UNKNOWN
    stated: list[tuple[str, float]] = []
    total = chances.get(effect, 0.0)
    for name, p in sorted(chances.items(), key=lambda item: -item[1]):
        if name == effect:
            continue
        if total > _STATED or p < _LEAST_STATED or len(stated) >= _MOST_STATED:
            break
        stated.append((name or as_it_is, p))
        total += p
    return tuple(stated)


def _named(baseline: Baseline, entry: Round, number: int, found: Search) -> NamedEffect:
    before, after = entry.before, entry.after
    spread = spread_of(after.assessed, after.predicting)
    model = after.predicting
    place = next(
        i for i in reversed(range(len(model.terms))) if model.terms[i].fitted.id == entry.effect
    )
    own = [i for i, p in enumerate(model.terms) if p.fitted.id == entry.effect and not p.held]
    place = own[0] if own else place
    term = model.terms[place].fitted
    alternatives = _alternatives(entry.step, entry.effect, before)
    was, now = before.gap, after.gap
    noise = noise_percent(after.seen)
    missing = max(was**2 - noise**2, 1e-300)
    share = 100.0 * min(max((was**2 - now**2) / missing, 0.0), 1.0)
    effect_size = float(np.sqrt(max(was**2 - now**2, 0.0)))
    left = _remainder(baseline, found.final).percent
    unseen = before.unseen_gap, after.unseen_gap
    better = None
    if unseen[0] is not None and unseen[1] is not None:
        better = unseen[1] < unseen[0]
    return NamedEffect(
        effect=entry.effect,
        parameters=dict(term.shape),
        coefficient=term.coefficient,
        interval=_interval(spread, place, term),
        unit=term.unit,
        probability=entry.step.probabilities[entry.effect],
        alternatives=alternatives,
        indistinguishable=tuple(
            e for e, p in alternatives
            if p > _EQUAL * entry.step.probabilities[entry.effect] and e not in (AGREES, UNKNOWN)
        ),
        gap=(was, now),
        alike=(before.alike, after.alike),
        unseen=unseen,
        dropped=entry.dropped,
        share_percent=share,
        shape_adequate=bool(
            found.final.assessed.quiet or left <= _SHAPE_HOLDS * effect_size
        ),
        held_out_better=better,
    )


def _interval(spread: Spread, place: int, term: FittedTerm) -> tuple[float, float]:
    low, high = term.term.coefficient_bounds(term.shape)
    number = Number(place, None)
    if number not in spread.numbers:
        return term.coefficient, term.coefficient
    return spread.interval(spread.numbers.index(number), low, high)


def _mended_terms(baseline: Baseline, at: Stage, spread: Spread) -> tuple[MendedTerm, ...]:
    held = [MendedTerm(t, None) for t in (baseline.terms if baseline.fixed else ())]
    return (
        *held,
        *(
            MendedTerm(
                p.fitted,
                _interval(spread, i, p.fitted) if Number(i, None) in spread.numbers else None,
            )
            for i, p in enumerate(at.predicting.terms)
            if not p.held
        ),
    )


def _mended(campaign: Campaign, baseline: Baseline, found: Search) -> SegmentedModel:
    final = found.final
    if isinstance(baseline.whole, SegmentedModel) and len(baseline.whole.bands) > 1:
        return added_to(baseline.whole, final.terms)
    model = ForceModel(final.models[0].terms, "mended")
    new = [t.id for r in found.rounds for t in final.terms if t.id == r.effect]
    tail = [t.id for t in model.terms[len(model.terms) - len(new) :]]
    return SegmentedModel(
        (Band(None, None, model),), "speed", "paper", campaign.device, "mended",
        (*baseline.added, *(new if tail == new else ())),
    )


def _figures(
    baseline: Baseline, found: Search, rounds: Sequence[NamedEffect]
) -> GapFigureData:
    drawn = tuple(
        curves(was, now)
        for was, now in zip(found.given.accuracies, found.final.accuracies, strict=True)
    )
    shapes = tuple(
        shape_of(baseline.rows, found.rounds[i].after.models, named, i)
        for i, named in enumerate(rounds)
    )
    return GapFigureData(drawn, shapes, surface(baseline.rows, found.given.models))

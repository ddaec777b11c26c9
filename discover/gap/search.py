"""Rounds of the search: name, add, refit, judge; drop what became superfluous; stop."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from discover.gap.accuracy import Misfit, pooled
from discover.gap.baseline import Baseline
from discover.gap.correction import Correction, corrected, with_member
from discover.gap.doubt import Doubt, doubt_of_added, share_of, within_doubt
from discover.gap.mending import impossible, mended, without_superfluous
from discover.gap.reversing import with_curve_of
from discover.gap.stages import Stage, seen_gap, stage
from discover.gap.whole_power import POWER_LAW, as_whole_power
from discover.naming.ahead import every_joint, pairs_ahead
from discover.naming.columns import CandidateColumns
from discover.naming.contest import Contest, leaves_much, reweighed, run_contest
from discover.naming.evidence import AGREES, UNKNOWN
from discover.naming.fit import ModelFit, fit_model, free_parameters, misfits
from discover.naming.forces import has_joint, of_each_test
from discover.naming.refine import dearness, refine
from discover.naming.rows import RecordRows
from models.checks import Array

MOST_ROUNDS = 6
_TOO_LITTLE = 0.02  # of the misfit, that an effect has to explain
_MOVED = 0.05  # of chi-square a row, by which refitting has to help to count as a change
_NOTICED = 0.005  # of the gap, that an effect has to close
_CLEARLY = 0.1  # of the mean square relative gap
_WORSE = 0.02  # of the gap of records that are left out, that an effect may add to it
_MOST_MEMBERS = 4  # that are added to the curves of effects
_BEYOND = 1.5  # times the noise floor, from which a gap is more than noise
_FEWEST = 20.0  # of chi-square, that an effect has to explain
_SEVERAL = 4  # records, of which one that stands out may have more noise than was found
_SURE = 0.99  # that it is no entry's, where nothing will be added
_AGAIN = 8  # effects, that are weighed again where friction's curve is known better
_OF_OTHERS = 60.0  # of chi-square, that an effect has to explain in the others then


@dataclass(frozen=True)
class Round:
    """One round."""

    effect: str
    """What was added."""
    contest: Contest
    """That named it."""
    before: Stage
    """Before it."""
    stage: Stage
    """With its formula."""
    dropped: tuple[str, ...] = ()
    """Effects of earlier rounds that it made superfluous."""
    corrected: Correction | None = None
    """Of the curves of all that was added so far, where formulas do not follow them."""

    @property
    def after(self) -> Stage:
        """The stage that the next round starts from."""
        return self.stage if self.corrected is None else self.corrected.stage


@dataclass(frozen=True)
class Search:
    """The whole search."""

    baseline: Stage
    """Before: the model as it was given, or its terms fitted."""
    refitted: Stage
    """The same terms with their free coefficients fitted; the baseline where there are none."""
    rounds: tuple[Round, ...]
    """In order."""
    last: Contest
    """That ended it."""
    rejected: str | None = None
    """An effect that lowered the misfit in its weights, not the gap in N or of records left out."""

    @property
    def final(self) -> Stage:
        """The last stage."""
        return self.rounds[-1].after if self.rounds else self.refitted


def search(
    baseline: Baseline,
    effects: Sequence[str],
    *,
    most: int = MOST_ROUNDS,
    tell: Callable[[str], None] | None = None,
) -> Search:
    """Return the rounds of naming beside a baseline.

    Parameters
    ----------
    baseline : Baseline
        Where to start.
    effects : sequence of str
        Ids of the catalogue that may be named.
    most : int
        Rounds at most.
    tell : callable, optional
        Is told in words what each round added.
    """
    rows = baseline.rows
    fitted = baseline.fitted_rows
    fixed = fit_model(fitted, baseline.model, ())
    start = stage(rows, fixed)
    fit = fit_model(fitted, baseline.model, free_parameters(baseline.model))
    moved = fixed.chi2 - fit.chi2 > _MOVED * fit.residual.size
    refitted = stage(rows, fit) if moved else start
    first = replace(refitted, fit=fit)
    rounds: list[Round] = []
    tried: set[str] = set()
    given = doubt_of_added(baseline, fit)
    doubt, members, curves = given.by_record, 0, True
    deep, weighed = True, None
    columns = CandidateColumns(fitted)
    while True:
        now = rounds[-1].after if rounds else first
        present = {t.id for t in now.fit.model.terms}
        open_effects = [e for e in effects if e not in present and e not in tried]
        if weighed is None:
            settled = _within(rows, now, rounds, given)
            weighed = _weighed(fitted, now.fit, open_effects, doubt, columns, settled=settled)
        left = _Open(open_effects, rounds, len(rounds) < most, curves, deep, given, columns)
        found = _next(rows, fitted, now, left, *weighed)
        if found.added is not None:
            added = _again(rows, fitted, now, left, found.added, doubt)
            curves, deep, weighed = True, False, None
            gained = misfits(fitted, now.fit) - misfits(fitted, added.stage.fit)
            doubt = doubt + share_of(added.effect) ** 2 * np.maximum(gained, 0.0)
            tried |= set(added.dropped)
            rounds.append(added)
            if tell is not None:
                gap = seen_gap(rows, added.stage)
                tell(f"round {len(rounds)} added {added.effect}, gap {gap:.3g} %")
            continue
        names = [r.effect for r in rounds]
        better = corrected(rows, fitted, now, names, most=_MOST_MEMBERS - members)
        if better is None and found.waits:
            curves = False
            continue
        joints = not has_joint(now.fit.model)
        if better is None and joints and not deep and found.contest.ranked[0][0] == UNKNOWN:
            deep = True
            continue
        if better is None:
            return Search(start, refitted, tuple(rounds), found.contest, found.rejected)
        members += len(better.effects)
        deep, weighed = False, None
        before = rounds[-1].corrected
        if before is not None:
            better = replace(better, effects=(*before.effects, *better.effects))
        rounds[-1] = replace(rounds[-1], corrected=better)


@dataclass(frozen=True)
class _Open:
    """What a round may still do."""

    effects: Sequence[str]
    rounds: Sequence[Round]
    more: bool
    curves: bool
    """Whether the curves of what was added may explain more than a further effect."""
    deep: bool
    """Whether joints and pairs are searched before what is left is called unknown."""
    given: Doubt
    """Of effects that the model had been given by an earlier search."""
    columns: CandidateColumns
    """Of the records that are fitted."""


@dataclass(frozen=True)
class _Next:
    """A round, or what ended the search."""

    contest: Contest
    added: Round | None = None
    rejected: str | None = None
    waits: bool = False
    """An effect was named that the curves of what was added may explain better."""


def _next(
    rows: Sequence[RecordRows],
    fitted: Sequence[RecordRows],
    now: Stage,
    left: _Open,
    contest: Contest,
    fits: dict[str, ModelFit],
) -> _Next:
    """Return the next round: the contest, and the effect that it names, added."""
    doubtful = bool(left.rounds) or left.given.square > 0.0
    little = _within(rows, now, left.rounds, left.given)
    if contest.ranked[0][0] != AGREES and not _beyond(rows, now):
        little = little or _one_stands_out(fitted, now, contest, fits)
    if left.deep and not little:
        contest, fits = _deeper(fitted, now.fit, left, contest, fits)
    name = contest.ranked[0][0]
    if name == AGREES or (name == UNKNOWN and doubtful) or not left.more:
        return _Next(contest)
    if little:
        return _Next(contest.in_doubt(name))
    if name == UNKNOWN:
        return _Next(contest)
    tried = _tried(rows, fitted, now, left, contest, fits.get(name), name)
    other = contest.partner(name)
    if tried.rejected is not None and other is not None:
        # Of two that are missing the first alone may only trade one record's gap for another's.
        paired = contest.without_alone(name, other)
        if paired.ranked[0][0] == other:
            second = _tried(rows, fitted, now, left, paired, None, other)
            tried = tried if second.added is None else second
    return tried


def _within(
    rows: Sequence[RecordRows], now: Stage, rounds: Sequence[Round], given: Doubt
) -> bool:
    """Tell whether no more is left than the shapes of what was added may be wrong by."""
    done = [(r.effect, r.before, r.after) for r in rounds]
    return bool(done or given.square > 0.0) and within_doubt(rows, now, given, done)


def _again(
    rows: Sequence[RecordRows],
    fitted: Sequence[RecordRows],
    now: Stage,
    left: _Open,
    added: Round,
    doubt: Array,
) -> Round:
    """Return the round as named beside friction's curve, where only with the effect it showed.

    Beside another curve the effect's nearest relatives make up for the difference.
    """
    if has_joint(added.stage.fit.model):
        return added
    curved = with_curve_of(fitted, now.fit, added.stage.fit)
    if curved is None:
        return added
    ranked = dict.fromkeys(e.effects[0] for e in added.contest.entries if e.effects)
    likely = set(list(ranked)[:_AGAIN])
    effects = [e for e in left.effects if e in likely]
    contest, fits = _weighed(fitted, curved, effects, doubt, left.columns)
    chances = {**dict.fromkeys(left.effects, 0.0), **contest.probabilities}
    contest = replace(contest, probabilities=chances)
    again = _next(rows, fitted, replace(now, fit=curved), left, contest, fits)
    if again.added is None or dearness(again.added.stage.fit) > dearness(added.stage.fit):
        return added
    return replace(again.added, before=now)


def _tried(
    rows: Sequence[RecordRows],
    fitted: Sequence[RecordRows],
    now: Stage,
    left: _Open,
    contest: Contest,
    begun: ModelFit | None,
    name: str,
) -> _Next:
    """Return the round that adds an effect, or what speaks against it."""
    fit = mended(fitted, now.fit, contest, name, begun)
    gained = now.fit.chi2 - fit.chi2
    if gained < max(_TOO_LITTLE * contest.excess, _FEWEST) or impossible(fit.model, name):
        return _Next(contest.without(name, None if _beyond(rows, now) else AGREES))
    if name == POWER_LAW and (it := as_whole_power(fitted, now.fit, contest, fit, left.effects)):
        return _tried(rows, fitted, now, left, it.contest, it.fit, it.name)
    same = with_member(fitted, now.fit, [r.effect for r in left.rounds]) if left.curves else None
    if same is not None and same[1].chi2 < fit.chi2:
        return _Next(contest.without(name), waits=True)
    earlier = [r.effect for r in left.rounds if r.effect in {t.id for t in fit.model.terms}]
    fit, dropped = without_superfluous(fitted, fit, earlier)
    after = stage(rows, fit)
    judged = left.rounds and not of_each_test(fit.model, name)
    helps = _helps(rows, now, after) or _shows(rows, fitted, now, after)
    if not helps or (judged and not _predicts(rows, now, after)):
        refused = contest.without(name) if _beyond(rows, now) else contest.in_doubt(name)
        return _Next(refused, rejected=name)
    return _Next(contest, Round(name, contest, now, after, dropped))


def _helps(rows: Sequence[RecordRows], before: Stage, after: Stage) -> bool:
    """Tell whether the gap falls: pooled in N, or clearly with every record counting alike.

    Where more than one effect is missing, the first may close the quiet records' gaps at the cost
    of the loud ones'.
    """
    if seen_gap(rows, after) <= (1.0 - _NOTICED) * seen_gap(rows, before):
        return True
    seen = [i for i, r in enumerate(rows) if not r.observation.held_out]
    was, now = (_by_record([at.misfits[i] for i in seen]) for at in (before, after))
    return now < (1.0 - _CLEARLY) * was


def _predicts(rows: Sequence[RecordRows], before: Stage, after: Stage) -> bool:
    """Tell whether records that are left out in turn are not predicted worse; those held out judge.

    What a further effect explains of the records that it is fitted to may be their own.
    """
    if any(r.observation.held_out for r in rows) or not before.unseen:
        return True
    if pooled(after.unseen) <= (1.0 + _WORSE) * pooled(before.unseen):
        return True
    # One record alone may show an earlier effect: left out, only chance predicts it.
    was, now = (np.log([max(m.percent, 1e-9) for m in at.unseen]) for at in (before, after))
    return bool(np.mean(now - was) < np.log1p(-_CLEARLY))


def _by_record(misfits: Sequence[Misfit]) -> float:
    """Return the sum of mean square relative gaps: every record counts alike."""
    return sum(m.error / max(m.force, 1e-300) for m in misfits)


def _shows(
    rows: Sequence[RecordRows], fitted: Sequence[RecordRows], before: Stage, after: Stage
) -> bool:
    """Tell whether records agree that an effect is there, however little of the gap it makes."""
    gained = misfits(fitted, before.fit) - misfits(fitted, after.fit)
    risen = seen_gap(rows, after) > (1.0 + _NOTICED) * seen_gap(rows, before)
    return _by_several(gained) and not risen


def _by_several(gained: Array) -> bool:
    """Tell whether chi-square that records gain is no single record's."""
    return gained.size >= _SEVERAL and float(gained.sum() - gained.max()) >= _OF_OTHERS


def _beyond(rows: Sequence[RecordRows], at: Stage) -> bool:
    """Tell whether some record's gap is more than noise."""
    return any(
        m.percent > _BEYOND * m.noise_percent
        for r, m in zip(rows, at.misfits, strict=True)
        if not r.observation.held_out
    )


def _one_stands_out(
    fitted: Sequence[RecordRows], at: Stage, contest: Contest, fits: Mapping[str, ModelFit]
) -> bool:
    """Tell whether one record has all misfit beyond the noise, which no name has in others too."""
    if len(fitted) < _SEVERAL:
        return False
    before = misfits(fitted, at.fit)
    beyond = before - np.array([r.target.size for r in fitted])
    if contest.excess >= float(beyond.max()):
        return False
    named = fits.get(contest.ranked[0][0])
    if named is None:
        return True
    return not _by_several(before - misfits(fitted, named))


def _weighed(
    rows: Sequence[RecordRows],
    fit: ModelFit,
    effects: Sequence[str],
    doubt: Array,
    columns: CandidateColumns,
    *,
    settled: bool = False,
) -> tuple[Contest, dict[str, ModelFit]]:
    """Return the contest beside a fit, and the fits of those that lead.

    `doubt` is what of each record's chi-square the shapes of what was added may be wrong by.
    `settled`: nothing will be added, so what hardly anything explains is not looked at closer.
    """
    beyond = misfits(rows, fit) - np.array([r.target.size for r in rows])
    tolerated = float(np.sum(np.minimum(doubt, np.maximum(beyond, 0.0))))
    contest = run_contest(rows, fit, effects, tolerated=tolerated, columns=columns)
    if settled and contest.probabilities[UNKNOWN] > _SURE:
        return contest, {}
    return refine(rows, fit, contest, effects)


def _deeper(
    rows: Sequence[RecordRows],
    fit: ModelFit,
    left: _Open,
    contest: Contest,
    fits: dict[str, ModelFit],
) -> tuple[Contest, dict[str, ModelFit]]:
    """Return the contest with joints from many starts where nothing is named, and with pairs."""
    if any(r.cycle_rows is None for r in rows):
        return contest, fits  # a long record takes minutes
    if contest.ranked[0][0] == UNKNOWN and not has_joint(fit.model):
        fits = every_joint(rows, fit, contest, fits)
        contest = reweighed(rows, contest, fit, fits, left.effects)
    name = contest.ranked[0][0]
    if not left.rounds and (name == UNKNOWN or leaves_much(rows, contest, name)):
        found = pairs_ahead(rows, contest, fits, left.effects, left.columns)
        contest = replace(contest, entries=(*contest.entries, *found))
        contest = reweighed(rows, contest, fit, fits, left.effects)
    return contest, fits

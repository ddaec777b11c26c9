"""One round of the search: name, add, refit, judge."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from discover.gap.correction import Correction, with_member
from discover.gap.doubt import Doubt, share_of, within_doubt
from discover.gap.judging import beyond, helps, one_stands_out, predicts, shows
from discover.gap.mending import impossible, mended, without_superfluous
from discover.gap.reversing import noise_alone, with_curve_of
from discover.gap.stages import Stage, seen_gap, stage, without
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

_TOO_LITTLE = 0.02  # of the misfit, that an effect has to explain
_FEWEST = 20.0  # of chi-square, that an effect has to explain
_SURE = 0.99  # that it is no entry's, where nothing will be added
_NO_WORSE = 1.02  # times the gap, that another name may leave
_AGAIN = 8  # effects, that are weighed again where friction's curve is known better


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
    instead_of: str = ""
    """One of these, for whose force it is a better name."""
    beside: ModelFit | None = None
    """The model without either then."""
    corrected: Correction | None = None
    """Of the curves of all that was added so far, where formulas do not follow them."""

    @property
    def after(self) -> Stage:
        """The stage that the next round starts from."""
        return self.stage if self.corrected is None else self.corrected.stage

    @property
    def members(self) -> tuple[str, ...]:
        """Whose curves were corrected after it."""
        return () if self.corrected is None else self.corrected.effects


@dataclass(frozen=True)
class Open:
    """What a round may still do."""

    effects: Sequence[str]
    """Ids that may be named."""
    rounds: Sequence[Round]
    """That were made."""
    more: bool
    """Whether there may be another one."""
    curves: bool
    """Whether the curves of what was added may explain more than a further effect."""
    deep: bool
    """Whether joints and pairs are searched before what is left is called unknown."""
    given: Doubt
    """Of effects that the model had been given by an earlier search."""
    columns: CandidateColumns
    """Of the records that are fitted."""


@dataclass(frozen=True)
class Next:
    """A round, or what ended the search."""

    contest: Contest
    added: Round | None = None
    rejected: str | None = None
    waits: bool = False
    """An effect was named that the curves of what was added may explain better."""
    nothing_alone: bool = False
    """An effect was named that explains little without another one, or is impossible then."""


def next_round(
    rows: Sequence[RecordRows],
    fitted: Sequence[RecordRows],
    now: Stage,
    left: Open,
    contest: Contest,
    fits: dict[str, ModelFit],
) -> Next:
    """Return the next round: the contest, and the effect that it names, added."""
    doubtful = bool(left.rounds) or left.given.square > 0.0
    little = within(rows, now, left.rounds, left.given)
    if contest.ranked[0][0] != AGREES and not beyond(rows, now):
        little = little or one_stands_out(fitted, now, contest, fits)
    if left.deep and not little:
        contest, fits = _deeper(fitted, now.fit, left, contest, fits)
    name = contest.ranked[0][0]
    if name == AGREES or (name == UNKNOWN and doubtful) or not left.more:
        return Next(contest)
    if little:
        return Next(contest.in_doubt(name))
    if name == UNKNOWN:
        return Next(contest)
    tried = _tried(rows, fitted, now, left, contest, fits.get(name), name)
    other = contest.partner(name)
    if (tried.rejected is not None or tried.nothing_alone) and other is not None:
        # Of two that are missing the first alone may only trade one record's gap for another's,
        # or make up for the other.
        paired = contest.without_alone(name, other)
        if paired.ranked[0][0] == other:
            second = _tried(rows, fitted, now, left, paired, None, other)
            tried = tried if second.added is None else second
    return tried


def within(
    rows: Sequence[RecordRows], now: Stage, rounds: Sequence[Round], given: Doubt
) -> bool:
    """Tell whether no more is left than the shapes of what was added may be wrong by."""
    names = {r.instead_of: r.effect for r in rounds if r.instead_of}
    done = [
        (names.get(r.effect, r.effect), r.before, r.after) for r in rounds if not r.instead_of
    ]
    return bool(done or given.square > 0.0) and within_doubt(rows, now, given, done)


def named_again(
    rows: Sequence[RecordRows],
    fitted: Sequence[RecordRows],
    now: Stage,
    left: Open,
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
    contest, fits = weighed(fitted, curved, effects, doubt, left.columns)
    chances = {**dict.fromkeys(left.effects, 0.0), **contest.probabilities}
    contest = replace(contest, probabilities=chances)
    again = next_round(rows, fitted, replace(now, fit=curved), left, contest, fits)
    if again.added is None or dearness(again.added.stage.fit) > dearness(added.stage.fit):
        return added
    return replace(again.added, before=now)


def exchanged(
    rows: Sequence[RecordRows],
    fitted: Sequence[RecordRows],
    now: Stage,
    left: Open,
    doubt: Array,
    doubts: Mapping[str, Array],
) -> Round | None:
    """Return a round that names a force of an earlier round anew, beside what was found since.

    A name that was given while more was missing may have made up for that. None where all names
    stay, where no round is left, or behind a joint, where weighing takes long. The last round's
    name was given beside all the others.
    """
    if not left.more or has_joint(now.fit.model):
        return None
    adding = {t.id for t in now.fit.model.terms if t.term.acts == "force"}
    for done in [r for r in left.rounds[:-1] if r.effect in adding]:
        name = done.effect
        less = without(now.fit.model, name)
        fit = fit_model(fitted, less, free_parameters(less))
        also = replace(left, effects=[*left.effects, name], curves=False)
        others = doubt - doubts.get(name, 0.0)
        contest, fits = weighed(fitted, fit, also.effects, others, left.columns)
        first = contest.ranked[0][0]
        if first in (AGREES, UNKNOWN) or (first == name != POWER_LAW):
            continue
        bare = stage(rows, fit)
        found = _tried(rows, fitted, bare, also, contest, fits.get(first), first).added
        if found is None or found.effect == name or not _as_good(rows, now, found.stage, done):
            continue
        dropped = (name, *found.dropped)
        return replace(found, before=now, dropped=dropped, instead_of=name, beside=fit)
    return None


def _as_good(rows: Sequence[RecordRows], now: Stage, other: Stage, done: Round) -> bool:
    """Tell whether a stage without a round's effect leaves no more than that may be wrong by."""
    explained = done.before.fit.chi2 - done.stage.fit.chi2
    less = other.fit.chi2 - now.fit.chi2
    if less > share_of(done.effect) ** 2 * explained and not noise_alone(other.fit):
        return False
    closed = seen_gap(rows, other) <= _NO_WORSE * seen_gap(rows, now)
    return closed and predicts(rows, now, other)


def _tried(
    rows: Sequence[RecordRows],
    fitted: Sequence[RecordRows],
    now: Stage,
    left: Open,
    contest: Contest,
    begun: ModelFit | None,
    name: str,
) -> Next:
    """Return the round that adds an effect, or what speaks against it."""
    fit = mended(fitted, now.fit, contest, name, begun)
    gained = now.fit.chi2 - fit.chi2
    if gained < max(_TOO_LITTLE * contest.excess, _FEWEST) or impossible(fit.model, name):
        more = beyond(rows, now)
        return Next(contest.without(name, None if more else AGREES), nothing_alone=more)
    if name == POWER_LAW and (it := as_whole_power(fitted, now.fit, contest, fit, left.effects)):
        return _tried(rows, fitted, now, left, it.contest, it.fit, it.name)
    same = with_member(fitted, now.fit, [r.effect for r in left.rounds]) if left.curves else None
    if same is not None and same[1].chi2 < fit.chi2:
        return Next(contest.without(name), waits=True)
    earlier = [r.effect for r in left.rounds if r.effect in {t.id for t in fit.model.terms}]
    fit, dropped = without_superfluous(fitted, fit, earlier)
    after = stage(rows, fit)
    judged = left.rounds and not of_each_test(fit.model, name)
    closer = helps(rows, now, after) or shows(rows, fitted, now, after)
    if not closer or (judged and not predicts(rows, now, after)):
        refused = contest.without(name) if beyond(rows, now) else contest.in_doubt(name)
        return Next(refused, rejected=name)
    return Next(contest, Round(name, contest, now, after, dropped))


def weighed(
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
    above = misfits(rows, fit) - np.array([r.target.size for r in rows])
    tolerated = float(np.sum(np.minimum(doubt, np.maximum(above, 0.0))))
    contest = run_contest(rows, fit, effects, tolerated=tolerated, columns=columns)
    if settled and contest.probabilities[UNKNOWN] > _SURE:
        return contest, {}
    return refine(rows, fit, contest, effects)


def _deeper(
    rows: Sequence[RecordRows],
    fit: ModelFit,
    left: Open,
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

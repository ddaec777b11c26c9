"""Rounds of the search: name, add, refit, judge; drop what became superfluous; stop."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from discover.gap.accuracy import Misfit, misfit, pooled
from discover.gap.baseline import Baseline
from discover.naming.contest import AGREES, UNKNOWN, Contest, run_contest
from discover.naming.fit import (
    ModelFit,
    UnitRows,
    fit_model,
    free_parameters,
    whole_model,
)
from discover.naming.forces import model_force
from discover.naming.refine import extended, refine
from discover.naming.rows import RecordRows
from models.constitutive import ForceModel
from models.terms import TERMS

MOST_ROUNDS = 6
_SUPERFLUOUS = 6.0  # nats that an earlier effect has to be worth
_TOO_LITTLE = 0.02  # of the misfit, that an effect has to explain
_SHAPE_DOUBT = 0.045  # of an effect's amplitude: no formula follows a measured shape closer
_JOINT_DOUBT = 0.1  # likewise of what moves the device otherwise: contact and loss are simplified
# Of one form only: they leave no doubt of shape.
_EXACT = ("inertia", "viscous-damping", "stiffness", "force-offset", "time-delay")
_MOVED = 0.05  # of chi-square a row, by which refitting has to help to count as a change
_CLEARLY = 0.1  # of the mean square relative gap
_BEYOND = 1.5  # times the noise floor, from which a gap is more than noise
_FOLDS = 16
_LEFT_OUT_STEPS = 3
_LEFT_OUT_ENOUGH = 0.01
_FEWEST = 20.0  # of chi-square, likewise


@dataclass(frozen=True)
class Stage:
    """A model on all records: before the first round, or after one."""

    fit: ModelFit
    """On the fitted records."""
    misfits: tuple[Misfit, ...]
    """Of every record, by the fitted model."""
    unseen: tuple[Misfit, ...]
    """Of the records that were not fitted: the held-out ones, or each left out in turn."""


@dataclass(frozen=True)
class Round:
    """One round."""

    effect: str
    """What was added."""
    first: int
    """Index of its first term in the model."""
    contest: Contest
    """That named it."""
    stage: Stage
    """After it."""
    dropped: tuple[str, ...] = ()
    """Effects of earlier rounds that it made superfluous."""


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
    """An effect that would have lowered the misfit in its weights, but not the gap in N."""

    @property
    def final(self) -> Stage:
        """The last stage."""
        return self.rounds[-1].stage if self.rounds else self.refitted


def stage(rows: Sequence[RecordRows], fit: ModelFit) -> Stage:
    """Return what a fitted model makes of every record."""
    found = tuple(_misfit(r, fit.model) for r in rows)
    held = tuple(m for r, m in zip(rows, found, strict=True) if r.observation.held_out)
    return Stage(fit, found, held or _left_out(rows, fit))


def _misfit(rows: RecordRows, model: ForceModel) -> Misfit:
    return misfit(rows.observation, model_force(rows.observation, whole_model(rows, model)))


def _left_out(rows: Sequence[RecordRows], fit: ModelFit) -> tuple[Misfit, ...]:
    """Return each record's misfit by the model fitted to the others.

    Of more than sixteen records several are left out at once.
    """
    if len(rows) < 2:
        return ()
    if not fit.parameters:
        return tuple(_misfit(r, fit.model) for r in rows)
    units = UnitRows()
    found: dict[int, Misfit] = {}
    folds = min(len(rows), _FOLDS)
    for fold in range(folds):
        rest = [r for i, r in enumerate(rows) if i % folds != fold]
        refit = fit_model(
            rest, fit.model, fit.parameters, iterations=_LEFT_OUT_STEPS, enough=_LEFT_OUT_ENOUGH,
            units=units, exact=False,
        )
        for i in range(fold, len(rows), folds):
            found[i] = _misfit(rows[i], refit.model)
    return tuple(found[i] for i in range(len(rows)))


def search(baseline: Baseline, effects: Sequence[str], *, most: int = MOST_ROUNDS) -> Search:
    """Return the rounds of naming beside a baseline.

    Parameters
    ----------
    baseline : Baseline
        Where to start.
    effects : sequence of str
        Ids of the catalogue that may be named.
    most : int
        Rounds at most.
    """
    rows = baseline.rows
    fitted = [r for r in rows if not r.observation.held_out]
    fixed = fit_model(fitted, baseline.model, ())
    start = stage(rows, fixed)
    fit = fit_model(fitted, baseline.model, free_parameters(baseline.model))
    moved = fixed.chi2 - fit.chi2 > _MOVED * fit.residual.size
    refitted = stage(rows, fit) if moved else start
    now = refitted
    names: list[tuple[str, int]] = []
    rounds: list[Round] = []
    tried: set[str] = set()
    doubt = 0.0
    while True:
        present = {t.id for t in fit.model.terms}
        open_effects = [e for e in effects if e not in present and e not in tried]
        contest, fits = _contest(fitted, fit, open_effects, doubt)
        name = contest.ranked[0][0]
        ended = name in (AGREES, UNKNOWN) or len(rounds) >= most
        if ended or _within_doubt(rows, rounds, refitted):
            return Search(start, refitted, tuple(rounds), contest)
        mended = _mended(fitted, fit, contest, name, fits.get(name))
        gained = fit.chi2 - mended.chi2
        if gained < max(_TOO_LITTLE * contest.excess, _FEWEST):
            return Search(start, refitted, tuple(rounds), _refused(rows, now, contest, name))
        doubt += _doubt(name) ** 2 * gained
        first = len(fit.model.terms)
        mended, dropped, names = _without_superfluous(fitted, mended, names)
        first -= len(dropped)
        tried |= set(dropped)
        names.append((name, first))
        fit = mended
        after = stage(rows, fit)
        if not _helps(rows, now, after):
            contest = _refused(rows, now, contest, name)
            return Search(start, refitted, tuple(rounds), contest, name)
        now = after
        rounds.append(Round(name, first, contest, after, dropped))


def _within_doubt(
    rows: Sequence[RecordRows], rounds: Sequence[Round], before: Stage
) -> bool:
    """Tell whether what is left is no more than the shapes of what was added may be wrong by."""
    if not rounds:
        return False
    now = rounds[-1].stage
    seen = [m for r, m in zip(rows, now.misfits, strict=True) if not r.observation.held_out]
    left = _pooled(rows, now) ** 2 - pooled(seen, noise=True) ** 2
    stages = [before, *(r.stage for r in rounds)]
    tolerated = sum(
        _doubt(r.effect) ** 2 * (_pooled(rows, was) ** 2 - _pooled(rows, r.stage) ** 2)
        for was, r in zip(stages, rounds, strict=False)
    )
    return left < tolerated


def _doubt(name: str) -> float:
    """Return the share of an effect's amplitude by which its shape may be wrong."""
    if name in _EXACT:
        return 0.0
    joint = TERMS[name].acts == "input" or name == "cavitation"
    return _JOINT_DOUBT if joint else _SHAPE_DOUBT


def _helps(rows: Sequence[RecordRows], before: Stage, after: Stage) -> bool:
    """Tell whether the gap falls: pooled in N, or clearly with every record counting alike.

    Where more than one effect is missing, the first may close the quiet records' gaps at the cost
    of the loud ones'.
    """
    if _pooled(rows, after) <= _pooled(rows, before):
        return True
    was, now = (
        sum(
            m.error / max(m.force, 1e-300)
            for r, m in zip(rows, at.misfits, strict=True)
            if not r.observation.held_out
        )
        for at in (before, after)
    )
    return now < (1.0 - _CLEARLY) * was


def _refused(rows: Sequence[RecordRows], at: Stage, contest: Contest, name: str) -> Contest:
    """Return the contest without an effect that leaves a gap beyond the noise as it is.

    Where no record's gap is more than noise, it can't tell whether the effect helps.
    """
    beyond = any(
        m.percent > _BEYOND * m.noise_percent
        for r, m in zip(rows, at.misfits, strict=True)
        if not r.observation.held_out
    )
    return contest.without(name) if beyond else contest


def _pooled(rows: Sequence[RecordRows], at: Stage) -> float:
    """Return the gap of the fitted records, %."""
    found = zip(rows, at.misfits, strict=True)
    return pooled([m for r, m in found if not r.observation.held_out])


def _contest(
    rows: Sequence[RecordRows], fit: ModelFit, effects: Sequence[str], tolerated: float
) -> tuple[Contest, dict[str, ModelFit]]:
    reversal = next(
        (
            t.shape["transition_speed"]
            for t in (*fit.model.terms, *(t for r in rows for t in r.held))
            if t.id == "coulomb-friction"
        ),
        0.0,
    )
    contest = run_contest(rows, fit, effects, reversal=reversal, tolerated=tolerated)
    return refine(rows, fit, contest, effects)


def _mended(
    rows: Sequence[RecordRows],
    fit: ModelFit,
    contest: Contest,
    name: str,
    begun: ModelFit | None,
) -> ModelFit:
    """Return the fit with an effect added, from where the contest's own refinement stopped."""
    entry = next(e for e in contest.entries if e.effects and e.effects[0] == name)
    model = extended(fit.model, entry) if begun is None else begun.model
    return fit_model(rows, model, free_parameters(model))


def _without_superfluous(
    rows: Sequence[RecordRows], fit: ModelFit, names: list[tuple[str, int]]
) -> tuple[ModelFit, tuple[str, ...], list[tuple[str, int]]]:
    """Return the fit without earlier effects that the newest made worth next to nothing."""
    dropped: list[str] = []
    kept = list(names)
    for name, first in names[::-1]:
        terms = [t for i, t in enumerate(fit.model.terms) if i != first]
        less = ForceModel(tuple(terms), fit.model.name)
        trial = fit_model(rows, less, free_parameters(less), iterations=4)
        if trial.chi2 - fit.chi2 < 2.0 * _SUPERFLUOUS:
            fit = trial
            dropped.append(name)
            kept = [(n, f - (f > first)) for n, f in kept if n != name]
    return fit, tuple(dropped), kept

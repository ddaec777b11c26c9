"""The search round by round: until the noise, or nothing that makes the records more probable."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from discover.gap.baseline import Baseline, in_few_curves
from discover.posterior.assess import Assessed
from discover.posterior.grow import chosen_again, grown
from discover.posterior.left_out import is_less, is_needed, left_out
from discover.posterior.model import Composite
from discover.posterior.step import Candidate, Step, ordered
from discover.rows import Accuracy, accuracy, alike_percent, pooled_percent
from models.checks import Array
from models.constitutive import FittedTerm, ForceModel

MOST_ROUNDS = 6  # effects that one search names
_POSSIBLE = 0.01  # probability, from which a mended model is made of a candidate


@dataclass(frozen=True)
class Stage:
    """A model on all records: before the first round, or after one."""

    assessed: Assessed
    """Fitted; friction by the whole of its curve."""
    predicting: Composite
    """The same at the numbers that predict best."""
    models: tuple[ForceModel, ...]
    """The model in each record; friction by few curves."""
    accuracies: tuple[Accuracy, ...]
    """Of each record."""
    unseen: tuple[Accuracy, ...]
    """Of those that were not fitted: the held-out ones, or each left out in turn."""
    errors: Array
    """(N,) mean square of what is left of each record over that of its force: of those that are
    fitted by the others alone, of those held out as they are; of parts where one alone is fitted.
    """

    @property
    def seen(self) -> list[Accuracy]:
        """Of those that were fitted."""
        return [a for a in self.accuracies if not a.observation.held_out]

    @property
    def gap(self) -> float:
        """Percent, pooled over the fitted records."""
        return pooled_percent(self.seen)

    @property
    def alike(self) -> float:
        """Percent, over the fitted records with every record counting alike."""
        return alike_percent(self.seen)

    @property
    def unseen_gap(self) -> float | None:
        """Percent, pooled over those that were not fitted; None where there are none."""
        return pooled_percent(self.unseen) if self.unseen else None

    @property
    def terms(self) -> tuple[FittedTerm, ...]:
        """All terms that are not held."""
        return tuple(p.fitted for p in self.predicting.terms if not p.held)


@dataclass(frozen=True)
class Round:
    """One round."""

    effect: str
    """What was added."""
    step: Step
    """What else might have been."""
    before: Stage
    """Before it."""
    after: Stage
    """With it."""
    dropped: tuple[str, ...] = ()
    """Effects of earlier rounds that it made superfluous."""


@dataclass(frozen=True)
class Search:
    """The whole search."""

    given: Stage
    """The model as it was given, or its terms fitted."""
    refitted: Stage
    """The same terms with their free coefficients fitted."""
    rounds: tuple[Round, ...]
    """In order."""
    last: Step | None
    """What might have been added and was not; None where only noise was left."""
    rejected: str | None = None
    """An effect that is more probable but leaves no less, or predicts what was not fitted worse."""

    @property
    def final(self) -> Stage:
        """The last stage; with nothing added the model as given, where a fit leaves more."""
        if self.rounds:
            return self.rounds[-1].after
        given, refitted = self.given, self.refitted
        worse = given.gap < refitted.gap and given.alike < refitted.alike
        return given if worse else refitted


def stage(baseline: Baseline, assessed: Assessed) -> Stage:
    """Return what an assessed model makes of every record."""
    best = assessed if baseline.fixed else assessed.predicting
    model, own = best.model, tuple(p.fitted for p in best.model.terms if not p.held)
    if not baseline.fixed:
        model, own = in_few_curves(baseline.assessor, assessed, best)
    models = baseline.with_terms(own)
    accuracies = tuple(
        accuracy(r.observation, m) for r, m in zip(baseline.rows, models, strict=True)
    )
    held = tuple(a for a in accuracies if a.observation.held_out)
    seen = [a for a in accuracies if not a.observation.held_out]
    with_others, by_others = left_out(best)
    left = _by_others(seen, np.maximum(by_others - with_others, 0.0))
    errors = np.concatenate([_shares(left) if left else by_others, _shares(held)])
    return Stage(assessed, model, tuple(models), accuracies, held or left, errors)


def _by_others(accuracies: Sequence[Accuracy], growth: Array) -> tuple[Accuracy, ...]:
    """Return each record's accuracy by the model fitted to the others; none of one record alone."""
    if len(accuracies) < 2:
        return ()
    return tuple(
        replace(a, error_power=a.error_power + float(g) * a.force_power)
        for a, g in zip(accuracies, growth, strict=True)
    )


def _shares(accuracies: Sequence[Accuracy]) -> Array:
    return np.array([a.error_power / max(a.force_power, 1e-300) for a in accuracies])


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
    assessor = baseline.assessor
    start = assessor.space.start
    given = _given(baseline)
    now = assessor.assess(baseline.composite, start)
    refitted = stage(baseline, now)
    rounds: list[Round] = []
    last: Step | None = None
    rejected = None
    here = refitted
    while len(rounds) < most:
        there = {p.fitted.id for p in here.assessed.model.terms if not p.held}
        open_ids = [e for e in effects if e not in there]
        mended = Mended(baseline, here, given if not rounds else here)
        last, refused = _accepted(mended, grown(assessor, here.assessed, open_ids))
        rejected = refused[0] if refused else None
        added = last.best
        if not added.id or added.assessed is None:
            break
        after, dropped = _settled(mended, rounds, added)
        effect = added.id
        rounds.append(Round(effect, last, here, after, dropped))
        here = after
        if tell is not None:
            tell(f"round {len(rounds)} added {effect}, gap {after.gap:.3g} %")
    return Search(given, refitted, tuple(rounds), last, rejected)


def _given(baseline: Baseline) -> Stage:
    """Return the stage of the model as it was given."""
    assessor = baseline.assessor
    assessed = assessor.assess(baseline.composite, assessor.space.start, refit=False)
    models = baseline.given()
    accuracies = tuple(
        accuracy(r.observation, m) for r, m in zip(baseline.rows, models, strict=True)
    )
    held = tuple(a for a in accuracies if a.observation.held_out)
    return Stage(
        assessed, assessed.model, tuple(models), accuracies, held or accuracies, _shares(accuracies)
    )


@dataclass
class Mended:
    """What may be added in a round, as the stages that it leads to; each is made once."""

    baseline: Baseline
    """Where the search starts."""
    here: Stage
    """Before the round."""
    given: Stage
    """Before it, with coefficients that no fit has changed."""
    _stages: dict[str, Stage] = field(default_factory=dict)

    def by(self, candidate: Candidate) -> Stage:
        """Return the stage with a candidate that is fitted."""
        if not candidate.id or candidate.assessed is None:
            return self.here
        if candidate.id not in self._stages:
            self._stages[candidate.id] = stage(self.baseline, candidate.assessed)
        return self._stages[candidate.id]

    def compared(self, step: Step) -> Step:
        """Return a step that leaves more than noise, weighed by what the mended models predict.

        What did not predict before is out of the question.
        """
        known = step.probabilities
        possible = {
            c.id for c in step.candidates
            if not c.id or known[c.id] >= _POSSIBLE or (c.left is not None and c.left.size == 1)
        }
        return ordered(replace(step, candidates=tuple(
            c if c.left is None
            else replace(c, left=self.by(c).errors) if c.id in possible
            else replace(c, left=None)
            for c in step.candidates
        )))


def _accepted(mended: Mended, grown_step: Step) -> tuple[Step, tuple[str, ...]]:
    """Return a step without what is more probable but leaves no less than was left before.

    Nor may it predict what is not fitted worse.
    """
    step = mended.compared(grown_step)
    refused: list[str] = []
    while step.best.id and step.best.assessed is not None:
        candidate, after = step.best, mended.by(step.best)
        better = candidate.left is None or is_less(after.errors, mended.here.errors)
        less = _leaves_less(after, mended.here) and _leaves_less(after, mended.given)
        if better and less and not _is_worse(mended.here, after):
            break
        refused.append(candidate.id)
        step = step.without([candidate.id])
    return step, tuple(refused)


def _settled(
    mended: Mended, rounds: Sequence[Round], added: Candidate
) -> tuple[Stage, tuple[str, ...]]:
    """Return the stage with a candidate, effects of earlier rounds chosen again beside it.

    What it replaces is dropped, where it predicts what is not fitted no worse than that did. What
    it does not, may serve better in another shape.
    """
    assessor = mended.baseline.assessor
    there, dropped = mended.by(added), list[str]()
    priors = {r.effect: r.step.best.log_prior for r in rounds if r.effect != added.id}
    for name in priors:
        assessed = there.assessed
        places = [i for i, p in enumerate(assessed.model.terms) if p.fitted.id == name]
        if not places:
            continue
        less = assessed.model
        for place in reversed(places):
            less = less.without(place)
        without = assessor.assess(less, assessed.place)
        if is_needed(without, assessed):
            own = [assessed.model.terms[i].fitted for i in places]
            again = chosen_again(assessor, assessed, without, own, priors[name])
            if again.id and again.assessed is not None:
                after = stage(mended.baseline, again.assessed)
                there = there if _is_worse(there, after) else after
            continue
        after = stage(mended.baseline, without)
        if not _is_worse(mended.here, after):
            there = after
            dropped.append(name)
    return there, tuple(dropped)


def _leaves_less(now: Stage, was: Stage) -> bool:
    """Tell whether less is left, pooled or with every record counting alike."""
    return now.gap < was.gap or now.alike < was.alike


def _is_worse(was: Stage, now: Stage) -> bool:
    """Tell whether what is not fitted is predicted worse; False where nothing is left out."""
    before, after = was.unseen_gap, now.unseen_gap
    return before is not None and after is not None and after >= before


def mean_square(accuracies: Sequence[Accuracy]) -> float:
    """Return the error's energy of records over their samples, N^2."""
    total = sum(a.samples * a.error_power for a in accuracies)
    return float(total / max(sum(a.samples for a in accuracies), 1))



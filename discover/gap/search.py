"""The search round by round: until the noise floor, nothing significant, or nothing nameable."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from discover.gap.baseline import Baseline
from discover.gap.correction import corrected, reversal_corrected
from discover.gap.doubt import doubt_of_added, share_of
from discover.gap.rounds import (
    Open,
    Round,
    exchanged,
    named_again,
    next_round,
    weighed,
    within,
)
from discover.gap.stages import Stage, seen_gap, stage
from discover.naming.columns import CandidateColumns
from discover.naming.contest import Contest
from discover.naming.evidence import UNKNOWN
from discover.naming.fit import fit_model, free_parameters, misfits
from discover.naming.forces import has_joint
from models.checks import Array

MOST_ROUNDS = 6
_MOVED = 0.05  # of chi-square a row, by which refitting has to help to count as a change
_MOST_MEMBERS = 4  # that are added to the curves of effects


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
    doubts: dict[str, Array] = {}  # chi-square by record that each effect's shape may be wrong by
    members, curves = 0, True
    deep, contest = True, None
    columns = CandidateColumns(fitted)
    while True:
        now = rounds[-1].after if rounds else first
        present = {t.id for t in now.fit.model.terms}
        doubt = np.sum([given.by_record, *doubts.values()], axis=0)
        open_effects = [e for e in effects if e not in present and e not in tried]
        if contest is None:
            settled = within(rows, now, rounds, given)
            contest = weighed(fitted, now.fit, open_effects, doubt, columns, settled=settled)
        left = Open(open_effects, rounds, len(rounds) < most, curves, deep, given, columns)
        found = next_round(rows, fitted, now, left, *contest)
        added, better = found.added, None
        if added is not None:
            added = named_again(rows, fitted, now, left, added, doubt)
        elif rounds:
            names, before = [r.effect for r in rounds], rounds[-1].members
            most_members = _MOST_MEMBERS - members
            better = corrected(rows, fitted, now, names, before=before, most=most_members)
        if added is None and better is None:
            if found.waits:
                curves = False
                continue
            unnamed = found.contest.ranked[0][0] == UNKNOWN
            if unnamed and not deep and not has_joint(now.fit.model):
                deep = True
                continue
            better = reversal_corrected(rows, fitted, now, rounds[-1].members) if rounds else None
            added = exchanged(rows, fitted, now, left, doubt, doubts) if better is None else None
        if added is not None:
            curves, deep, contest = True, False, None
            without = added.beside or now.fit
            explained = misfits(fitted, without) - misfits(fitted, added.stage.fit)
            doubts[added.effect] = share_of(added.effect) ** 2 * np.maximum(explained, 0.0)
            doubts.pop(added.instead_of, None)
            tried |= set(added.dropped)
            rounds.append(added)
            if tell is not None:
                gap = seen_gap(rows, added.stage)
                tell(f"round {len(rounds)} added {added.effect}, gap {gap:.3g} %")
        elif better is not None:
            members += len(better.effects) - len(rounds[-1].members)
            deep, contest = False, None
            earlier = rounds[-1].corrected
            kept = better.reversal or (earlier is not None and earlier.reversal)
            rounds[-1] = replace(rounds[-1], corrected=replace(better, reversal=kept))
        else:
            return Search(start, refitted, tuple(rounds), found.contest, found.rejected)

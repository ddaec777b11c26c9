"""Two effects at once: whether a second beside the best few explains what none does alone."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from discover.naming.contest import Contest, Entry, pair_evidence, run_contest
from discover.naming.fit import ModelFit, fit_model, free_parameters
from discover.naming.refine import refine
from discover.naming.rows import RecordRows

_FIRST = 3  # effects, beside which a second is sought
_SECOND = 2  # that are kept beside each
_STEPS = 15
_SHARED = 0.6  # of what the best alone leaves, that a pair may leave


def pairs_ahead(
    rows: Sequence[RecordRows],
    contest: Contest,
    fits: Mapping[str, ModelFit],
    effects: Sequence[str],
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
    """
    leading = sorted((f for f in fits if np.isfinite(fits[f].chi2)), key=lambda f: fits[f].chi2)
    if not leading or contest.excess <= 0.0:
        return ()
    least = fits[leading[0]].chi2 - contest.noise
    found = []
    for name in leading[:_FIRST]:
        first = contest.best(name)
        if first is None:
            continue
        others = [e for e in effects if e != name]
        model = fits[name].model
        begun = fit_model(rows, model, free_parameters(model), iterations=_STEPS)
        second, refined = refine(rows, begun, run_contest(rows, begun, others), others)
        for other in sorted(refined, key=lambda e: refined[e].chi2)[:_SECOND]:
            entry = second.best(other)
            left = refined[other].chi2
            if entry is None or left - contest.noise > _SHARED * least:
                continue
            variants = (*first.variants, *entry.variants)
            found.append(
                Entry(
                    (name, other), variants, (*first.coefficients, *entry.coefficients), left,
                    pair_evidence(rows, contest, left, variants),
                )
            )
    return tuple(found)

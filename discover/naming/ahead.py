"""What is searched before a misfit is called unknown: other starts of joints, and pairs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from discover.naming.contest import Contest, pair_evidence, run_contest
from discover.naming.evidence import Entry
from discover.naming.fit import ModelFit, fit_model, free_parameters, kind_of
from discover.naming.forces import DELAY, is_joint
from discover.naming.refine import extended, refine
from discover.naming.restart import restarted
from discover.naming.rows import RecordRows

_FIRST = 3  # effects, beside which a second is sought
_SECOND = 2  # that are kept beside each
_STEPS = 15
_SHARED = 0.6  # of what the best alone leaves, that a pair may leave


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
    if not leading:
        return ()
    least = fits[leading[0]].chi2 - contest.noise
    if least <= 0.0:
        return ()
    found = []
    for place, name in enumerate(leading[:_FIRST]):
        first = contest.best(name)
        if first is None:
            continue
        others = [e for e in effects if e != name]
        model = fits[name].model
        begun = fit_model(rows, model, free_parameters(model), iterations=_STEPS)
        second, refined = refine(rows, begun, run_contest(rows, begun, others), others)
        if place == 0 and name != DELAY and not is_joint(name):  # two at once take minutes
            refined = every_joint(rows, begun, second, refined)
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

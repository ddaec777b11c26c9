"""The catalogue as trials: every term's shapes, in a campaign, beside a model."""

from __future__ import annotations

from collections.abc import Collection

import numpy as np

from discover.posterior.model import Composite, Evaluator
from discover.posterior.weigh import Trial, Trials
from models.constitutive import FittedTerm
from models.motion import sine_motion
from models.terms import TERMS, Scales, Start, Term
from models.terms.trials import trial_shapes, trial_size

EXPECTED = 0.5
"""Number of terms beyond a device's structure that are expected beforehand."""


def starts_of(term: Term, scales: Scales) -> list[Start]:
    """Return the shapes that are tried first: the term's own, or its parameters spread."""
    if term.starts is not None:
        return list(term.starts(scales))
    sizes = {name: scales.size(name) for name in ("displacement", "speed", "force")}
    shapes = trial_shapes(term, sizes)
    if term.transform is None:
        return [Start((shape,)) for shape in shapes]
    frequency = scales.speed / scales.displacement / (2.0 * np.pi)
    motion = sine_motion(scales.displacement, frequency)
    carried = motion.acceleration * (2.0 * np.pi * frequency) ** -1 + motion.velocity
    force = carried * scales.force / float(np.abs(carried).max())
    return [Start((s,), trial_size(term, s, motion, force)) for s in shapes]


def term_log_prior(term: Term, among: int, expected: float = EXPECTED) -> float:
    """Return the log odds (nats) of a term beforehand, as one of so many that may join."""
    return float(np.log(expected / among if term.common is None else term.common))


def trials_of(
    scales: Scales,
    evaluator: Evaluator,
    ids: Collection[str],
    model: Composite,
    *,
    among: int,
    expected: float = EXPECTED,
) -> Trials:
    """Return the trials of some terms.

    Parameters
    ----------
    scales : Scales
        What the records cover.
    evaluator : Evaluator
        Of their rows.
    ids : collection of str
        Terms that are tried; those whose `needs` the model lacks are left out.
    model : Composite
        What changes of motion or force act on.
    among : int
        Number of terms that may join in all.
    expected : float
        Number of terms that are expected beforehand, but for those that are common.
    """
    there = {p.fitted.id for p in model.terms}
    entries: list[Trial] = []
    flat: list[FittedTerm] = []
    chosen = [TERMS[i] for i in ids if not set(TERMS[i].needs) - there]
    for term in chosen:
        starts = starts_of(term, scales)
        prior = term_log_prior(term, among, expected) - float(np.log(len(starts)))
        for start in starts:
            probe = start.probe if term.transform is not None else 1.0
            terms = tuple(FittedTerm(term.id, probe, dict(s)) for s in start.shapes)
            places = np.arange(len(flat), len(flat) + len(terms))
            entries.append(Trial(terms, places, prior))
            flat.extend(terms)
    return Trials(tuple(entries), evaluator.trials(model, flat))

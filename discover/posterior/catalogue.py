"""The catalogue as trials: every term's shapes, in a campaign, beside a model."""

from __future__ import annotations

from collections.abc import Collection, Sequence

import numpy as np

from discover.posterior.space import Space
from discover.posterior.weigh import Trial, Trials
from discover.rows import RecordRows
from discover.rows.columns import Changes, force_columns
from models.constitutive import FittedTerm, ForceModel
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


def trials_of(
    space: Space,
    ids: Collection[str],
    model: ForceModel,
    *,
    among: int,
    expected: float = EXPECTED,
) -> Trials:
    """Return the trials of some terms.

    Parameters
    ----------
    space : Space
        That a model's columns are in.
    ids : collection of str
        Terms that are tried; those whose `needs` the model lacks are left out.
    model : ForceModel
        What changes of motion or force act on.
    among : int
        Number of terms that may join in all.
    expected : float
        Number of terms that are expected beforehand.
    """
    there = {t.id for t in model.terms}
    entries: list[Trial] = []
    flat: list[FittedTerm] = []
    chosen = [TERMS[i] for i in ids if not set(TERMS[i].needs) - there]
    for term in chosen:
        starts = starts_of(term, space.scales)
        prior = float(np.log(expected / among) - np.log(len(starts)))
        for start in starts:
            probe = start.probe if term.transform is not None else 1.0
            terms = tuple(FittedTerm(term.id, probe, dict(s)) for s in start.shapes)
            places = np.arange(len(flat), len(flat) + len(terms))
            entries.append(Trial(terms, places, prior))
            flat.extend(terms)
    blocks = [_columns(r.coarse, flat, model) for r in space.sheet.rows]
    return Trials(tuple(entries), space.sheet.stack(blocks))


def _columns(rows: RecordRows, terms: Sequence[FittedTerm], model: ForceModel) -> np.ndarray:
    adding = [k for k, t in enumerate(terms) if t.term.acts == "force"]
    changing = [k for k, t in enumerate(terms) if t.term.acts != "force"]
    result = np.zeros((len(terms), rows.target.size))
    if adding:
        result[adding] = force_columns(rows, [terms[k] for k in adding])
    if changing:
        result[changing] = Changes(rows, model).columns([terms[k] for k in changing])
    return result

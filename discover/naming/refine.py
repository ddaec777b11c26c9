"""Candidates refined: the best shapes of the leading effects fitted for real, with the model."""

from __future__ import annotations

from collections.abc import Sequence

from discover.naming.contest import Contest, Entry, reweighed
from discover.naming.fit import ModelFit, fit_model, free_parameters
from discover.naming.rows import RecordRows
from models.constitutive import FittedTerm, ForceModel
from models.terms import TERMS

_LEADING = 6
_ITERATIONS = 8
_ENOUGH = 0.02
_WITHIN = 60.0  # nats behind the best, within which a candidate is refined


def extended(model: ForceModel, entry: Entry, *, only_first: bool = True) -> ForceModel:
    """Return the model with an entry's effect added, at the size that the contest found."""
    terms = list(model.terms)
    pairs = list(zip(entry.variants, entry.coefficients, strict=True))
    for variant, values in pairs[:1] if only_first else pairs:
        for part, value in zip(variant.parts, values, strict=True):
            start = part.probe if part.id == "series-compliance" else _sensible(part.id, value)
            terms.append(FittedTerm(part.id, start, part.shape))
    return ForceModel(tuple(terms), model.name)


def _sensible(identifier: str, value: float) -> float:
    """Return a first guess: shares of a whole start within it."""
    if identifier in ("sensor-clipping", "cavitation", "backlash"):
        return min(max(value, 0.05), 1.0)
    return max(value, 0.0) if TERMS[identifier].nonnegative else value


def refine(
    rows: Sequence[RecordRows], fit: ModelFit, contest: Contest, effects: Sequence[str]
) -> tuple[Contest, dict[str, ModelFit]]:
    """Return the contest with its leading effects fitted for real, and those fits.

    Parameters
    ----------
    rows : sequence of RecordRows
        Records that are fitted.
    fit : ModelFit
        The model as it is.
    contest : Contest
        From `run_contest`.
    effects : sequence of str
        Ids that were weighed.
    """
    singles = [e for e in contest.entries if len(e.effects) == 1]
    if not singles:
        return contest, {}
    best = max(e.log_evidence for e in contest.entries)
    leading = [e for e in singles[:_LEADING] if e.log_evidence > best - _WITHIN]
    fits: dict[str, ModelFit] = {}
    for entry in leading:
        model = extended(fit.model, entry)
        free = free_parameters(model)
        found = fit_model(rows, model, free, iterations=_ITERATIONS, enough=_ENOUGH)
        if TERMS[entry.effects[0]].nonnegative and found.model.terms[-1].coefficient <= 0.0:
            continue
        fits[entry.effects[0]] = found
    return reweighed(rows, contest, fits, effects), fits

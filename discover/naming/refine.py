"""Candidates refined: the best shapes of the leading effects fitted for real, with the model."""

from __future__ import annotations

from collections.abc import Sequence

from discover.naming.contest import Contest, Entry, reweighed
from discover.naming.fit import ModelFit, UnitRows, fit_model, free_parameters
from discover.naming.rows import RecordRows
from models.constitutive import FittedTerm, ForceModel
from models.terms import TERMS

_LEADING = 6
_KINDS = (6, 4, 2, 1)  # of shapes that are fitted, of the first effect, the second, ...
_FIRST_STEPS = 2
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
    units = UnitRows()
    fits: dict[str, ModelFit] = {}
    for place, entry in enumerate(leading):
        name = entry.effects[0]
        starts = contest.starts[name][: _KINDS[min(place, len(_KINDS) - 1)]]
        models = [extended(fit.model, start) for start in starts]
        if len(models) > 1:
            begun = [_fit(rows, m, units, _FIRST_STEPS) for m in models]
            models = [min(begun, key=lambda f: f.chi2).model]
        found = _fit(rows, models[0], units, _ITERATIONS)
        if TERMS[name].nonnegative and found.model.terms[-1].coefficient <= 0.0:
            continue
        fits[name] = found
    return reweighed(rows, contest, fits, effects), fits


def _fit(
    rows: Sequence[RecordRows], model: ForceModel, units: UnitRows, steps: int
) -> ModelFit:
    return fit_model(
        rows, model, free_parameters(model), iterations=steps, enough=_ENOUGH, units=units
    )

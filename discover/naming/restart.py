"""Other starts for what a joint does: its impacts make chi-square a landscape of many hollows."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import product

from discover.naming.fit import ModelFit, UnitRows, fit_model, free_parameters
from discover.naming.rows import RecordRows
from models.constitutive import FittedTerm, ForceModel

_FACTORS = {"contact": (0.4, 1.0, 2.5), "gap": (0.7, 0.85, 1.0, 1.2)}  # of a joint's shape
_LOSSES = (0.1, 0.5)
_FIRST = 3  # that are begun
_FIRST_STEPS = 3
_AGAIN = 12
_ENOUGH = 0.003
_GOOD = 1.5  # of chi-square a row, up to which no other start is sought


def restarted(rows: Sequence[RecordRows], fit: ModelFit, at: int) -> ModelFit:
    """Return the best of the fit and fits from other shapes of the joint in its term `at`.

    Parameters
    ----------
    rows : sequence of RecordRows
        Records that are fitted.
    fit : ModelFit
        Where the first start led; returned as it is where it leaves little.
    at : int
        Index of the joint's term.
    """
    if fit.chi2 < _GOOD * fit.residual.size:
        return fit
    joint = fit.model.terms[at]
    shapes = _other_shapes(joint)
    units = UnitRows()
    starts = []
    for shape in shapes:
        model = _with(fit.model, at, FittedTerm(joint.id, 1.0, shape))
        starts.append(fit_model(rows, model, (), units=units))
    starts.sort(key=lambda f: f.chi2)
    begun = [
        fit_model(
            rows, s.model, free_parameters(s.model), iterations=_FIRST_STEPS, units=units,
            exact=False,
        )
        for s in starts[:_FIRST]
    ]
    best = min(begun, key=lambda f: f.chi2, default=fit)
    again = fit_model(
        rows, best.model, free_parameters(best.model), iterations=_AGAIN, enough=_ENOUGH,
        units=units,
    )
    return again if again.chi2 < fit.chi2 else fit


def _other_shapes(joint: FittedTerm) -> list[dict[str, float]]:
    """Return shapes around a joint's own; none for one without contact."""
    if not joint.shape.get("contact", 0.0):
        return []
    names = [n for n in _FACTORS if n in joint.shape]
    found = []
    for *factors, loss in product(*(_FACTORS[n] for n in names), _LOSSES):
        scaled = {n: joint.shape[n] * f for n, f in zip(names, factors, strict=True)}
        found.append({**joint.shape, **scaled, "loss": loss})
    return found


def _with(model: ForceModel, at: int, term: FittedTerm) -> ForceModel:
    terms = list(model.terms)
    terms[at] = term
    return ForceModel(tuple(terms), model.name)

"""Other starts for what a joint does: its impacts make chi-square a landscape of many hollows."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import product

import numpy as np

from discover.naming.fit import ModelFit, UnitRows, fit_model, free_parameters
from discover.naming.rows import RecordRows
from models.constitutive import FittedTerm, ForceModel

_FACTORS = {"contact": (0.4, 1.0, 2.5), "gap": (0.7, 0.85, 1.0, 1.2)}  # of a joint's shape
_LOSSES = (0.1, 0.5)
_SPRINGS = (0.5, 0.7, 0.85, 1.0, 1.2, 1.5, 2.0)  # factors of a compliance
_GASES = ((0.15, 0.3), (0.15, 0.7), (0.5, 0.3), (0.5, 0.7), (2.0, 0.9))  # of force, and share
_SPRING_LOSS = 0.05
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
    units = UnitRows()
    starts = []
    for other in _others(joint, max(float(np.abs(r.observation.measured).max()) for r in rows)):
        model = _with(fit.model, at, other)
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


def _others(joint: FittedTerm, force: float) -> list[FittedTerm]:
    """Return joints around one, for a campaign of forces up to `force` (N); none for others."""
    if joint.id == "series-compliance":
        return [
            FittedTerm(
                joint.id, joint.coefficient * factor,
                {
                    **joint.shape, "hardening": load * force, "gas": gas, "loss": _SPRING_LOSS,
                    "side": side,
                },
            )
            for side in {0.0, joint.shape["side"]}
            for factor in _SPRINGS
            for load, gas in _GASES
        ]
    if not joint.shape.get("contact", 0.0):
        return []
    names = [n for n in _FACTORS if n in joint.shape]
    found = []
    for *factors, loss in product(*(_FACTORS[n] for n in names), _LOSSES):
        scaled = {n: joint.shape[n] * f for n, f in zip(names, factors, strict=True)}
        found.append(FittedTerm(joint.id, 1.0, {**joint.shape, **scaled, "loss": loss}))
    return found


def _with(model: ForceModel, at: int, term: FittedTerm) -> ForceModel:
    terms = list(model.terms)
    terms[at] = term
    return ForceModel(tuple(terms), model.name)

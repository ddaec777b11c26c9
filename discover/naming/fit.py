"""Fitting a model to whitened rows: coefficients and shapes by Gauss-Newton with step control."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from discover.naming.forces import model_force
from discover.naming.rows import RecordRows
from models.checks import Array
from models.constitutive import FittedTerm, ForceModel

_FIXED_SHAPES = ("form", "side", "power", "threshold", "inside", "refill", "heating")
_ITERATIONS = 12
_SMALL = 1e-5


@dataclass(frozen=True)
class Parameter:
    """One number of a model that may be fitted."""

    term: int
    """Index of its term."""
    shape: str | None
    """Name of the shape parameter; None for the coefficient."""


@dataclass(frozen=True)
class ModelFit:
    """A model fitted to rows."""

    model: ForceModel
    """With its values."""
    chi2: float
    """Sum of squared whitened misfits."""
    residual: Array
    """(R,) whitened misfit."""
    tangents: Array
    """(P, R) change of the rows with each parameter."""
    parameters: tuple[Parameter, ...]
    """In the tangents' order."""
    covariance: Array
    """(P, P) of the parameters."""


def free_parameters(model: ForceModel) -> tuple[Parameter, ...]:
    """Return the parameters of all terms.

    A shape parameter of zero stands for a limit (a jump, a straight line) and stays.
    """
    found = []
    for index, fitted in enumerate(model.terms):
        found.append(Parameter(index, None))
        found += [
            Parameter(index, name)
            for name, value in fitted.shape.items()
            if name not in _FIXED_SHAPES and value != 0.0
        ]
    return tuple(found)


def value_of(model: ForceModel, parameter: Parameter) -> float:
    """Return a parameter's value."""
    fitted = model.terms[parameter.term]
    return fitted.coefficient if parameter.shape is None else fitted.shape[parameter.shape]


def with_values(
    model: ForceModel, parameters: Sequence[Parameter], values: Array
) -> ForceModel:
    """Return the model with other values."""
    terms = list(model.terms)
    for parameter, value in zip(parameters, values, strict=True):
        old = terms[parameter.term]
        if parameter.shape is None:
            terms[parameter.term] = FittedTerm(old.id, float(value), old.shape)
        else:
            shape = {**old.shape, parameter.shape: float(value)}
            terms[parameter.term] = FittedTerm(old.id, old.coefficient, shape)
    return ForceModel(tuple(terms), model.name)


def whole_model(rows: RecordRows, model: ForceModel) -> ForceModel:
    """Return the model with the terms that the record holds."""
    return ForceModel((*rows.held, *model.terms), model.name) if rows.held else model


def rows_of_model(rows: Sequence[RecordRows], model: ForceModel) -> Array:
    """Return the whitened rows of a model's force, all records after each other."""
    parts = [r.project(model_force(r.observation, whole_model(r, model))) for r in rows]
    return np.concatenate(parts)


def _rows_of_terms(rows: Sequence[RecordRows], *terms: FittedTerm) -> Array:
    alone = ForceModel(terms)
    return np.concatenate([r.project(model_force(r.observation, alone)) for r in rows])


def _tangents(
    rows: Sequence[RecordRows], model: ForceModel, parameters: Sequence[Parameter], at: Array
) -> Array:
    transforms = any(t.term.acts != "force" for r in rows for t in (*r.held, *model.terms))
    result = np.empty((len(parameters), at.size))
    for index, parameter in enumerate(parameters):
        fitted = model.terms[parameter.term]
        value = value_of(model, parameter)
        if parameter.shape is None and not transforms:
            result[index] = _rows_of_terms(rows, FittedTerm(fitted.id, 1.0, fitted.shape))
            continue
        step = 1e-4 * abs(value) or 1e-6
        if parameter.shape in ("order", "exponent"):
            step = -step  # stays below the upper bound
        if parameter.shape is not None and not transforms:
            there = {**fitted.shape, parameter.shape: value + step}
            moved = FittedTerm(fitted.id, fitted.coefficient, there)
            result[index] = (_rows_of_terms(rows, moved) - _rows_of_terms(rows, fitted)) / step
            continue
        other = with_values(model, [parameter], np.array([value + step]))
        result[index] = (rows_of_model(rows, other) - at) / step
    return result


def _bounded(model: ForceModel, parameters: Sequence[Parameter], values: Array) -> Array:
    """Return values within their physical bounds: shapes move by at most half in one step."""
    result = values.copy()
    for index, parameter in enumerate(parameters):
        if parameter.shape is None:
            continue
        term = model.terms[parameter.term].term
        known = next(p for p in term.parameters if p.name == parameter.shape)
        old = value_of(model, parameter)
        low, high = (0.6 * old, 1.6 * old)
        if not known.scaled_by:
            low, high = max(low, known.lower), min(high, known.upper)
        result[index] = float(np.clip(values[index], min(low, high), max(low, high)))
    return result


def inverse(gram: Array) -> Array:
    """Return the pseudo-inverse of a Gram matrix whose columns differ widely in size."""
    scale = np.sqrt(np.maximum(np.diagonal(gram), 0.0))
    scale = np.where(scale > 0.0, scale, 1.0)
    outer = np.outer(scale, scale)
    return np.asarray(np.linalg.pinv(gram / outer, rcond=1e-12, hermitian=True) / outer)


def fit_model(
    rows: Sequence[RecordRows],
    model: ForceModel,
    parameters: Sequence[Parameter],
    *,
    iterations: int = _ITERATIONS,
    enough: float = _SMALL,
) -> ModelFit:
    """Return the model with `parameters` fitted by Gauss-Newton, started from its own values.

    Parameters
    ----------
    rows : sequence of RecordRows
        Records to fit.
    model : ForceModel
        Where to start.
    parameters : sequence of Parameter
        What may change; the rest is held.
    iterations : int
        At most.
    enough : float
        Relative gain of chi-square below which to stop.
    """
    target = np.concatenate([r.target for r in rows])
    at = rows_of_model(rows, model)
    chi2 = float(np.sum((target - at) ** 2))
    tangents = _tangents(rows, model, parameters, at)
    for _ in range(iterations if parameters else 0):
        scale = np.linalg.norm(tangents, axis=1)
        safe = np.where(scale > 0.0, scale, 1.0)
        step, *_ = np.linalg.lstsq((tangents / safe[:, None]).T, target - at, rcond=1e-9)
        old = np.array([value_of(model, p) for p in parameters])
        gained = False
        for share in (1.0, 0.4, 0.1, 0.02):
            values = _bounded(model, parameters, old + share * step / safe)
            trial = with_values(model, parameters, values)
            rows_now = rows_of_model(rows, trial)
            now = float(np.sum((target - rows_now) ** 2))
            if now < chi2:
                gained = chi2 - now > enough * max(chi2, 1.0)
                model, at, chi2 = trial, rows_now, now
                break
        if not gained:
            break
        tangents = _tangents(rows, model, parameters, at)
    covariance = inverse(tangents @ tangents.T)
    return ModelFit(model, chi2, target - at, tangents, tuple(parameters), covariance)

"""Fitting a model to whitened rows.

Coefficients of added forces are solved for exactly at each shape (variable projection); shapes,
and whatever acts through a change of input or output, by Levenberg-Marquardt.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from discover.naming.forces import (
    DELAY,
    adds_up,
    coefficient_bounds,
    is_joint,
    is_sensor,
    share_in,
)
from discover.naming.rows import RecordRows
from discover.naming.unit_rows import UnitRows
from models.checks import Array
from models.constitutive import WHOLE_ORDERS, FittedTerm, ForceModel

_FIXED_SHAPES = ("form", "side", "power", "threshold", "inside", "refill", "resampled",
                 "one_way", "from_test", "over", "only", "sampling", "filter_order",
                 "digital", "load", "load_power")
_APART = 0.1  # of orders and powers: a free one from the whole ones in the same model
_WHOLE_POWERS = {"viscous-damping": 1.0, "quadratic-damping": 2.0}
_STEP = 1e-4  # of a value, for its tangent
_JOINT_STEP = 1e-3  # likewise behind a joint, whose simulated cycle closes to less
ITERATIONS = 40
_IDLE = 2  # steps that gain nothing, at which a fit ends; with tangents that are kept the first
_TRIES = 6
_DAMPING = 1e-4
_LEAST_DAMPING = 1e-10
_SMALL = 1e-4
_SHARP = 0.05  # of the greatest speed, over which friction reverses at most beside no resistance
_SLACK = 1.5  # of bounds in shares of what the records cover


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


def _moves(name: str, value: float) -> bool:
    """Tell whether a shape parameter is fitted: zero stands for a limit and stays."""
    return name not in _FIXED_SHAPES and value != 0.0


def kind_of(shape: Mapping[str, float]) -> tuple[tuple[str, float | None], ...]:
    """Return what a fit does not change in a shape: its choices, and what is at its limit."""
    return tuple(
        (name, None if _moves(name, value) else value) for name, value in sorted(shape.items())
    )


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
            if _moves(name, value)
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


def _transforms(rows: Sequence[RecordRows], model: ForceModel) -> bool:
    return any(t.term.acts != "force" for r in rows for t in (*r.held, *model.terms))


def _tangents(
    rows: Sequence[RecordRows],
    units: UnitRows,
    model: ForceModel,
    parameters: Sequence[Parameter],
    at: Array,
    *,
    linear: bool,
    rough: bool = False,
) -> Array:
    """Return the change (P, R) of the rows with each parameter; `linear`: forces only add.

    `rough` leaves out that a joint passes an added force on changed: enough for a step. What a
    sensor makes of it is not left out, since a gain would keep steps from ever arriving.
    """
    result = np.empty((len(parameters), at.size))
    terms = [t for r in rows for t in (*r.held, *model.terms)]
    sensors = [t for t in terms if is_sensor(t.term)]
    adding = all(adds_up(t.term, t.shape) for t in sensors)
    through = any(is_joint(t.id) for t in terms)
    rough = rough and adding
    as_added = rough and all(t.id == DELAY for t in sensors)
    for index, parameter in enumerate(parameters):
        fitted = model.terms[parameter.term]
        value = value_of(model, parameter)
        adds = fitted.term.acts == "force" and (linear or rough or (adding and not through))
        if parameter.shape is None and adds:
            of = units.of_all(rows, fitted) if as_added else units.of_sensed(rows, fitted, model)
            result[index] = of
            continue
        step = (_STEP if linear else _JOINT_STEP) * abs(value) or 1e-6
        if parameter.shape in ("order", "exponent"):
            step = -step  # stays below the upper bound
        other = with_values(model, [parameter], np.array([value + step]))
        if fitted.shape.get("only", 0.0) > 0.0 and not linear:
            result[index] = _in_one_test(rows, units, fitted, other, at) / step
            continue
        if adds and not through:
            moved = units.of_sensed(rows, other.terms[parameter.term], model)
            change = fitted.coefficient * (moved - units.of_sensed(rows, fitted, model))
        else:
            change = units.of_model(rows, other) - at
        result[index] = np.where(np.isfinite(change), change, 0.0) / step
    return result


def _in_one_test(
    rows: Sequence[RecordRows], units: UnitRows, fitted: FittedTerm, other: ForceModel, at: Array
) -> Array:
    """Return the change (R,) to another model that differs in a term of one test only."""
    change, end = np.zeros_like(at), 0
    for r in rows:
        begin, end = end, end + r.target.size
        if share_in(r.observation, fitted.shape) > 0.0:
            change[begin:end] = units.of_model([r], other) - at[begin:end]
    return np.where(np.isfinite(change), change, 0.0)


def _bounded(
    model: ForceModel,
    parameters: Sequence[Parameter],
    values: Array,
    sizes: Mapping[str, float],
) -> Array:
    """Return values within their physical bounds: shapes move by at most half in one step.

    Bounds in shares of what the records cover (`sizes`) give way a little: beyond them a shape
    is another one's, as a friction that falls at a speed that no record reaches is plain friction.
    Without viscous damping in the model friction has to reverse sharply: over a wide range of
    speed it is a resistance, and would hide that one is missing.
    """
    result = values.copy()
    sharp = all(t.id != "viscous-damping" for t in model.terms)
    for index, parameter in enumerate(parameters):
        fitted = model.terms[parameter.term]
        if parameter.shape is None:
            low, high = coefficient_bounds(fitted.shape)
            given = fitted.coefficient  # may be beyond
            result[index] = np.clip(values[index], min(low, given), max(high, given))
            continue
        known = next(p for p in fitted.term.parameters if p.name == parameter.shape)
        old = value_of(model, parameter)
        low, high = (0.6 * old, 1.6 * old)
        if not known.scaled_by:
            low, high = max(low, known.lower), min(high, known.upper)
        elif old > 0.0:
            size = sizes[known.scaled_by]
            upper = known.upper * _SLACK
            if sharp and fitted.id == "coulomb-friction" and parameter.shape.endswith("_speed"):
                upper = min(upper, _SHARP)
            low = max(low, min(known.lower * size / _SLACK, old))
            high = min(high, max(upper * size, old))
        if parameter.shape == "order":
            low, high = _apart(model, old, low, high)
        result[index] = float(np.clip(values[index], min(low, high), max(low, high)))
        if fitted.id == "power-law-damping":
            result[index] = _off_whole(model, old, float(result[index]))
    return result


def _off_whole(model: ForceModel, old: float, power: float) -> float:
    """Return a power clear of the whole ones that the model has besides: steps go past them."""
    for whole in (_WHOLE_POWERS[t.id] for t in model.terms if t.id in _WHOLE_POWERS):
        if abs(power - whole) < _APART < abs(old - whole) + 1e-9:
            power = whole + np.copysign(_APART, old - whole)
    return power


def _apart(model: ForceModel, order: float, low: float, high: float) -> tuple[float, float]:
    """Return bounds of an order clear of the derivatives that the model has besides.

    Beside inertia a derivative of nearly second order is the difference of two huge forces.
    """
    for other in (WHOLE_ORDERS[t.id] for t in model.terms if t.id in WHOLE_ORDERS):
        if order < other:
            high = min(high, max(other - _APART, order))
        elif order > other:
            low = max(low, min(other + _APART, order))
    return low, high


def misfits(rows: Sequence[RecordRows], fit: ModelFit) -> Array:
    """Return every record's part (N,) of a fit's chi-square."""
    ends = np.cumsum([r.target.size for r in rows])[:-1]
    return np.array([float(np.sum(part**2)) for part in np.split(fit.residual, ends)])


def telling(rows: Sequence[RecordRows], fit: ModelFit, most: int) -> list[int]:
    """Return which records, `most` of them, a fit leaves the greatest misfits in, that first."""
    return [int(i) for i in np.argsort(misfits(rows, fit))[::-1][:most]]


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
    iterations: int = ITERATIONS,
    enough: float = _SMALL,
    units: UnitRows | None = None,
    exact: bool = True,
    along: Array | None = None,
    stay: Array | None = None,
    rough: bool = True,
) -> ModelFit:
    """Return the model with `parameters` fitted, started from its own values.

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
    units : UnitRows, optional
        Rows that are known already, where several fits share records.
    exact : bool
        Whether the fit's tangents hold what a joint does to an added force.
    along : array, optional
        (P, R) tangents at the start, kept for all steps: for models that simulate a joint, where
        the start is close and tangents cost most.
    stay : array, optional
        (P, P) curvature that draws the parameters to their start. For models that are not sums of
        forces.
    rough : bool
        Whether steps leave out that a joint passes an added force on changed.
    """
    target = np.concatenate([r.target for r in rows])
    sizes = {name: max(r.sizes[name] for r in rows) for name in rows[0].sizes}
    units = UnitRows() if units is None else units
    linear = not _transforms(rows, model)
    if linear:
        model = _solved(rows, units, model, parameters, target)
    at = units.of_model(rows, model)
    chi2 = _square(target - at)

    def slopes() -> Array:
        if along is not None:
            return along
        return _tangents(rows, units, model, parameters, at, linear=linear, rough=rough)

    tangents = slopes()
    begun = np.array([value_of(model, p) for p in parameters])

    def drawn(values: Array) -> float:
        return 0.0 if stay is None else float((values - begun) @ stay @ (values - begun))

    settled = not parameters or (linear and all(p.shape is None for p in parameters))
    damping, idle = _DAMPING, 0
    for _ in range(0 if settled or not np.isfinite(chi2) else iterations):
        scale = np.linalg.norm(tangents, axis=1)
        safe = np.where(scale > 0.0, scale, 1.0)
        unit = tangents / safe[:, None]
        gram, slope = unit @ unit.T, unit @ (target - at)
        old = np.array([value_of(model, p) for p in parameters])
        if stay is not None:
            gram = gram + stay / np.outer(safe, safe)
            slope = slope - stay @ (old - begun) / safe
        before, pull = chi2, drawn(old)
        for _ in range(_TRIES):
            step = _step(gram, slope, damping)
            values = _bounded(model, parameters, old + step / safe, sizes)
            stuck = (values == old) & (step != 0.0)
            if stuck.any() and not stuck.all():  # at a bound: the others step without it
                step = np.zeros(len(parameters))
                step[~stuck] = _step(gram[np.ix_(~stuck, ~stuck)], slope[~stuck], damping)
                values = _bounded(model, parameters, old + step / safe, sizes)
            trial = with_values(model, parameters, values)
            if linear:
                trial = _solved(rows, units, trial, parameters, target)
            rows_now = units.of_model(rows, trial)
            now = _square(target - rows_now)
            if now + drawn(values) < chi2 + pull:
                model, at, chi2 = trial, rows_now, now
                damping = max(damping / 10.0, _LEAST_DAMPING)
                break
            damping = max(10.0 * damping, _DAMPING)
        else:
            break
        tangents = slopes()
        idle = idle + 1 if before - chi2 <= enough * max(chi2, 1.0) else 0
        if idle == (_IDLE if along is None else 1):
            break
    if exact and not linear:
        tangents = _tangents(rows, units, model, parameters, at, linear=False)
    covariance = inverse(tangents @ tangents.T)
    return ModelFit(model, chi2, target - at, tangents, tuple(parameters), covariance)


def _square(left: Array) -> float:
    """Return the sum of squares; not finite where a joint shook itself apart."""
    with np.errstate(over="ignore", invalid="ignore"):
        return float(np.sum(left**2))


def _step(gram: Array, slope: Array, damping: float) -> Array:
    """Return the damped Gauss-Newton step of scaled parameters."""
    damped = gram + damping * np.eye(slope.size)
    return np.asarray(np.linalg.lstsq(damped, slope, rcond=1e-12)[0])


def _solved(
    rows: Sequence[RecordRows],
    units: UnitRows,
    model: ForceModel,
    parameters: Sequence[Parameter],
    target: Array,
) -> ForceModel:
    """Return the model with its free coefficients at their least-squares values."""
    free = [p for p in parameters if p.shape is None]
    if not free:
        return model
    columns = np.stack([units.of_all(rows, model.terms[p.term]) for p in free])
    held = with_values(model, free, np.zeros(len(free)))
    rest = target - units.of_model(rows, held)
    size = np.linalg.norm(columns, axis=1)
    size[size == 0.0] = 1.0
    solution = np.linalg.lstsq((columns / size[:, None]).T, rest, rcond=1e-10)[0]
    return with_values(model, free, solution / size)

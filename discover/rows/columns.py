"""Columns of terms in every record: each shape is evaluated once."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from discover.rows.force import RecordForces, unit
from discover.rows.record_rows import RecordRows
from models.checks import Array
from models.constitutive import FittedTerm, ForceModel
from models.terms import Scales, Term

_STEEPEST = 1e100  # N over the unit of a coefficient, or of a shape parameter
_STEP = 1e-3  # of a shape parameter's range, over which its slope is taken


def scales_of(rows: Sequence[RecordRows]) -> Scales:
    """Return what the records cover."""
    observations = [r.observation for r in rows]
    speeds = [o.speed for o in observations]
    amplitudes = [o.amplitude for o in observations]
    peaks = sorted(float(np.abs(o.measured).max()) for o in observations)
    omegas = [2.0 * np.pi * float(w.frequency) for o in observations for w in o.windows]
    steps = [o.motion.step for o in observations]
    return Scales(
        displacement=max(amplitudes),
        least_displacement=min(amplitudes),
        speed=max(speeds),
        least_speed=min(speeds),
        force=peaks[-1],
        peaks=tuple(peaks),
        duration=max(o.duration for o in observations),
        omega=max(omegas),
        least_omega=max(min(omegas), 1e-12),
        tests=tuple(o.test for o in observations) if all(o.test for o in observations) else (),
        sampling=1.0 / min(steps) if max(steps) > 1.05 * min(steps) else 0.0,
    )


def force_columns(rows: RecordRows, terms: Sequence[FittedTerm]) -> Array:
    """Return rows (K, R) of terms that add a force, with their coefficients, in one record."""
    result = np.empty((len(terms), rows.target.size))
    for on_cycle in (True, False):
        chosen = [k for k, t in enumerate(terms) if _on_cycle(rows, t) is on_cycle]
        if not chosen:
            continue
        motion = rows.cycle if on_cycle and rows.cycle is not None else rows.motion
        forces = np.stack([terms[k].coefficient * unit(terms[k], motion) for k in chosen])
        if on_cycle and rows.cycle_rows is not None:
            result[chosen] = forces @ rows.cycle_rows
        else:
            result[chosen] = rows.of_motion(forces)
    return result


def _on_cycle(rows: RecordRows, fitted: FittedTerm) -> bool:
    return rows.cycle is not None and fitted.term.remembers(fitted.shape) != "time"


def moved(
    term: Term, shape: dict[str, float], name: str, scales: Scales
) -> tuple[dict[str, float], float]:
    """Return a shape with one parameter a little further inside its bounds, and the step."""
    parameter = next(p for p in term.parameters if p.name == name)
    size = scales.size(parameter.scaled_by)
    value = shape[name]
    if parameter.spacing == "log":
        step = _STEP * value
    else:
        step = _STEP * (parameter.upper - parameter.lower) * size
    if value + step > parameter.upper * size:
        step = -step
    return {**shape, name: value + step}, step


def finite_slope(change: Array) -> Array:
    """Return a slope in rows, 0 where it is too steep to have a square: it tells nothing there."""
    return np.where(np.abs(change) < _STEEPEST, change, 0.0)


@dataclass(frozen=True)
class Behind:
    """Columns of terms as changes of motion and of force pass them on: their slopes there."""

    models: Mapping[str, ForceModel]
    """All that holds in each record, changes among it; by the records' files."""
    forces: Mapping[str, RecordForces]
    """What evaluates them, likewise."""

    def __call__(self, rows: RecordRows, terms: Sequence[FittedTerm]) -> Array:
        """Return the rows (K, R) of terms in a record, with their coefficients."""
        model, forces = self.models[rows.file], self.forces[rows.file]
        found = np.empty((len(terms), rows.target.size))
        adding = [k for k, t in enumerate(terms) if t.term.acts == "force"]
        with np.errstate(over="ignore", invalid="ignore"):  # of next to nothing a step is huge
            found[adding] = forces.passed_on(model, [terms[k] for k in adding])
            if len(adding) < len(terms):
                before = forces.of_model(model)
            for k, t in enumerate(terms):
                if t.term.acts != "force":
                    found[k] = (forces.of_model(_grown(model, t, _STEP)) - before) / _STEP
        return finite_slope(found)


def _grown(model: ForceModel, fitted: FittedTerm, step: float) -> ForceModel:
    """Return a model in which a change has grown by a step of its unit's size."""
    terms = []
    for t in model.terms:
        if t.id == fitted.id and t.shape == fitted.shape:
            t = FittedTerm(t.id, t.coefficient + step * fitted.coefficient, t.shape)
        terms.append(t)
    return ForceModel(tuple(terms))

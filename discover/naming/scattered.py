"""A joint's shape sought over all of its range, on samples: its impacts make many hollows.

A fit's steps end in the next hollow. Scattered shapes are ranked by what they leave in the records
with the greatest misfits, and the best are evolved (differential evolution, Storn and Price 1997).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import Bounds, differential_evolution
from scipy.stats import qmc

from discover.naming.columns import span_of, without_basis
from discover.naming.fit import ModelFit, fit_model, free_parameters
from discover.naming.rows import RecordRows
from discover.naming.scales import Scales, scales_of
from discover.naming.unit_rows import UnitRows
from models.checks import Array
from models.constitutive import FittedTerm, ForceModel
from models.terms import Shape

_NEAR = {  # factors of what a fit found, either way
    "contact": 6.0, "gap": 1.5, "limit": 1.35, "softness": 3.0,
}
_LOSSES = (0.02, 1.0)
_LAGS = (0.01, 0.5)  # of a valve, over the greatest angular frequency
_VALVES = (0.03, 3.0)  # its resistance, of the limit over the greatest speed
_AT_ONCE = 0.3  # of the shapes, that a valve closes without a lag in, or lets through freely
_SCATTERED = (9, 10)  # power of two, of shapes: of a joint without and with a valve
_EVOLVED = (24, 32)
_GENERATIONS = (15, 40)
_RANK_ON, _EVOLVE_ON = 2, 4  # records
_STEPS = 6
_ENOUGH = 0.003
_SHAKEN = 1e300  # chi-square where a joint shook itself apart


def scattered(
    samples: Sequence[RecordRows],
    fit: ModelFit,
    telling: Sequence[int] | NDArray[np.intp],
    *,
    seed: int = 0,
) -> ModelFit:
    """Return the better of a fit and one whose joint was sought over all of its range.

    Parameters
    ----------
    samples : sequence of RecordRows
        The records' samples as rows.
    fit : ModelFit
        Its last term is the joint.
    telling : sequence of int
        Records that tell most, that first.
    seed : int
        Of the shapes that are tried.
    """
    *rest, joint = fit.model.terms
    if not joint.shape.get("contact", 0.0):
        return fit
    box = _Box.around(joint, scales_of([r.observation for r in samples]))
    seen = [samples[i] for i in telling[:_EVOLVE_ON]]
    units = UnitRows()

    def model(point: Array) -> ForceModel:
        return ForceModel((*rest, FittedTerm(joint.id, 1.0, box.shape(point))), fit.model.name)

    few = unexplained(seen[:_RANK_ON], rest, units)
    more = unexplained(seen, rest, units)

    def cost(point: Array) -> float:
        return more(model(point))

    valve = int(bool(box.valves))
    points = qmc.Sobol(box.size, seed=seed).random_base2(_SCATTERED[valve])
    first = np.array([few(model(p)) for p in points])
    best = np.concatenate([[box.centre], points[np.argsort(first)[: _EVOLVED[valve] - 1]]])
    evolved = differential_evolution(
        cost, Bounds(np.zeros(box.size), np.ones(box.size)), maxiter=_GENERATIONS[valve], init=best,
        polish=False, tol=0.0, seed=seed,
    )
    other = model(evolved.x)
    found = fit_model(
        samples, other, free_parameters(other), iterations=_STEPS, enough=_ENOUGH, units=units,
        exact=False,
    )
    return found if found.chi2 < fit_model(samples, fit.model, (), units=units).chi2 else fit


def unexplained(
    rows: Sequence[RecordRows], terms: Sequence[FittedTerm], units: UnitRows
) -> Callable[[ForceModel], float]:
    """Return what tells the chi-square of a model with `terms`, whose added forces may change."""
    added = [units.of_all(rows, t) for t in terms if t.term.acts == "force"]
    basis = span_of(np.stack(added)) if added else np.zeros((0, 0))

    def left(model: ForceModel) -> float:
        found = without_basis(fit_model(rows, model, (), units=units).residual[None], basis)
        return float(np.nan_to_num(np.sum(found**2), nan=_SHAKEN, posinf=_SHAKEN))

    return left


@dataclass(frozen=True)
class _Box:
    """The shapes that are tried, as points of a unit cube."""

    joint: FittedTerm
    """In the middle."""
    names: tuple[str, ...]
    """Of the shape's parameters, in the cube's order."""
    valves: Mapping[str, tuple[float, float]]
    """Least and greatest of those that may be 0 besides."""

    @classmethod
    def around(cls, joint: FittedTerm, scales: Scales) -> _Box:
        """Return the box around a joint."""
        names = [*(n for n in _NEAR if joint.shape.get(n, 0.0) > 0.0), "loss"]
        valves = {}
        if joint.shape.get("refill", 0.0) > 0.0:
            resistance = joint.shape["limit"] / scales.speed
            valves["lag"] = _LAGS[0] / scales.omega, _LAGS[1] / scales.omega
            valves["valve"] = _VALVES[0] * resistance, _VALVES[1] * resistance
        return cls(joint, (*names, *valves), valves)

    @property
    def size(self) -> int:
        """Dimensions."""
        return len(self.names)

    @property
    def centre(self) -> Array:
        """(D,) the point of the joint itself."""
        return np.array([self._place(name) for name in self.names])

    def _place(self, name: str) -> float:
        value = self.joint.shape[name]
        if name == "loss":
            low, high = _LOSSES
            return float(np.clip((value - low) / (high - low), 0.0, 1.0))
        if name in self.valves:
            if value == 0.0:
                return 0.0
            low, high = np.log(self.valves[name])
            share = (np.log(value) - low) / (high - low)
            return float(np.clip(_AT_ONCE + (1.0 - _AT_ONCE) * share, _AT_ONCE, 1.0))
        return 0.5

    def shape(self, point: Array) -> Shape:
        """Return the shape at a point (D,)."""
        found = dict(self.joint.shape)
        for name, place in zip(self.names, point, strict=True):
            if name == "loss":
                found[name] = float(_LOSSES[0] + place * (_LOSSES[1] - _LOSSES[0]))
            elif name in self.valves:
                low, high = np.log(self.valves[name])
                share = (place - _AT_ONCE) / (1.0 - _AT_ONCE)
                found[name] = float(np.exp(low + share * (high - low))) if share > 0.0 else 0.0
            else:
                found[name] *= float(_NEAR[name] ** (2.0 * place - 1.0))
        return found

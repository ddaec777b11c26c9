"""The four structures as a plan of tests meets them before any fit: terms, and a nominal force."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy.optimize import minimize_scalar

from discover.data_check.plan import Plan
from discover.regression.least_squares import solve
from models.checks import Array
from models.constitutive import FittedTerm
from models.cores import CORES, FRICTION
from models.terms import TERMS

TELLING = math.log(20.0)
"""Nats from which a structure can be ruled out at 5 %."""

_SHAPES = 41  # at which a free shape is tried, before it is refined
_STEP = 1e-4  # of a shape, for its slope


@dataclass(frozen=True)
class Structure:
    """A structure of a plan: one of its variants, with friction."""

    name: str
    """As documents state it."""
    ids: tuple[str, ...]
    """Of its terms, friction last."""
    bounds: tuple[float, float] | None
    """Of the shape of its first term, where that is free."""

    @property
    def nominal(self) -> float | None:
        """Shape that the first term is given before it is fitted: three quarters up its range."""
        if self.bounds is None:
            return None
        low, high = self.bounds
        return low + 0.75 * (high - low)

    def terms(self, shape: float | None) -> list[FittedTerm]:
        """Return its terms, of coefficient one."""
        found = [FittedTerm(i, 1.0) for i in self.ids]
        if shape is not None:
            name = TERMS[self.ids[0]].parameters[0].name
            found[0] = FittedTerm(self.ids[0], 1.0, {name: shape})
        return found

    def slopes(self, plan: Plan) -> Array:
        """Return the change (R, P) of its nominal force with each number, each term's own size."""
        columns = plan.columns(self.terms(self.nominal))
        if self.nominal is None:
            return columns
        moved = plan.columns(self.terms(self.nominal - _STEP))[:, :1]
        return np.column_stack([columns, (columns[:, :1] - moved) / _STEP])

    def force(self, plan: Plan) -> Array:
        """Return a nominal force (R,): its terms but friction alike, as large as measured."""
        columns = plan.columns(self.terms(self.nominal))[:, :-1]
        size = np.linalg.norm(columns, axis=0)
        total = np.sum(columns[:, size > 0.0] / size[size > 0.0], axis=1)
        length = float(np.linalg.norm(total))
        return np.asarray(plan.size / length * total if length > 0.0 else total)

    def coefficients(self, plan: Plan) -> list[FittedTerm]:
        """Return the terms of its nominal force with their coefficients."""
        columns = plan.columns(self.terms(self.nominal))[:, :-1]
        values, _ = solve(columns, self.force(plan))
        return [
            FittedTerm(t.id, float(v), t.shape)
            for t, v in zip(self.terms(self.nominal)[:-1], values, strict=True)
        ]

    def gap_to(self, force: Array, plan: Plan) -> float:
        """Return half its squared misfit to a force (R,) over the noise, nats."""
        if self.bounds is None:
            return 0.5 * solve(plan.columns(self.terms(None)), force)[1]
        low, high = self.bounds

        def misfit(shape: float) -> float:
            return 0.5 * solve(plan.columns(self.terms(float(shape))), force)[1]

        values = np.linspace(low, high, _SHAPES)
        found = [misfit(float(v)) for v in values]
        best = int(np.argmin(found))
        around = float(values[max(best - 1, 0)]), float(values[min(best + 1, _SHAPES - 1)])
        refined = minimize_scalar(misfit, bounds=around, method="bounded")
        return min(float(refined.fun), found[best])


def structures() -> tuple[Structure, ...]:
    """Return the named structures, each with one optional term at most, and friction."""
    found = []
    for core in CORES:
        if not core.required:
            continue
        ids = (*core.required, *core.optional[:1], FRICTION)
        first = TERMS[core.required[0]]
        shaped = bool(first.parameters) and first.parameters[0].fitted
        bounds = (first.parameters[0].lower, first.parameters[0].upper) if shaped else None
        found.append(Structure(core.name, ids, bounds))
    return tuple(found)


def contains(larger: Structure, smaller: Structure) -> bool:
    """Return whether every force of `smaller` is one of `larger` too."""
    return set(smaller.ids) <= set(larger.ids)

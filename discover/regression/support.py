"""Weighted least squares on a chosen set of terms, with at most two continuous shapes.

The shapes are profiled out (variable projection): for every trial value the linear problem is
solved exactly, on a triangle, so a fit costs microseconds whatever the number of samples.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from scipy.optimize import minimize

from discover.library.dictionary import DELAY, Dictionary
from discover.library.family import Family
from discover.triangle import Triangle
from models.checks import Array, InputError
from models.constitutive import FittedTerm
from models.terms import TERMS

_GRID = 61
_FINE = 17
_REFINEMENTS = 3
_TINY = 1e-12
_NEVER_NEGATIVE = {"stiffness", *(i for i, t in TERMS.items() if t.nonnegative)}
"""A negative stiffness is an inertance in disguise where frequencies are few."""
MOST_DELAY = 5e-3  # s: channels of one rig are not further apart; more is memory of the device
SAME_SHAPE = 0.05
"""Closer than this to a plain term's shape, two columns differ by little but their slope."""
PLAIN_SHAPES: dict[str, dict[float, str]] = {
    "fractional-derivative": {0.0: "stiffness", 1.0: "viscous-damping", 2.0: "inertia"},
    "power-law-damping": {1.0: "viscous-damping", 2.0: "quadratic-damping"},
}
"""Shapes at which a family is a plain term."""


@dataclass(frozen=True)
class Support:
    """Which terms stand in a fit: fixed columns, and families with a free or a fixed shape."""

    plain: tuple[str, ...]
    """Ids of fixed columns."""
    free: tuple[str, ...] = ()
    """Ids of families whose shape is fitted; at most two."""
    fixed: tuple[tuple[str, float], ...] = ()
    """Families with a shape that is given."""

    @property
    def ids(self) -> tuple[str, ...]:
        """All ids, those with a shape first."""
        return (*self.free, *(i for i, _ in self.fixed), *self.plain)

    @property
    def parameters(self) -> int:
        """Number of fitted numbers."""
        return len(self.plain) + 2 * len(self.free) + len(self.fixed)


@dataclass(frozen=True)
class SupportFit:
    """Least squares on a support."""

    support: Support
    """The terms."""
    shapes: tuple[float, ...]
    """Shape of each family, free ones first."""
    coefficients: Array
    """(k,) of the columns, in the order of `Support.ids`, in the dictionary's scaling."""
    chi2: float
    """Whitened squared misfit, ||R c - y||^2."""
    valid: bool
    """False where a coefficient that can't be negative is."""
    weights: Array = field(repr=False)
    """(K, k): the fit's columns as combinations of the dictionary's."""
    shares: Array = field(repr=False)
    """(k,) norm of each term's force over that of the measured force."""

    @property
    def combined(self) -> Array:
        """(K,) coefficients on the dictionary's columns."""
        result: Array = self.weights @ self.coefficients
        return result


def _unit(identifier: str, dictionary: Dictionary) -> Array:
    vector = np.zeros(dictionary.size)
    vector[dictionary.index(identifier)] = 1.0
    return vector


def _family(identifier: str, dictionary: Dictionary) -> tuple[Family, slice]:
    found = dictionary.family(identifier)
    if found is None:
        raise InputError("term", expected="in the library", found=identifier)
    return found


def _shaped(identifier: str, value: float, dictionary: Dictionary) -> Array:
    family, where = _family(identifier, dictionary)
    vector = np.zeros(dictionary.size)
    vector[where] = family.weights(value)[:, 0]
    return vector


def _signs_hold(ids: Sequence[str], coefficients: Array) -> bool:
    return all(
        abs(c) <= MOST_DELAY if i == DELAY else i not in _NEVER_NEGATIVE or c >= 0.0
        for i, c in zip(ids, coefficients, strict=True)
    )


def _distinct(support: Support, shapes: tuple[float, ...]) -> bool:
    """Return False where a free shape sits on a term of integer order that is there already."""
    return not any(
        plain in support.plain and abs(shape - value) < SAME_SHAPE
        for identifier, shape in zip(support.free, shapes, strict=True)
        for value, plain in PLAIN_SHAPES[identifier].items()
    )


def solve(columns: Array, target: Array) -> tuple[Array, float]:
    """Return coefficients and squared misfit of a small least-squares problem.

    Columns are scaled to unit length first; a column that adds nothing gets a coefficient of
    the least norm.
    """
    norms = np.linalg.norm(columns, axis=0)
    norms[norms == 0.0] = 1.0
    coefficients = np.linalg.lstsq(columns / norms, target, rcond=1e-13)[0] / norms
    misfit = target - columns @ coefficients
    return coefficients, float(misfit @ misfit)


def _without_reversal(triangle: Triangle, dictionary: Dictionary) -> Triangle:
    """Return the triangle with the curve of reversal marginalised.

    Its coefficients have a normal law of mean zero beforehand; eliminating them by QR, together
    with rows that say so, leaves the least-squares problem of all other columns.
    """
    where = dictionary.reversal_positions
    count = where.stop - where.start
    if not count:
        return triangle
    others = np.delete(triangle.matrix, where, axis=1)
    stacked = np.column_stack([triangle.matrix[:, where], others])
    prior = np.zeros((count, stacked.shape[1]))
    prior[:, :count] = np.eye(count) * triangle.unit / dictionary.reversal_scale
    reduced = np.asarray(np.linalg.qr(np.concatenate([prior, stacked]), mode="r"))[count:, count:]
    matrix = np.insert(reduced, [where.start] * count, 0.0, axis=1)
    return replace(triangle, matrix=matrix)


class ProfiledFit:
    """Fits of many supports on one triangle."""

    def __init__(self, triangle: Triangle, dictionary: Dictionary) -> None:
        self.triangle = _without_reversal(triangle, dictionary)
        self.dictionary = dictionary
        self.energy = float(self.triangle.target @ self.triangle.target)

    def _without(self, identifier: str, base: Array) -> tuple[Array, Array, Array]:
        """Return a family's nodes' columns and the target with the base taken out, reduced.

        The reduced columns (n, n) and target (n,) have the products of the full ones; the last
        value is the target's misfit that no member of the family can change.
        """
        _, where = _family(identifier, self.dictionary)
        both = np.column_stack([self.triangle.columns[:, where], self.triangle.target])
        if base.shape[1]:
            norms = np.linalg.norm(base, axis=0)
            q, _ = np.linalg.qr(base / np.where(norms > 0.0, norms, 1.0))
            both = both - q @ (q.T @ both)
        reduced = np.asarray(np.linalg.qr(both, mode="r"))
        count = both.shape[1] - 1
        return reduced[:count, :count], reduced[:count, count], reduced[count:, count]

    def profile(self, identifier: str, base: Array) -> tuple[Array, Array]:
        """Return trial shapes (G,) and the squared misfit beside base columns (m, k) at each."""
        family, _ = _family(identifier, self.dictionary)
        values = np.linspace(family.lower, family.upper, _GRID)
        return values, _misfits(family, values, *self._without(identifier, base))

    def fit(self, support: Support) -> SupportFit:
        """Return the least-squares fit of a support.

        Raises
        ------
        InputError
            For more than two free shapes, or a term that the dictionary does not hold.
        """
        if len(support.free) > 2:
            raise InputError("free shapes", expected="at most two", found=f"{len(support.free)}")
        base_weights = [_shaped(i, v, self.dictionary) for i, v in support.fixed]
        base_weights += [_unit(i, self.dictionary) for i in support.plain]
        stacked = np.array(base_weights).T if base_weights else np.empty((self.dictionary.size, 0))
        base = self.triangle.columns @ stacked
        shapes = self._search(support.free, base)
        return self._at(support, shapes, stacked)

    def at(self, support: Support, shapes: Sequence[float]) -> SupportFit:
        """Return the linear fit with the free shapes held."""
        base_weights = [_shaped(i, v, self.dictionary) for i, v in support.fixed]
        base_weights += [_unit(i, self.dictionary) for i in support.plain]
        stacked = np.array(base_weights).T if base_weights else np.empty((self.dictionary.size, 0))
        return self._at(support, tuple(shapes), stacked)

    def _at(self, support: Support, shapes: tuple[float, ...], stacked: Array) -> SupportFit:
        shaped = [_shaped(i, v, self.dictionary) for i, v in zip(support.free, shapes, strict=True)]
        weights = np.column_stack([*shaped, stacked]) if shaped else stacked
        if weights.shape[1] == 0:
            empty = np.empty(0)
            return SupportFit(
                support, (), empty, self.energy, valid=True, weights=weights, shares=empty
            )
        columns = self.triangle.columns @ weights
        coefficients, chi2 = solve(columns, self.triangle.target)
        shares = np.linalg.norm(columns, axis=0) * np.abs(coefficients)
        shares /= np.sqrt(max(self.energy, 1e-300))
        valid = _signs_hold(support.ids, coefficients) and _distinct(support, shapes)
        every = (*shapes, *(v for _, v in support.fixed))
        return SupportFit(support, every, coefficients, chi2, valid, weights, shares)

    def _search(self, free: tuple[str, ...], base: Array) -> tuple[float, ...]:
        if not free:
            return ()
        if len(free) == 1:
            return (self._search_one(free[0], base),)
        family, where = _family(free[0], self.dictionary)
        first_values = np.linspace(family.lower, family.upper, _GRID)
        first_columns = self.triangle.columns[:, where] @ family.weights(first_values)
        profiles = [
            self.profile(free[1], np.column_stack([base, column])) for column in first_columns.T
        ]
        table = np.array([misfit for _, misfit in profiles])
        second_values = profiles[0][0]
        i, j = np.unravel_index(int(table.argmin()), table.shape)
        start = np.array([first_values[i], second_values[j]])
        bounds = [(v[0], v[-1]) for v in (first_values, second_values)]

        def misfit_at(point: Array) -> float:
            shaped = [
                self.triangle.columns @ _shaped(f, float(p), self.dictionary)
                for f, p in zip(free, point, strict=True)
            ]
            return solve(np.column_stack([*shaped, base]), self.triangle.target)[1]

        best = minimize(
            misfit_at, start, method="Nelder-Mead", bounds=bounds, options={"xatol": 1e-5}
        )
        return (float(best.x[0]), float(best.x[1]))

    def _search_one(self, identifier: str, base: Array) -> float:
        """Return the best shape: a grid, refined three times around its least point."""
        family, _ = _family(identifier, self.dictionary)
        without = self._without(identifier, base)
        values = np.linspace(family.lower, family.upper, _GRID)
        misfit = _misfits(family, values, *without)
        for _ in range(_REFINEMENTS):
            g = int(misfit.argmin())
            low, high = values[max(g - 1, 0)], values[min(g + 1, values.size - 1)]
            values = np.linspace(low, high, _FINE)
            misfit = _misfits(family, values, *without)
        g = int(misfit.argmin())
        if 0 < g < values.size - 1:
            before, here, after = misfit[g - 1 : g + 2]
            curvature = before - 2.0 * here + after
            if curvature > 0.0:
                shift = 0.5 * (before - after) / curvature
                return float(values[g] + shift * (values[1] - values[0]))
        return float(values[g])


def _misfits(
    family: Family, values: Array, columns: Array, target: Array, rest: Array
) -> Array:
    """Return the squared misfit at each value of a family's shape, (G,)."""
    trial = columns @ family.weights(values)
    power = np.sum(trial**2, axis=0)
    least = _TINY * max(float(np.sum(columns**2)) / max(columns.shape[1], 1), 1e-300)
    gain = (target @ trial) ** 2 / np.maximum(power, least)
    return np.asarray(float(target @ target) + float(rest @ rest) - gain)


def fitted_terms(fit: SupportFit, dictionary: Dictionary) -> tuple[FittedTerm, ...]:
    """Return the fit's terms with SI coefficients (the delay excepted)."""
    result = []
    families = (*fit.support.free, *(i for i, _ in fit.support.fixed))
    for position, identifier in enumerate(fit.support.ids):
        value = float(fit.coefficients[position])
        if position < len(families):
            family, _ = _family(identifier, dictionary)
            shape = fit.shapes[position]
            si = value * family.reference**-shape
            result.append(FittedTerm(identifier, si, {family.parameter: shape}))
        elif identifier != DELAY:
            column = dictionary.columns[dictionary.index(identifier)]
            result.append(FittedTerm(identifier, value, dict(column.shape)))
    return tuple(result)

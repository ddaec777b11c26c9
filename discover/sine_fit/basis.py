"""The linear part of a sine fit: mean, harmonics and a trend by least squares."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Self

import numpy as np

from discover.sine_fit.columns import Columns, columns_of
from discover.sine_fit.design import ComplexArray, harmonic_design
from discover.sine_fit.harmonic_sums import Harmonics
from discover.sine_fit.moments import Moments
from models.checks import Array

_APART = 1e-3  # of the greatest eigenvalue, from which one solution is exact
_ALIKE = 1e-6  # likewise, up to which squares have lost too much


@dataclass(frozen=True)
class _Normal:
    """A normal matrix, and what solves it."""

    gram: Array
    """(C, C)."""
    norms: Array
    """(C,) of the columns."""
    spread: float
    """Least over greatest singular value's square, of columns of unit norm."""

    @classmethod
    def of(cls, gram: Array) -> Self:
        """Return a matrix with what is told of it."""
        norms = np.sqrt(np.diagonal(gram))
        values = np.linalg.eigvalsh(gram / np.outer(norms, norms))
        return cls(gram, norms, float(values[0] / values[-1]))

    @cached_property
    def inverse(self) -> Array:
        """(C, C)."""
        outer = np.outer(self.norms, self.norms)
        return np.asarray(np.linalg.inv(self.gram / outer) / outer)

    def solve(self, sums: Array) -> Array:
        """Return coefficients of products with the columns (C,), once refined."""
        found = self.inverse @ sums
        return np.asarray(found + self.inverse @ (sums - self.gram @ found))


class Basis:
    """Mean, harmonics and perhaps a trend at samples, as products alone: no column is formed."""

    def __init__(
        self, at: Moments, frequency: float, orders: tuple[int, ...], *, trend: bool
    ) -> None:
        self.at, self.frequency, self.orders, self.trend = at, frequency, orders, trend
        self.columns = columns_of(orders, trend=trend)
        self._harmonics = Harmonics(at, frequency)
        self._own = self._harmonics.own(2 * max(orders), powers=3)

    def solve(self, y: Array) -> tuple[Array, Array, Array]:
        """Return least-squares coefficients, the inverse normal matrix, and what is left of y (N,).

        Where columns are far from alike one pass over y tells all sums; where they are less so,
        what is left of y is fitted once more, and alike ones are formed.
        """
        return self._solved(y, None)

    def inverse(self, beta: Array) -> Array:
        """Return the inverse normal matrix with a column more: the derivative by frequency."""
        normal = self._normal(beta)
        if normal.spread > _ALIKE:
            return normal.inverse
        design = self._design(beta) / normal.norms
        return _pseudo_inverse(design)[1] / np.outer(normal.norms, normal.norms)

    def newton(self, y: Array) -> tuple[float, float]:
        """Return the square sum that coefficients leave of y, and the best step of frequency.

        In rad/s, by Gauss and Newton, with all coefficients eliminated.
        """
        normal = self._normal(None)
        if normal.spread <= _APART:
            beta, _, left = self._solved(y, None)
            return float(left @ left), float(self._solved(left, beta)[0][-1])
        sums = self._harmonics.sums(y[None], max(self.orders), powers=2)
        along = self.columns.along(sums)[0]
        beta = normal.solve(along)
        turning = self._normal(beta)
        if turning.spread <= _APART:
            left = y - self._fitted(beta, None)
            return float(left @ left), float(self._solved(left, beta)[0][-1])
        both = _last_as_one(self._turning(beta).along(sums)[0], self.columns.size)
        step = turning.solve(both - turning.gram[:, :-1] @ beta)[-1]
        return float(y @ y - beta @ along), float(step)

    def _solved(self, y: Array, beta: Array | None) -> tuple[Array, Array, Array]:
        """Return as `solve`, with a column more where `beta` is given."""
        columns, normal = self.columns if beta is None else self._turning(beta), self._normal(beta)
        if normal.spread <= _ALIKE:
            design = self._design(beta)
            solver, inverse = _pseudo_inverse(design / normal.norms)
            solution = solver @ y / normal.norms
            return solution, inverse / np.outer(normal.norms, normal.norms), y - design @ solution
        solution = normal.solve(self._along(columns, y))
        left = y - self._fitted(solution, beta)
        if normal.spread <= _APART:
            more = normal.solve(self._along(columns, left))
            solution, left = solution + more, left - self._fitted(more, beta)
        return solution, normal.inverse, left

    def _normal(self, beta: Array | None) -> _Normal:
        """Return the normal matrix, with a column more where `beta` is given."""
        columns = self.columns if beta is None else self._turning(beta)
        gram = columns.products(self._own)
        if beta is not None:
            gram = _last_as_one(_last_as_one(gram, self.columns.size).T, self.columns.size)
        return _Normal.of(gram)

    def _along(self, columns: Columns, y: Array) -> Array:
        """Return products of columns with a signal; beyond the basis' own they are one."""
        highest, powers = max(self.orders), 1 + int(columns.power.max())
        sums = self._harmonics.sums(y[None], highest, powers=powers)
        return _last_as_one(columns.along(sums)[0], self.columns.size)

    def _turning(self, beta: Array) -> Columns:
        """Return the columns, and those whose sum is the derivative by angular frequency."""
        k = np.array(self.orders)
        turning = Columns(k, np.ones_like(k), 1j * k * self._phasors(beta)[k])
        return self.columns.followed_by(turning)

    def _fitted(self, solution: Array, beta: Array | None) -> Array:
        """Return what coefficients make of the columns, (N,)."""
        size = self.columns.size
        fitted = self._harmonics.series(self._phasors(solution))
        if self.trend:
            fitted += solution[size - 1] * self.at.time
        if beta is not None:
            turning = 1j * np.arange(max(self.orders) + 1) * self._phasors(beta)
            fitted += solution[-1] * self.at.time * self._harmonics.series(turning)
        return fitted

    def _phasors(self, solution: Array) -> ComplexArray:
        phasors = np.zeros(max(self.orders) + 1, dtype=np.complex128)
        phasors[0] = solution[0]
        for i, k in enumerate(self.orders):
            phasors[k] = complex(solution[1 + 2 * i], solution[2 + 2 * i])
        return phasors

    def _design(self, beta: Array | None) -> Array:
        tau = self.at.time
        design = harmonic_design(tau, self.frequency, self.orders)
        parts = [design, tau[:, None]] if self.trend else [design]
        if beta is not None:
            parts.append(frequency_column(tau, design, beta, self.orders)[:, None])
        return np.concatenate(parts, axis=1)


def _pseudo_inverse(design: Array) -> tuple[Array, Array]:
    """Return the pseudo-inverse (C, N) of columns, and its product with its own transpose."""
    u, s, vt = np.linalg.svd(design, full_matrices=False)
    s = np.maximum(s, 1e-13 * s[0])
    return (vt.T / s) @ u.T, (vt.T / s**2) @ vt


def _last_as_one(values: Array, size: int) -> Array:
    """Return rows (C, ...) of which those from `size` on, where there are any, are added up."""
    if values.shape[0] == size:
        return values
    return np.concatenate([values[:size], values[size:].sum(axis=0, keepdims=True)])


def frequency_column(tau: Array, design: Array, beta: Array, orders: Sequence[int]) -> Array:
    """Return the derivative of the fit by angular frequency."""
    column = np.zeros(tau.size)
    for i, k in enumerate(orders):
        cosine, minus_sine = design[:, 1 + 2 * i], design[:, 2 + 2 * i]
        column += k * (beta[1 + 2 * i] * minus_sine - beta[2 + 2 * i] * cosine)
    return np.asarray(column * tau)

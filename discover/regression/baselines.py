"""What named sparse regressions say on the same columns: pysindy's STLSQ, SR3 and SSR.

They can't hold a shape continuous, so orders and exponents stand on a grid. Each method gets its
best chance: unit columns and target, a scan over its thresholds and regularisation, plain least
squares on every support that it visits, and the support of least Bayesian information criterion.
The verdict does not use them.

References: S. L. Brunton et al., *PNAS* 113 (2016) 3932-3937 (STLSQ); K. Champion et al., *IEEE
Access* 8 (2020) 169259-169271 (SR3); L. Boninsegna et al., *J. Chem. Phys.* 148 (2018) 241723
(SSR).
"""

from __future__ import annotations

import time
import warnings
from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike
from pysindy.optimizers import SR3, SSR, STLSQ

from discover.figure_data import BaselineAnswer
from discover.library.dictionary import DELAY, Column, Dictionary
from discover.regression.support import solve
from discover.triangle import Triangle
from models.checks import Array, finite_array

ORDER_GRID = np.linspace(0.0, 2.0, 21)
"""Orders of the grid: 0, 0.1, ..., 2."""
EXPONENT_GRID = np.linspace(0.5, 3.0, 11)
"""Exponents of the grid: 0.5, 0.75, ..., 3."""
_THRESHOLDS = np.geomspace(1e-3, 1.0, 19)
_RIDGES = (1e-8, 1e-4, 1e-2)
_RELAXATIONS = (1.0, 1e2, 1e4)
_SR3_STEPS = 100
_SAME = 1e-8  # of 1 - |cosine|: columns that are one and the same
_TINY = 1e-26  # of the energy: a misfit below it is zero


@dataclass(frozen=True)
class _Candidates:
    """Unit columns on a grid, with what brings coefficients back to SI."""

    labels: tuple[str, ...]
    """(C,) of each column."""
    units: Array
    """(m, C) columns of unit length."""
    scales: Array
    """(C,) SI coefficient over the coefficient of the unit column."""
    target: Array
    """(m,) of unit length, or zero."""
    rows: int
    """Number of rows that the triangle stands for."""
    size: float
    """Length of the target before, in the triangle's units."""


def _label(column: Column) -> str:
    shape = ", ".join(f"{value:.3g}" for _, value in column.shape if value)
    return f"{column.id} ({shape})" if shape else column.id


def _candidates(
    triangle: Triangle, dictionary: Dictionary, order_grid: Array, exponent_grid: Array
) -> _Candidates:
    grids = {"order": order_grid, "exponent": exponent_grid}
    labels = [_label(c) for c in dictionary.columns]
    columns = [triangle.columns[:, i] for i in range(len(labels))]
    factors = [1.0] * len(labels)
    for family in dictionary.families:
        found = dictionary.family(family.id)
        values = grids[family.parameter]
        values = values[(values >= family.lower) & (values <= family.upper)]
        if found is None or not values.size:
            continue
        columns.extend((triangle.columns[:, found[1]] @ family.weights(values)).T)
        labels.extend(f"{family.id} {value:.4g}" for value in values)
        factors.extend(family.reference**-values)
    if dictionary.delay:
        labels.append(DELAY)
        columns.append(triangle.columns[:, -1])
        factors.append(1.0)
    lengths = np.array([float(np.linalg.norm(c)) for c in columns])
    kept: list[int] = []
    units: list[Array] = []
    for i, (column, length) in enumerate(zip(columns, lengths, strict=True)):
        # pysindy raises on a zero column, and splits one coefficient between equal columns.
        if not (np.isfinite(length) and length > 0.0):
            continue
        unit = column / length
        if all(abs(unit @ other) < 1.0 - _SAME for other in units):
            kept.append(i)
            units.append(unit)
    size = float(np.linalg.norm(triangle.target))
    return _Candidates(
        tuple(labels[i] for i in kept),
        np.array(units).T if units else np.empty((triangle.target.size, 0)),
        np.array([factors[i] / lengths[i] for i in kept]) * size,
        triangle.target / (size or 1.0),
        triangle.rows,
        size,
    )


Supports = Iterator[Array]


def _stlsq(candidates: _Candidates) -> Supports:
    for ridge in _RIDGES:
        for threshold in _THRESHOLDS:
            model = STLSQ(threshold=threshold, alpha=ridge, max_iter=50, unbias=False)
            yield model.fit(candidates.units, candidates.target).coef_[0]


def _sr3(candidates: _Candidates) -> Supports:
    # From its default start, least squares on all columns, collinear ones never come down.
    start = np.zeros((1, candidates.units.shape[1]))
    for relaxation in _RELAXATIONS:
        for threshold in _THRESHOLDS:
            model = SR3(
                reg_weight_lam=SR3.calculate_l0_weight(threshold, relaxation),
                relax_coeff_nu=relaxation,
                regularizer="l0",
                max_iter=_SR3_STEPS,
                initial_guess=start,
            )
            yield model.fit(candidates.units, candidates.target).coef_[0]


def _ssr(candidates: _Candidates) -> Supports:
    for ridge in _RIDGES:
        # kappa = 0 keeps off pysindy's own choice on the path, which fails on short ones.
        model = SSR(alpha=ridge, max_iter=candidates.units.shape[1], kappa=0.0, unbias=False)
        model.fit(candidates.units, candidates.target)
        for coefficients in model.history_:
            yield np.asarray(coefficients)[0]


_METHODS: tuple[tuple[str, Callable[[_Candidates], Supports]], ...] = (
    ("STLSQ", _stlsq),
    ("SR3", _sr3),
    ("SSR", _ssr),
)


def _best(candidates: _Candidates, supports: Supports) -> tuple[tuple[int, ...], Array, float]:
    """Return columns, coefficients and squared misfit of the support of least criterion."""
    rows = float(max(candidates.rows, 2))
    best: tuple[float, tuple[int, ...], Array, float] = (np.inf, (), np.empty(0), np.inf)
    seen = set()
    for coefficients in supports:
        support = tuple(int(i) for i in np.flatnonzero(np.abs(coefficients) > 0.0))
        if not support or support in seen or not np.isfinite(coefficients).all():
            continue
        seen.add(support)
        refit, misfit = solve(candidates.units[:, list(support)], candidates.target)
        score = rows * np.log(max(misfit, _TINY)) + len(support) * np.log(rows)
        if score < best[0]:
            best = (float(score), support, refit, misfit)
    return best[1:]


def _answer(
    method: str, search: Callable[[_Candidates], Supports], candidates: _Candidates, band: int
) -> BaselineAnswer:
    begin = time.perf_counter()
    try:
        with warnings.catch_warnings(), np.errstate(all="ignore"):
            warnings.simplefilter("ignore")  # thresholds that remove every term, slow convergence
            support, coefficients, misfit = _best(candidates, search(candidates))
    except Exception:  # a comparison that fails inside pysindy must not stop a study
        support, coefficients, misfit = (), np.empty(0), np.inf
    seconds = time.perf_counter() - begin
    if not support or candidates.size == 0.0:
        return BaselineAnswer(method, band, (), None, seconds)
    values = coefficients * candidates.scales[list(support)]
    terms = tuple((candidates.labels[i], float(v)) for i, v in zip(support, values, strict=True))
    return BaselineAnswer(method, band, terms, 100.0 * float(np.sqrt(misfit)), seconds)


def baseline_answers(
    triangle: Triangle,
    dictionary: Dictionary,
    *,
    order_grid: ArrayLike = ORDER_GRID,
    exponent_grid: ArrayLike = EXPONENT_GRID,
    band: int = 0,
) -> tuple[BaselineAnswer, ...]:
    """Return what STLSQ, SR3 and SSR say on a band's columns.

    Parameters
    ----------
    triangle : Triangle
        Of the band's rows; the relative error is in its metric, so for one that pools records by
        their force give a triangle whose rows are over that force.
    dictionary : Dictionary
        Of its columns. Fixed columns and the delay stand as they are.
    order_grid, exponent_grid : array_like
        Trial shapes of the families; those outside a family's range are left out, and those that
        make a column that stands already (order 1 beside viscous damping).
    band : int
        Index that the answers carry.

    Returns
    -------
    tuple of BaselineAnswer
        One for each method, with SI coefficients of plain least squares on its support. A method
        that finds no model or fails has no terms and no error; nothing is raised or warned.
    """
    orders = finite_array("order_grid", order_grid, ndim=1, min_size=0)
    exponents = finite_array("exponent_grid", exponent_grid, ndim=1, min_size=0)
    candidates = _candidates(triangle, dictionary, orders, exponents)
    return tuple(_answer(name, search, candidates, band) for name, search in _METHODS)

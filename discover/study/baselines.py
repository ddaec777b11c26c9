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
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from discover.figure_data import BaselineAnswer
from discover.regression.least_squares import solve
from discover.rows import RecordRows
from discover.rows.columns import force_columns
from discover.shape_words import shape
from discover.words import short_name
from models.checks import Array
from models.constitutive import FittedTerm

ORDER_GRID = np.linspace(0.0, 2.0, 21)
"""Orders of the grid: 0, 0.1, ..., 2."""
EXPONENT_GRID = np.linspace(0.5, 3.0, 11)
"""Exponents of the grid: 0.5, 0.75, ..., 3."""
_PLAIN = (
    "inertia", "viscous-damping", "quadratic-damping", "stiffness", "cubic-stiffness",
    "force-offset", "asymmetric-damping",
)  # fmt: skip
_THRESHOLDS = np.geomspace(1e-3, 1.0, 19)  # of STLSQ and SR3, as columns and force have length one
_RIDGES = (1e-8, 1e-4, 1e-2)  # of STLSQ and SSR
_RELAXATIONS = (1.0, 1e2, 1e4)  # of SR3
_SR3_STEPS = 100  # at most
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
    """Their number of rows."""
    size: float
    """Length of the target before."""


def candidate_terms(friction: Sequence[FittedTerm]) -> list[FittedTerm]:
    """Return the terms among which each method chooses, with friction's curves as they are given.

    Those that are another term's, as order 1 is viscous damping, come after it.
    """
    terms = [FittedTerm(i, 1.0) for i in _PLAIN]
    terms += [FittedTerm(t.id, 1.0, t.shape) for t in friction]
    terms += [FittedTerm("fractional-derivative", 1.0, {"order": float(a)}) for a in ORDER_GRID]
    terms += [FittedTerm("power-law-damping", 1.0, {"exponent": float(p)}) for p in EXPONENT_GRID]
    return terms


def label(fitted: FittedTerm) -> str:
    """Return a term's name in answers, with its shape."""
    told = shape({"id": fitted.id, **fitted.shape})
    return f"{short_name(fitted.id)} ({told})" if told else short_name(fitted.id)


def _candidates(rows: Sequence[RecordRows], terms: Sequence[FittedTerm]) -> _Candidates:
    """Return the columns of terms over each record's own force, those that repeat left out."""
    sizes = [float(np.linalg.norm(r.target)) or 1.0 for r in rows]
    whole = np.concatenate(
        [force_columns(r, terms) / s for r, s in zip(rows, sizes, strict=True)], axis=1
    )
    target = np.concatenate([r.target / s for r, s in zip(rows, sizes, strict=True)])
    kept: list[int] = []
    units: list[Array] = []
    lengths = np.linalg.norm(whole, axis=1)
    for i, (column, length) in enumerate(zip(whole, lengths, strict=True)):
        # pysindy raises on a zero column, and splits one coefficient between equal columns.
        if not (np.isfinite(length) and length > 0.0):
            continue
        unit = column / length
        if all(abs(unit @ other) < 1.0 - _SAME for other in units):
            kept.append(i)
            units.append(unit)
    size = float(np.linalg.norm(target))
    return _Candidates(
        tuple(label(terms[i]) for i in kept),
        np.array(units).T if units else np.empty((target.size, 0)),
        np.array([1.0 / lengths[i] for i in kept]) * size,
        target / (size or 1.0),
        target.size,
        size,
    )


Supports = Iterator[Array]


def _stlsq(candidates: _Candidates) -> Supports:
    from pysindy.optimizers import STLSQ  # loaded here: pictures of a study alone need it

    for ridge in _RIDGES:
        for threshold in _THRESHOLDS:
            model = STLSQ(threshold=threshold, alpha=ridge, max_iter=50, unbias=False)
            yield model.fit(candidates.units, candidates.target).coef_[0]


def _sr3(candidates: _Candidates) -> Supports:
    from pysindy.optimizers import SR3

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
    from pysindy.optimizers import SSR

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
    rows: Sequence[RecordRows], friction: Sequence[FittedTerm], *, band: int = 0
) -> tuple[BaselineAnswer, ...]:
    """Return what STLSQ, SR3 and SSR say on a band's columns.

    Parameters
    ----------
    rows : sequence of RecordRows
        Of the band's records; each counts by its own force.
    friction : sequence of FittedTerm
        Curves by which friction was found to reverse: they stand among the columns.
    band : int
        Index that the answers carry.

    Returns
    -------
    tuple of BaselineAnswer
        One for each method, with SI coefficients of plain least squares on its support. A method
        that finds no model or fails has no terms and no error; nothing is raised or warned.
    """
    unit = _candidates(rows, candidate_terms(friction))
    return tuple(_answer(name, search, unit, band) for name, search in _METHODS)

"""Standard errors and intervals of a fit: linear coefficients and shapes together."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq
from scipy.stats import t as student

from discover.library.dictionary import Dictionary
from discover.regression.support import ProfiledFit, SupportFit, _family
from models.checks import Array


@dataclass(frozen=True)
class Uncertainty:
    """Standard errors and 95 % intervals of a fit, in SI."""

    std_errors: Array
    """(k,) of the coefficients."""
    intervals: Array
    """(k, 2) of the coefficients."""
    shape_intervals: Array
    """(f, 2) of the free shapes, by profile likelihood."""
    shape_std_errors: Array
    """(f,) likewise, by the curvature."""


def uncertainty(
    fits: ProfiledFit,
    fit: SupportFit,
    *,
    scale: float = 1.0,
    freedom: float = np.inf,
    meat: Array | None = None,
    level: float = 0.95,
) -> Uncertainty:
    """Return standard errors and intervals.

    Parameters
    ----------
    fits, fit
        The triangle's engine and one of its fits.
    scale : float
        Factor on the variances (misfit per degree of freedom where it is above one).
    freedom : float
        Degrees of freedom of that factor.
    meat : ndarray, shape (K, K), optional
        Sum over records of outer products of their score vectors on the dictionary's columns;
        where given, the covariance is the cluster-robust sandwich.
    level : float
        Of the intervals.

    Returns
    -------
    Uncertainty
    """
    dictionary = fits.dictionary
    jacobian = jacobian_of(fit, dictionary)
    columns = fits.triangle.columns @ jacobian
    norms = np.linalg.norm(columns, axis=0)
    norms[norms == 0.0] = 1.0
    inverse = np.linalg.pinv((columns / norms).T @ (columns / norms), rcond=1e-14)
    inverse /= np.outer(norms, norms)
    covariance = scale * inverse
    if meat is not None:
        sandwich = inverse @ (jacobian.T @ meat @ jacobian) @ inverse
        covariance = np.maximum(np.diag(sandwich), np.diag(covariance)) ** 0.5
        covariance = np.outer(covariance, covariance) * _correlation(scale * inverse)
    to_si, free = _to_si(fit, dictionary), len(fit.support.free)
    errors = np.sqrt(np.maximum(np.diag(to_si @ covariance @ to_si.T), 0.0))
    quantile = float(student.ppf(0.5 + 0.5 * level, freedom if np.isfinite(freedom) else 1e9))
    size = fit.coefficients.size
    centre = _si_coefficients(fit, dictionary)
    half = quantile * errors[:size]
    inflation = covariance[size:, size:].diagonal() / np.maximum(
        inverse[size:, size:].diagonal(), 1e-300
    )
    shapes = [
        _profile_interval(fits, fit, i, quantile**2 * float(inflation[i])) for i in range(free)
    ]
    return Uncertainty(
        errors[:size],
        np.column_stack([centre - half, centre + half]),
        np.array(shapes).reshape(free, 2),
        errors[size:],
    )


def _correlation(covariance: Array) -> Array:
    scale = np.sqrt(np.maximum(np.diag(covariance), 1e-300))
    return np.asarray(covariance / np.outer(scale, scale))


def jacobian_of(fit: SupportFit, dictionary: Dictionary) -> Array:
    """Return (K, k + f): the columns, and their slopes with the free shapes."""
    slopes = []
    for position, identifier in enumerate(fit.support.free):
        family, where = _family(identifier, dictionary)
        vector = np.zeros(dictionary.size)
        vector[where] = family.slope(fit.shapes[position]) * fit.coefficients[position]
        slopes.append(vector)
    return np.column_stack([fit.weights, *slopes]) if slopes else fit.weights


def _scales(fit: SupportFit, dictionary: Dictionary) -> Array:
    scales = np.ones(fit.coefficients.size)
    families = (*fit.support.free, *(i for i, _ in fit.support.fixed))
    for position, identifier in enumerate(families):
        family, _ = _family(identifier, dictionary)
        scales[position] = family.reference ** -fit.shapes[position]
    return scales


def _si_coefficients(fit: SupportFit, dictionary: Dictionary) -> Array:
    return np.asarray(fit.coefficients * _scales(fit, dictionary))


def _to_si(fit: SupportFit, dictionary: Dictionary) -> Array:
    """Return the matrix from (scaled coefficients, shapes) to (SI coefficients, shapes)."""
    scales = _scales(fit, dictionary)
    size, free = scales.size, len(fit.support.free)
    matrix = np.eye(size + free)
    matrix[np.arange(size), np.arange(size)] = scales
    for position, identifier in enumerate(fit.support.free):
        family, _ = _family(identifier, dictionary)
        matrix[position, size + position] = (
            -np.log(family.reference) * scales[position] * fit.coefficients[position]
        )
    return matrix


def _profile_interval(
    fits: ProfiledFit, fit: SupportFit, position: int, rise: float
) -> tuple[float, float]:
    """Return where the misfit, all else refitted, has risen by `rise`; else the bounds."""
    family, _ = _family(fit.support.free[position], fits.dictionary)
    best = fit.shapes[position]

    def excess(value: float) -> float:
        shapes = [*fit.shapes[: len(fit.support.free)]]
        shapes[position] = value
        return fits.at(fit.support, shapes).chi2 - fit.chi2 - rise

    ends = []
    for limit in (family.lower, family.upper):
        if abs(limit - best) < 1e-9 or excess(limit) <= 0.0:
            ends.append(limit)
            continue
        step = 1e-4 * np.sign(limit - best)
        inner, outer = best, best + step
        while (outer - limit) * step < 0.0 and excess(outer) < 0.0:
            inner, step = outer, 2.0 * step
            outer = best + step
        outer = min(outer, limit) if step > 0 else max(outer, limit)
        ends.append(float(brentq(excess, inner, outer, xtol=1e-9)) if excess(inner) < 0 else inner)
    return ends[0], ends[1]

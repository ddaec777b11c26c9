"""Log evidence of linear models whose coefficients are normal beforehand, some of one sign."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from discover.posterior.signs import allowed
from models.checks import Array, Indices

_LEAST, _MOST = 0.5, np.finfo(float).eps ** -2.0
"""Of one and a column's product with itself: below the first it is no product but rounding errors,
above the second these are all that is left of ordinary columns beside it."""


@dataclass(frozen=True)
class Solved:
    """Posterior of models' coefficients."""

    log_evidence: Array
    """(...,) nats, without the constants that all models share."""
    mean: Array
    """(..., K)."""
    covariance: Array
    """(..., K, K)."""


def root_of(gram: Array, spread: Array) -> Array:
    """Return the lower factor (..., K, K) of one and products of columns, these over their spread.

    None of the whole's eigenvalues is below one. Where rounding has taken that from columns that
    are alike, the lowest are set to one.
    """
    whole = np.eye(gram.shape[-1]) + spread[..., :, None] * gram * spread[..., None, :]
    try:
        return np.asarray(np.linalg.cholesky(whole), dtype=float)
    except np.linalg.LinAlgError:
        values, vectors = np.linalg.eigh(whole)
        half = np.sqrt(np.maximum(values, 1.0))[..., :, None] * np.swapaxes(vectors, -1, -2)
        upper = np.linalg.qr(half, mode="r")
        lower = np.swapaxes(upper, -1, -2)
        turned = np.where(np.diagonal(upper, axis1=-2, axis2=-1) < 0.0, -1.0, 1.0)
        return np.asarray(lower * turned[..., None, :])


def solved(
    gram: Array, side: Array, spread: Array, sign: Array, log_normal: float | Array
) -> Solved:
    """Return the posterior of models of K coefficients.

    Parameters
    ----------
    gram : ndarray, shape (..., K, K)
        Products of their columns under the inverse covariance.
    side : ndarray, shape (..., K)
        Products with the measured force.
    spread : ndarray, shape (..., K)
        Standard deviation of each coefficient beforehand.
    sign : ndarray, shape (..., K)
        1 where a coefficient can't be negative, -1 where not positive, else 0: the prior is
        a normal one cut off at zero.
    log_normal : float or ndarray, shape (...)
        Log density of the measured force without any column.

    Returns
    -------
    Solved
        With no evidence, -inf, for a model whose columns are so large that rounding errors are all
        that is left of the others.
    """
    own = 1.0 + spread**2 * np.diagonal(gram, axis1=-2, axis2=-1)
    lost = np.any((own < _LEAST) | (own > _MOST), axis=-1)
    if np.any(lost):
        gram = np.where(lost[..., None, None], 0.0, gram)
        side = np.where(lost[..., None], 0.0, side)
        log_normal = np.where(lost, -np.inf, log_normal)
    factor = root_of(gram, spread)
    inverse = np.linalg.inv(factor)
    half = np.einsum("...ij,...j->...i", inverse, spread * side)
    root = inverse * spread[..., None, :]
    mean = np.einsum("...ji,...j->...i", root, half)
    covariance = np.swapaxes(root, -1, -2) @ root
    value = log_normal + 0.5 * np.sum(half**2, axis=-1)
    value = value - np.sum(np.log(np.diagonal(factor, axis1=-2, axis2=-1)), axis=-1)
    return Solved(value + allowed(mean, covariance, sign), mean, covariance)


def without(gram: Array, taken: Indices, spread: Array) -> tuple[Array, float]:
    """Return products with columns marginalised, and what that adds to the log density.

    Parameters
    ----------
    gram : ndarray, shape (K, K)
        The measured force last.
    taken : ndarray of int, shape (T,)
        Columns to marginalise.
    spread : ndarray, shape (T,)
        Standard deviation of their coefficients beforehand.

    Returns
    -------
    gram : ndarray, shape (K, K)
        Of all columns; those taken mean nothing in it.
    gain : float
        Nats.
    """
    factor = root_of(gram[np.ix_(taken, taken)], spread)
    half = np.linalg.solve(factor, spread[:, None] * gram[taken])
    left = gram - half.T @ half
    gain = 0.5 * float(half[:, -1] @ half[:, -1]) - float(np.sum(np.log(np.diag(factor))))
    return left, gain

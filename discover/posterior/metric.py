"""Products of rows under the covariance that models share, a curve of friction marginalised."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from discover.posterior.covariance import Sizes
from discover.posterior.space import Part, Space
from models.checks import Array


@dataclass(frozen=True)
class Compared:
    """Products of columns, at one scale of the curve."""

    scale: float
    """Of the curve; 0 without one."""
    gram: Array
    """(T, T)."""
    log_normal: float
    """Log density of rows at its centre, without constants, nats."""


def compared(
    space: Space, sizes: Sizes, columns: Array, curve: Part | None
) -> Iterator[Compared]:
    """Yield products of columns (U, T, R), at every scale of a curve that is marginalised.

    Parameters
    ----------
    space : Space
        Of the records, with the curve's columns.
    sizes : Sizes
        Of what no term explains.
    columns : ndarray, shape (U, T, R)
        To compare.
    curve : Part, optional
        A term with a curve of its own.
    """
    here = space.given(sizes)
    if curve is None:
        _, among = here.beside(np.zeros(0, dtype=int), columns)
        yield Compared(0.0, among, here.log_centre)
        return
    across, among = here.beside(curve.columns, columns)
    inner = here.gram([(curve.columns, None)])
    for scale in curve.scales:
        factor, half = _factored(inner, across, scale * curve.spread)
        gram = np.asarray(among - half.T @ half)
        yield Compared(scale, gram, here.log_centre - float(np.sum(np.log(np.diag(factor)))))


def curve_given(
    space: Space, sizes: Sizes, left: Array, curve: Part, scale: float
) -> tuple[Array, Array]:
    """Return the mean (K,) and covariance (K, K) of a curve's coefficients.

    Parameters
    ----------
    space, sizes, curve
        As in `compared`.
    left : ndarray, shape (U, R)
        What the rest of a model leaves of the measured force.
    scale : float
        Of the curve.
    """
    here = space.given(sizes)
    across, _ = here.beside(curve.columns, left[:, None])
    spread = scale * curve.spread
    factor, _ = _factored(here.gram([(curve.columns, None)]), across, spread)
    root = np.linalg.solve(factor, np.diag(spread))
    covariance = root.T @ root
    return covariance @ across[:, 0], covariance


def _factored(inner: Array, outer: Array, spread: Array) -> tuple[Array, Array]:
    """Return the factor of one and the curve's products, and the share that it takes of others."""
    whole = np.eye(spread.size) + spread[:, None] * inner * spread
    factor = np.linalg.cholesky(whole)
    return np.asarray(factor, dtype=float), np.linalg.solve(factor, spread[:, None] * outer)

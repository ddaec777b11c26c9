"""Small least squares, and its reduction by QR."""

from __future__ import annotations

import numpy as np

from models.checks import Array

_REDUCE_ABOVE = 1.5  # rows per column from which a matrix is worth reducing


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


def reduce_rows(matrix: Array) -> Array:
    """Return the triangle of a matrix that is taller than wide; others as they are."""
    if matrix.shape[0] <= _REDUCE_ABOVE * matrix.shape[1]:
        return matrix
    return np.asarray(np.linalg.qr(matrix, mode="r"))

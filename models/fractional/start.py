"""Taylor coefficients at the start of a record, from a fit of fixed width in time."""

from __future__ import annotations

import functools

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import NDArray

from models.fractional.orders import Array

DEGREE = 8
# Widths tried, in samples, and the number of samples used in each: longer windows are thinned,
# so the fit costs the same however fine the sampling.
_NODES = 256
_SHORTEST = 2 * (DEGREE + 1)
LONGEST = 32768


def start_coefficients(x: Array, count: int) -> Array:
    r"""Estimate :math:`C_k = x^{(k)}(0)\,\Delta t^k / k!` for k = 0 .. count - 1.

    A polynomial is fitted to windows from the first sample on whose widths double; the width
    kept is the one that leaves the least error in the slope, judged by the residual: longer
    windows leave truncation (its neighbours go together), shorter ones amplify rounding and
    noise. So the width is a time
    that the motion sets, and finer sampling does not shorten it.

    Parameters
    ----------
    x : ndarray, shape (N,)
        Record. Only the first 32,768 samples matter.
    count : int
        Number of coefficients, at most 9.

    Returns
    -------
    ndarray, shape (count,)
        Zero beyond the degree that the record's length can carry.

    Examples
    --------
    >>> t = 0.01 * np.arange(400)
    >>> bool(np.allclose(start_coefficients(2.0 + 3.0 * t, 2), [2.0, 0.03], atol=1e-11))
    True
    """
    coefficients = np.zeros(count)
    limit = min(x.size, LONGEST)
    best = np.inf
    for width in _widths(limit):
        nodes, projector, basis, monomials = _fit(width)
        window = x[nodes]
        modes = projector @ window
        residual = window - basis @ modes
        spare = max(nodes.size - modes.size, 1)
        variance = float(residual @ residual) / spare
        together = float(residual[1:] @ residual[:-1]) / spare
        truncation = max(together - 2.0 * variance / np.sqrt(spare), 0.0)
        floor = 1e-16 * float(np.max(np.abs(window)))
        judged = np.sqrt(truncation + max(variance, floor**2) / nodes.size) / width
        if judged < best:
            best = judged
            fitted = monomials @ modes
            kept = min(count, fitted.size)
            coefficients[:] = 0.0
            coefficients[:kept] = fitted[:kept]
    return coefficients


def _widths(limit: int) -> list[int]:
    """Return widths in samples, about sqrt(2) apart, up to the limit."""
    if limit <= _SHORTEST:
        return [limit]
    widths = [_SHORTEST]
    while widths[-1] * 1.5 <= limit:
        widths.append(int(widths[-1] * 1.5))
    return widths


@functools.lru_cache(maxsize=64)
def _fit(width: int) -> tuple[NDArray[np.intp], Array, Array, Array]:
    """Nodes, projector on Legendre modes, the modes at the nodes, and modes to monomials in n."""
    nodes = np.unique(np.linspace(0, width - 1, min(width, _NODES)).astype(np.intp))
    degree = min(DEGREE, max((nodes.size - 1) // 2, 0)) if nodes.size > 2 else nodes.size - 1
    s = 2.0 * nodes / max(width - 1, 1) - 1.0
    vandermonde = legendre.legvander(s, degree)
    q, r = np.linalg.qr(vandermonde)
    # Orthonormal modes q = V r^-1; Taylor coefficients at s = -1 in powers of n.
    taylor = np.empty((degree + 1, degree + 1))
    for k in range(degree + 1):
        series = np.zeros(degree + 1)
        series[k] = 1.0
        factorial = 1.0
        for j in range(degree + 1):
            value = legendre.legval(-1.0, legendre.legder(series, j)) if j <= k else 0.0
            factorial *= max(j, 1)
            taylor[j, k] = value / factorial * (2.0 / max(width - 1, 1)) ** j
    monomials = taylor @ np.linalg.inv(r)
    return nodes, np.ascontiguousarray(q.T), q, monomials

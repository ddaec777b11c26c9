"""Where a smooth motion starts, and its Taylor coefficients there, from a fit of fixed width."""

from __future__ import annotations

import functools
import math
from dataclasses import dataclass

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
# Share of a residual in which neighbours may agree by rounding alone, that of time included.
_ROUNDING_TOGETHER = 0.5


@dataclass(frozen=True)
class Start:
    """Where a smooth motion starts: the first sample of a record, or a kink."""

    position: float
    """Samples from the record's first one; need not be whole."""
    motion: Array
    """(9,) Taylor coefficients at the position, of the motion behind it, per sample^k."""
    jumps: Array
    """(9,) the same of the motion behind less the motion before."""
    width: int
    """Samples from the position on over which `motion` holds."""

    @property
    def first(self) -> int:
        """Index of the first sample that is not before the position."""
        return math.ceil(self.position)

    @property
    def offset(self) -> float:
        """How long before that sample the motion starts, in samples: 0 <= offset < 1."""
        return self.first - self.position


def fit_start(x: Array) -> Start:
    r"""Estimate :math:`C_k = x^{(k)}(0)\,\Delta t^k / k!` for k = 0 .. 8.

    A polynomial is fitted to windows from the first sample on whose widths grow by half; the
    width kept is the one that leaves the least error in the slope, judged by the residual:
    longer windows leave truncation (its neighbours go together), shorter ones amplify noise,
    and rounding at the size of the whole. So the width is a time that the motion sets, and
    finer sampling does not shorten it.

    Parameters
    ----------
    x : ndarray, shape (N,)
        Record. Only the first 32,768 samples matter.

    Returns
    -------
    Start
        At the first sample, nothing before. Coefficients are zero beyond the degree that the
        record's length can carry.

    Examples
    --------
    >>> t = 0.01 * np.arange(400)
    >>> bool(np.allclose(fit_start(2.0 + 3.0 * t).motion[:2], [2.0, 0.03], atol=1e-11))
    True
    """
    coefficients = np.zeros(DEGREE + 1)
    best, kept = np.inf, x.size
    floor = 1e-16 * float(np.max(np.abs(x[:LONGEST])))
    # A level would make the fit itself round at its size, alike in neighbours.
    moved = x[:LONGEST] - x[0]
    for width in _widths(min(x.size, LONGEST)):
        nodes, projector, basis, monomials = _fit(width)
        window = moved[nodes]
        modes = projector @ window
        residual = window - basis @ modes
        spare = max(nodes.size - modes.size, 1)
        variance = float(residual @ residual) / spare
        together = float(residual[1:] @ residual[:-1]) / spare
        by_chance = max(_ROUNDING_TOGETHER, 2.0 / np.sqrt(spare)) * variance
        truncation = max(together - by_chance, 0.0)
        judged = np.sqrt(truncation + max(variance, floor**2) / nodes.size) / width
        if judged <= best:
            best = judged
            coefficients[:] = 0.0
            coefficients[: modes.size] = monomials @ modes
            kept = width
    # Whatever the fit: what happens from the start on is measured from the first sample.
    coefficients[0] = x[0]
    return Start(0.0, coefficients, coefficients, kept)


def _widths(limit: int) -> list[int]:
    """Return widths in samples, about sqrt(2) apart, up to the limit."""
    if limit <= _SHORTEST:
        return [limit]
    widths = [_SHORTEST]
    while widths[-1] * 1.5 <= limit:
        widths.append(int(widths[-1] * 1.5))
    return widths


# Kept: matrices of the width alone, which every record of that width needs.
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

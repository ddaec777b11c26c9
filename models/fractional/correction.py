"""Starting correction: what makes the schemes exact for powers of time from the first sample."""

from __future__ import annotations

import functools

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from scipy.special import bernoulli, factorial, rgamma

from models.fractional.orders import Array
from models.fractional.weights import convolution_weights, symbol_series

POWERS = 6
"""Powers of time made exact, from t^0 on: as many as the highest order of convergence."""
MOMENTS = 8
"""Samples at the start that carry the end correction of the sum."""
HEAD_SAMPLES = 128
"""Samples after which nothing but the scheme's own order is left."""


@functools.cache
def end_corrections(count: int) -> Array:
    r"""Return e_k(m): what to add to the first samples of n^k, k = 0 .. count - 1.

    The sum over samples :math:`\sum_n n^k e^{-nz}` differs from the integral
    :math:`k!/z^{k+1}` by :math:`\sum_j \zeta(-k-j)(-z)^j/j!`, which leaves errors that decay
    only like t^(-alpha-1). Eight samples with the opposite moments remove them, for every order
    alike: an end correction as in Gregory's rule.

    Returns
    -------
    ndarray, shape (count, 8)

    Examples
    --------
    >>> bool(abs(end_corrections(1)[0].sum() + 0.5) < 1e-14)
    True
    """
    numbers = bernoulli(count + MOMENTS)
    wanted = np.zeros((MOMENTS, count))
    for k in range(count):
        for j in range(MOMENTS):
            m = k + j
            # zeta(-m) = -B_{m+1}/(m+1) for m >= 1; the sum from n = 0 of n^0 has 1 + zeta(0).
            zeta = 0.5 if m == 0 else -numbers[m + 1] / (m + 1)
            wanted[j, k] = -zeta
    powers = np.arange(MOMENTS)[None, :] ** np.arange(MOMENTS)[:, None]
    return np.ascontiguousarray(np.linalg.solve(powers.astype(np.float64), wanted).T)


@functools.lru_cache(maxsize=64)
def head_corrections(orders: tuple[float, ...], p: int, count: int) -> Array:
    r"""Return what is left to add to the first outputs for n^k, k = 0 .. count - 1.

    Parameters
    ----------
    orders : tuple of K floats
    p : int
        Steps of the backward difference formula.
    count : int

    Returns
    -------
    ndarray, shape (K, count, 128)
        :math:`\frac{k!}{\Gamma(k+1-\alpha)}n^{k-\alpha}` less the scheme's result on
        n^k + e_k, but for those parts of the scheme's error that are smooth from the start on:
        they are its order of convergence, and taking them off here would leave a step behind.
        At n = 0 the finite part is the exact value.

    Examples
    --------
    >>> rest = head_corrections((0.5,), 6, 6)
    >>> bool(np.max(np.abs(rest[0, :2, -1])) < 1e-11)
    True
    """
    n = np.arange(HEAD_SAMPLES, dtype=np.float64)
    sequences = n ** np.arange(count)[:, None]
    sequences[:, :MOMENTS] += end_corrections(count)
    weights = convolution_weights(np.array(orders), HEAD_SAMPLES, p)
    # (K, n, m) weight n - m, zero before the first: a view, convolution by plain sums.
    padded = np.pad(weights, ((0, 0), (HEAD_SAMPLES - 1, 0)))
    causal = sliding_window_view(padded, HEAD_SAMPLES, axis=1)[:, :, ::-1]
    alpha = np.array(orders)[:, None, None]
    q = np.arange(count)[None, :, None]
    # Derivatives of n^q / q!, at n = 0 their finite part.
    single = np.where(n > 0.0, np.maximum(n, 1.0) ** (q - alpha) * rgamma(q + 1.0 - alpha), 0.0)
    single[:, :, 0] = (alpha == q)[:, :, 0]
    wanted = single.copy()
    series = symbol_series(alpha[:, 0, 0], p)
    for k in range(count):
        for j in range(p, k + 1):
            smooth = np.where(k - j >= alpha[:, 0, 0], series[:, j], 0.0)
            wanted[:, k] += smooth[:, None] * single[:, k - j]
    wanted *= factorial(q)
    rest: Array = wanted - np.swapaxes(causal @ sequences.T, 1, 2)
    rest.setflags(write=False)
    return rest


"""Starting correction: what makes the schemes exact for powers of time from their first sample."""

from __future__ import annotations

import functools

import numpy as np
from scipy.special import bernoulli, comb, factorial, rgamma

from models.fractional.orders import Array
from models.fractional.weights import INTEGRAL_STEPS, convolution_weights

POWERS = 6
"""Powers of time made exact, from t^0 on: as many as the highest order of convergence."""
MOMENTS = 8
"""Samples at the start that carry the end correction of the sum."""
HEAD_SAMPLES = 192
"""Samples after which nothing but the scheme's own order is left."""


# Kept, as the next: numbers of offset and orders alone, the same for all records.
@functools.lru_cache(maxsize=64)
def end_corrections(offset: float = 0.0) -> Array:
    r"""Return e_k(n): what to add to the first samples of (n + u)^k, k = 0 .. 5.

    The sum over samples :math:`\sum_n (n+u)^k e^{-(n+u)z}` differs from the integral
    :math:`k!/z^{k+1}` by :math:`\sum_j \zeta(-k-j,u)(-z)^j/j!`, which leaves errors that decay
    only like a power of t. Eight samples with the opposite moments remove them, for every order
    alike: an end correction as in Gregory's rule.

    Parameters
    ----------
    offset : float
        u, 0 to 1: how long before the first sample the power begins, in samples.

    Returns
    -------
    ndarray, shape (6, 8)

    Examples
    --------
    >>> bool(abs(end_corrections()[0].sum() + 0.5) < 1e-14)
    True
    """
    numbers = bernoulli(POWERS + MOMENTS)
    wanted = np.zeros((MOMENTS, POWERS))
    for k in range(POWERS):
        for j in range(MOMENTS):
            # zeta(-m, u) = -B_{m+1}(u) / (m + 1), with 0^0 = 1 where u = 0.
            m = k + j + 1
            terms = [comb(m, i) * numbers[i] * offset ** (m - i) for i in range(m + 1)]
            wanted[j, k] = sum(terms) / m
    powers = (np.arange(MOMENTS) + offset)[None, :] ** np.arange(MOMENTS)[:, None]
    return np.ascontiguousarray(np.linalg.solve(powers, wanted).T)


@functools.lru_cache(maxsize=64)
def head_corrections(orders: tuple[float, ...], offset: float = 0.0) -> Array:
    r"""Return what is left to add to the first outputs for (n + u)^k, k = 0 .. 5.

    Parameters
    ----------
    orders : tuple of K floats
        -1 to 0: integrals.
    offset : float
        u, as for `end_corrections`.

    Returns
    -------
    ndarray, shape (K, 6, 192)
        :math:`\frac{k!}{\Gamma(k+1-\alpha)}(n+u)^{k-\alpha}` less the result of the
        weights on (n + u)^k + e_k.

    Examples
    --------
    >>> rest = head_corrections((-0.5,))
    >>> bool(np.max(np.abs(rest[0, :2, -1])) < 1e-10)
    True
    """
    n = np.arange(HEAD_SAMPLES) + offset
    sequences = n ** np.arange(POWERS)[:, None]
    sequences[:, :MOMENTS] += end_corrections(offset)
    weights = convolution_weights(np.array(orders), HEAD_SAMPLES, INTEGRAL_STEPS)
    alpha = np.array(orders)[:, None, None]
    q = np.arange(POWERS)[None, :, None]
    rest: Array = factorial(q) * n ** (q - alpha) * rgamma(q + 1.0 - alpha)
    for own, row in zip(rest, weights, strict=True):
        for power, sequence in zip(own, sequences, strict=True):
            power -= np.convolve(row, sequence)[:HEAD_SAMPLES]
    rest.setflags(write=False)
    return rest

"""Convolution weights of the causal schemes: Gruenwald-Letnikov and Lubich's BDF2 to BDF6."""

from __future__ import annotations

import functools
import math
from fractions import Fraction

import numpy as np
import scipy.fft
from scipy.special import rgamma

from models.fractional.blocks import blocks
from models.fractional.orders import Array

INTEGRAL_STEPS = 6
"""Steps of the formula that integrates: integrals do not amplify noise, so there is no reason to
take fewer."""
BDF_STEPS = {"gl": 1, "bdf2": 2, "bdf3": 3, "bdf4": 4, "bdf5": 5, "bdf6": 6}
"""Schemes by name and the number p of steps of their backward difference formula."""

# From here on the weights follow their expansion in 1/n; the spurious roots of BDF6 have
# decayed below 1e-30 by then.
HEAD = 512
_TERMS = 11
# The coefficients of the factor without the root at 1 fall at least like 0.8634^n.
_DECAYED = 256
_CIRCLE = 512


@functools.cache
def difference_polynomial(p: int) -> tuple[Fraction, ...]:
    """Coefficients of delta(zeta) = sum_{k=1}^{p} (1 - zeta)^k / k in powers of zeta.

    Examples
    --------
    >>> [str(c) for c in difference_polynomial(2)]
    ['3/2', '-2', '1/2']
    """
    total = [Fraction(0)] * (p + 1)
    for k in range(1, p + 1):
        for j in range(k + 1):
            total[j] += Fraction((-1) ** j * math.comb(k, j), k)
    return tuple(total)


@functools.cache
def _difference_series(p: int) -> tuple[float, ...]:
    """Coefficients of delta(e^-z)/z in powers of z: 1, then zeros up to z^(p-1)."""
    series = []
    for j in range(_TERMS):
        moment = sum(c * (-k) ** (j + 1) for k, c in enumerate(difference_polynomial(p)))
        series.append(float(Fraction(moment) / math.factorial(j + 1)))
    return tuple(series)


def symbol_series(orders: Array, p: int) -> Array:
    r"""Expand :math:`(\delta(e^{-z})/z)^\alpha` in powers of z.

    Parameters
    ----------
    orders : ndarray, shape (K,)
    p : int
        Steps of the formula, 1 to 6.

    Returns
    -------
    ndarray, shape (K, 11)
        First column 1; the next non-zero one, of z^p, is the scheme's error constant.

    Examples
    --------
    >>> float(symbol_series(np.array([1.0]), 1)[0, 1])
    -0.5
    """
    return _symbol_series(tuple(orders.tolist()), p)


# Kept: a series of the orders alone, the same for all records.
@functools.lru_cache(maxsize=128)
def _symbol_series(given: tuple[float, ...], p: int) -> Array:
    orders = np.array(given)
    base = _difference_series(p)
    series = np.zeros((orders.size, _TERMS))
    series[:, 0] = 1.0
    for n in range(1, _TERMS):
        for k in range(1, n + 1):
            if base[k] != 0.0:
                series[:, n] += (orders * k - (n - k)) * base[k] * series[:, n - k] / n
    series.setflags(write=False)
    return series


def convolution_weights(orders: Array, count: int, p: int) -> Array:
    r"""Return the first coefficients of :math:`\delta(\zeta)^\alpha`.

    Then :math:`D^\alpha x(t_n) \approx \Delta t^{-\alpha}\sum_{j=0}^n w_j x_{n-j}`.

    Parameters
    ----------
    orders : ndarray, shape (K,)
        Orders, -1 to 2.
    count : int
        Weights wanted, N.
    p : int
        Steps of the backward difference formula, 1 (Gruenwald-Letnikov) to 6.

    Returns
    -------
    ndarray, shape (K, N)
        Correct to a few units of rounding of the largest. The first 512 are products of two
        series, that of (1 - zeta)^alpha and that of the other factor, the rest come from the
        expansion at zeta = 1.

    References
    ----------
    Lubich, *Discretized fractional calculus*, SIAM J. Math. Anal. 17 (1986) 704-719.

    Examples
    --------
    >>> convolution_weights(np.array([0.5]), 4, 1)
    array([[ 1.    , -0.5   , -0.125 , -0.0625]])
    """
    weights = np.empty((orders.size, count))
    head = min(count, HEAD)
    n = np.arange(1, head)
    binomial = np.ones((orders.size, head))
    np.cumprod((n - 1.0 - orders[:, None]) / n, axis=1, out=binomial[:, 1:])
    factors = _smooth_factor(orders, p)
    for row, one, factor in zip(weights, binomial, factors, strict=True):
        row[:head] = np.convolve(one, factor)[:head]
    whole = (orders >= 0.0) & (orders == np.floor(orders))
    for k in np.flatnonzero(whole):
        weights[k, p * int(orders[k]) + 1 : head] = 0.0
    if count > head:
        terms = symbol_series(orders, p) * rgamma(-orders[:, None] - np.arange(_TERMS))
        for part in blocks(head, count):
            _fill_tail(weights[:, part], orders, terms, part.start)
    return weights


def _smooth_factor(orders: Array, p: int) -> Array:
    """First coefficients of (delta(zeta) / (1 - zeta))^alpha; those left out are below rounding."""
    if p == 1:
        return np.ones((orders.size, 1))
    circle = np.exp(-2j * np.pi / _CIRCLE * np.arange(_CIRCLE // 2 + 1))
    factor = sum((1.0 - circle) ** (k - 1) / k for k in range(1, p + 1))
    # No roots within the unit circle, and never a negative real number on it.
    series = scipy.fft.irfft(np.power(factor, orders[:, None]), n=_CIRCLE, axis=-1)
    return np.asarray(series[:, :_DECAYED])


def _fill_tail(out: Array, orders: Array, series: Array, start: int) -> None:
    """Write sum_j series_j n^(-order-1-j) for n = start, start + 1, ... into `out`."""
    n = np.arange(start, start + out.shape[1], dtype=np.float64)
    logarithm = np.log(n)
    inverse = 1.0 / n
    size = np.abs(series) * float(start) ** -np.arange(_TERMS)
    for k in range(orders.size):
        row = out[k]
        np.multiply(logarithm, -(orders[k] + 1.0), out=row)
        np.exp(row, out=row)
        needed = np.flatnonzero(size[k] > 1e-18 * max(size[k, 0], size[k].max()))
        last = int(needed[-1]) if needed.size else 0
        if last == 0:
            row *= series[k, 0]
            continue
        factor = np.full(n.size, series[k, last])
        for j in range(last - 1, -1, -1):
            factor *= inverse
            factor += series[k, j]
        row *= factor

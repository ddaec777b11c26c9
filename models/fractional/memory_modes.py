"""Convolution weights beyond the first few hundred as a sum of decaying exponentials."""

from __future__ import annotations

import functools
from dataclasses import dataclass

import numpy as np

from models.fractional.orders import Array
from models.fractional.weights import HEAD, symbol_series

HORIZON = 1e9
"""Samples up to which the sum holds."""
# Step in log rate: the trapezoidal rule's error is about exp(-pi^2 / step).
_STEP = 0.28
# Rates beyond this many over HEAD have died out where the sum begins.
_FASTEST = 42.0
_CONSTANT = 1e-14


@dataclass(frozen=True)
class MemoryModes:
    """Modes that carry the memory of all orders at once."""

    rates: Array
    """(M,) per sample, ascending."""
    weights: Array
    """(K, M) weight n of order k is sum_m weights[k, m] exp(-rates[m] (n - 512)), n >= 512."""


def memory_modes(orders: Array, p: int) -> MemoryModes:
    r"""Return modes for the tails of the weights of `convolution_weights`.

    From the 512th on the weights are the Laplace transform

    .. math:: w_n = \frac{\sin\pi(\alpha+1)}{\pi}\int_0^\infty
       s^\alpha\left(\frac{\delta(e^{s})}{-s}\right)^\alpha e^{-ns}\,ds,

    which the trapezoidal rule in log s turns into exponentials with rates that no order
    depends on.

    Parameters
    ----------
    orders : ndarray, shape (K,)
        Orders, -1 to 2.
    p : int
        Steps of the backward difference formula, 1 to 6.

    Returns
    -------
    MemoryModes
        Relative error below 1e-11 for 512 <= n <= 1e9.

    References
    ----------
    Schaedle, Lopez-Fernandez, Lubich, *Fast and oblivious convolution quadrature*, SIAM J. Sci.
    Comput. 28 (2006) 421-438. Beylkin, Monzon, Appl. Comput. Harmon. Anal. 28 (2010) 131-149.

    Examples
    --------
    >>> from models.fractional.weights import convolution_weights
    >>> modes = memory_modes(np.array([0.5]), 3)
    >>> weight = modes.weights[0] @ np.exp(-modes.rates * (2000 - HEAD))
    >>> exact = convolution_weights(np.array([0.5]), 2001, 3)[0, 2000]
    >>> bool(abs(weight / exact - 1.0) < 1e-11)
    True
    """
    return _memory_modes(tuple(orders.tolist()), p)


# Kept: rates and weights of the orders alone, the same for all records.
@functools.lru_cache(maxsize=16)
def _memory_modes(orders: tuple[float, ...], p: int) -> MemoryModes:
    alpha = np.array(orders)
    u = np.arange(np.log(_CONSTANT / HORIZON), np.log(_FASTEST / HEAD), _STEP)
    rates = np.exp(u)
    beta = alpha[:, None] + 1.0
    weights = _STEP * np.exp(beta * u) * np.sin(np.pi * beta) / np.pi
    # All slower rates act as one constant: the sum of their geometric series. At order -1
    # nothing else is left of the weights, which are all 1.
    whole = beta[:, 0] == 0.0
    slow = -np.expm1(-beta[:, 0] * _STEP)
    weights[:, 0] = np.where(whole, 1.0, weights[:, 0] / np.where(whole, 1.0, slow))
    series = symbol_series(alpha, p)
    weights *= np.stack([np.polynomial.polynomial.polyval(-rates, row) for row in series])
    weights *= np.exp(-rates * HEAD)
    # The sine of a multiple of pi is not quite zero.
    weights[(alpha >= 0.0) & (alpha == np.floor(alpha))] = 0.0
    return MemoryModes(rates, weights)

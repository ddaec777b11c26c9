"""The L1 scheme: Caputo derivative of the piecewise linear interpolant."""

from __future__ import annotations

import numpy as np
from scipy.special import rgamma

from models.checks import InputError
from models.fractional.convolution import convolve, weight_spectra
from models.fractional.orders import Array


def l1_weights(orders: Array, count: int) -> Array:
    r"""Return :math:`b_j = ((j+1)^{1-\alpha}-j^{1-\alpha})/\Gamma(2-\alpha)`.

    Parameters
    ----------
    orders : ndarray, shape (K,)
        Orders, 0 < order < 1.
    count : int

    Returns
    -------
    ndarray, shape (K, count)

    Examples
    --------
    >>> l1_weights(np.array([0.5]), 2).round(6)
    array([[1.128379, 0.46739 ]])
    """
    j = np.arange(1, count, dtype=np.float64)
    left = 1.0 - orders[:, None]
    weights = np.empty((orders.size, count))
    weights[:, 0] = 1.0
    # The difference of powers without cancellation.
    weights[:, 1:] = np.exp(left * np.log(j)) * np.expm1(left * np.log1p(1.0 / j))
    return weights * rgamma(1.0 + left)


def l1_derivative(x: Array, orders: Array, dt: float) -> Array:
    """Return the Caputo derivative of the polygon through the samples.

    Parameters
    ----------
    x : ndarray, shape (R, N)
        Records.
    orders : ndarray, shape (K,)
        Orders, 0 < order < 1.
    dt : float
        Sampling interval, s.

    Returns
    -------
    ndarray, shape (K, R, N)
        Error of order dt^(2 - order) for smooth records.

    Raises
    ------
    InputError
        For an order outside (0, 1).

    References
    ----------
    Oldham, Spanier, *The Fractional Calculus*, 1974, section 8.2.

    Examples
    --------
    >>> t = 0.1 * np.arange(5)
    >>> y = l1_derivative(t[None], np.array([0.5]), 0.1)
    >>> bool(np.allclose(y[0, 0], 2 * np.sqrt(t / np.pi)))
    True
    """
    outside = (orders <= 0.0) | (orders >= 1.0)
    if outside.any():
        raise InputError(
            "order", expected="in (0, 1) for scheme l1", found=f"{float(orders[outside][0])!r}"
        )
    spectra = weight_spectra("l1", orders, x.shape[1], l1_weights)
    steps = np.diff(x, axis=1, prepend=x[:, :1])
    choice = np.zeros(orders.size, dtype=np.intp)
    return convolve(steps[None], choice, spectra, dt**-orders)

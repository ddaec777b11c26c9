"""Causal derivatives from the first sample on: Gruenwald-Letnikov and corrected BDF schemes."""

from __future__ import annotations

import numpy as np
from scipy.special import rgamma

from models.fractional.convolution import convolve, weight_spectra
from models.fractional.correction import (
    HEAD_SAMPLES,
    MOMENTS,
    POWERS,
    end_corrections,
    head_corrections,
)
from models.fractional.orders import Array
from models.fractional.start import start_coefficients
from models.fractional.threads import map_threads
from models.fractional.weights import BDF_STEPS, convolution_weights


def causal_derivative(
    x: Array, orders: Array, dt: float, *, scheme: str, caputo: bool, corrected: bool = True
) -> Array:
    r"""Differentiate from the first sample on, nothing known before.

    Parameters
    ----------
    x : ndarray, shape (R, N)
        Records.
    orders : ndarray, shape (K,)
        Orders, -1 to 2.
    dt : float
        Sampling interval, s.
    scheme : str
        "gl" or "bdf2" to "bdf6".
    caputo : bool
        Take off what initial value and velocity contribute (Caputo); else Riemann-Liouville.
    corrected : bool
        Apply the starting correction; without it the result is the bare weighted sum.

    Returns
    -------
    ndarray, shape (K, R, N)
        At the first sample, where the Riemann-Liouville derivative has no finite value, its
        finite part.

    Examples
    --------
    >>> t = 0.01 * np.arange(500)
    >>> y = causal_derivative(t[None] ** 2, np.array([0.5]), 0.01, scheme="bdf4", caputo=True)
    >>> bool(np.allclose(y[0, 0], 2 * t**1.5 / 1.329340388179137, atol=1e-10))
    True
    """
    p = BDF_STEPS[scheme]
    spectra = weight_spectra(
        scheme, orders, x.shape[1], lambda alpha, count: convolution_weights(alpha, count, p)
    )
    scales = dt**-orders
    if not corrected and not caputo:
        return convolve(x[None], np.zeros(orders.size, dtype=np.intp), spectra, scales)
    starts = np.stack([start_coefficients(row, POWERS) for row in x])
    # Two variants of the record: as it is, and without its initial value for Caputo.
    choice = ((orders > 0.0) & caputo).astype(np.intp)
    coefficients = np.stack([starts, starts])
    coefficients[1, :, 0] = 0.0
    sources = np.stack([x, x - starts[:, :1]]) if choice.any() else x[None].copy()
    if corrected:
        touched = min(MOMENTS, x.shape[1])
        for source, known in zip(sources, coefficients, strict=False):
            source[:, :touched] += (known @ end_corrections(POWERS))[:, :touched]
    out = convolve(sources, choice, spectra, scales)
    if corrected:
        head = min(HEAD_SAMPLES, x.shape[1])
        rest = head_corrections(tuple(orders.tolist()), p, POWERS)[:, :, :head]
        out[:, :, :head] += scales[:, None, None] * (coefficients[choice] @ rest)
    # A slope that is only rounding leaves nothing to take off.
    moving = np.abs(starts[:, 1]) > 1e-15 * np.max(np.abs(x), axis=1)
    if caputo and moving.any():
        _take_off_velocity(out, np.where(moving, starts[:, 1], 0.0), orders, scales)
    return out


def _take_off_velocity(out: Array, slopes: Array, orders: Array, scales: Array) -> None:
    """Subtract the derivative of slope * n from the orders above one, in place."""
    log_n = np.log(np.arange(1, out.shape[2], dtype=np.float64))

    def work(k: int) -> None:
        decay = np.exp((1.0 - orders[k]) * log_n)
        decay *= float(rgamma(2.0 - orders[k])) * scales[k]
        for r in np.flatnonzero(slopes):
            out[k, r, 1:] -= slopes[r] * decay

    map_threads(work, [int(k) for k in np.flatnonzero((orders > 1.0) & (orders < 2.0))])

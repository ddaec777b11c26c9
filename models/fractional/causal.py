"""Causal derivatives from the first sample on: Gruenwald-Letnikov and corrected BDF schemes."""

from __future__ import annotations

import numpy as np
from scipy.special import rgamma

from models.fractional.convolution import convolve, padded_length, weight_spectra
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
        return convolve(x[None], np.zeros(orders.size, dtype=np.intp), spectra, scales, x.shape[1])
    starts = np.stack([start_coefficients(row, POWERS) for row in x])
    # Variants of the record, as far as some order wants them: as it is, and less its initial
    # value.
    levelled, choice = np.unique((orders > 0.0) & caputo, return_inverse=True)
    samples = x.shape[1]
    sources = np.zeros((levelled.size, x.shape[0], padded_length(samples)))
    known = np.stack([starts] * levelled.size)
    for source, coefficients, without_level in zip(sources, known, levelled, strict=True):
        np.subtract(x, starts[:, :1] if without_level else 0.0, out=source[:, :samples])
        if without_level:
            coefficients[:, 0] = 0.0
        if corrected:
            touched = min(MOMENTS, samples)
            source[:, :touched] += (coefficients @ end_corrections(POWERS))[:, :touched]
    out = convolve(sources, choice, spectra, scales, samples)
    if corrected:
        head = min(HEAD_SAMPLES, samples)
        rest = head_corrections(tuple(orders.tolist()), p, POWERS)[:, :, :head]
        out[:, :, :head] += scales[:, None, None] * (known[choice] @ rest)
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

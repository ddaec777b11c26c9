"""Causal derivatives from the first sample on: Gruenwald-Letnikov and corrected BDF schemes."""

from __future__ import annotations

import math

import numpy as np
from scipy.special import rgamma

from models.fractional.convolution import convolve, weight_spectra
from models.fractional.correction import (
    HEAD_SAMPLES,
    MOMENTS,
    end_corrections,
    head_corrections,
)
from models.fractional.orders import Array
from models.fractional.start import start_coefficients
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
    >>> bool(np.allclose(y[0, 0], 2 * t**1.5 / math.gamma(2.5), atol=1e-10))
    True
    """
    p = BDF_STEPS[scheme]
    spectra = weight_spectra(
        scheme, orders, x.shape[1], lambda alpha, count: convolution_weights(alpha, count, p)
    )
    scales = dt**-orders
    if not corrected and not caputo:
        return convolve(x, spectra, scales)
    count = max(p, 2)
    starts = np.stack([start_coefficients(row, count) for row in x])
    out = np.empty((orders.size, *x.shape))
    levelled = (orders > 0.0) & caputo
    for group, without_level in ((levelled, True), (~levelled, False)):
        chosen = np.flatnonzero(group)
        if chosen.size == 0:
            continue
        coefficients = starts.copy()
        source = x.copy()
        if without_level:
            source -= coefficients[:, :1]
            coefficients[:, 0] = 0.0
        used = coefficients if corrected else np.zeros_like(coefficients)
        touched = min(MOMENTS, x.shape[1])
        source[:, :touched] += (used @ end_corrections(count))[:, :touched]
        out[chosen] = convolve(source, [spectra[k] for k in chosen], scales[chosen])
        head = min(HEAD_SAMPLES, x.shape[1])
        rest = head_corrections(tuple(orders[chosen].tolist()), p, count)[:, :, :head]
        for k, correction in zip(chosen, rest, strict=True):
            order = float(orders[k])
            out[k, :, :head] += scales[k] * (used @ correction)
            if without_level and order > 1.0:
                _take_off_velocity(out[k], coefficients[:, 1], order, float(scales[k]))
    return out


def _take_off_velocity(out: Array, slopes: Array, order: float, scale: float) -> None:
    """Subtract the derivative of slope * n, in place, where it is more than rounding."""
    factor = float(rgamma(2.0 - order)) * scale
    if factor == 0.0:
        return
    large = np.abs(slopes * factor) > 1e-17 * math.sqrt(out.shape[1]) * np.max(np.abs(out), axis=1)
    if not large.any():
        return
    n = np.arange(1, out.shape[1], dtype=np.float64)
    decay = np.exp((1.0 - order) * np.log(n)) * factor
    for r in np.flatnonzero(large):
        out[r, 1:] -= slopes[r] * decay

"""Causal derivatives from the first sample on: whole ones first, then a fractional integral."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.special import rgamma

from models.fractional.convolution import convolve, weight_spectra
from models.fractional.correction import POWERS, end_corrections, head_corrections
from models.fractional.differences import (
    Split,
    backward_difference,
    differentiated,
    split_orders,
    whole_derivative,
)
from models.fractional.orders import Array
from models.fractional.start import Start, fit_start
from models.fractional.threads import map_threads
from models.fractional.weights import INTEGRAL_STEPS, convolution_weights


def causal_derivative(
    x: Array,
    orders: Array,
    dt: float,
    *,
    steps: int,
    stride: int = 1,
    caputo: bool,
    starts: Sequence[Sequence[Start]] | None = None,
) -> Array:
    r"""Differentiate from the first sample on, nothing known before.

    Caputo's derivative by its definition, :math:`I^{m-\alpha}x^{(m)}`: whole derivatives by
    backward differences, then the integral by convolution with Lubich's weights of order 6. In
    this order the numbers that the FFT sees are as small as the result, so that its rounding
    does not grow with the sampling rate; and a stride keeps that of the samples small.

    Parameters
    ----------
    x : ndarray, shape (R, N)
        Records.
    orders : ndarray, shape (K,)
        Orders, -1 to 2.
    dt : float
        Sampling interval, s.
    steps : int
        Steps p of the backward difference formula, 1 to 6: the error is of order (stride dt)^p.
    stride : int
        Samples from one point of the backward differences to the next.
    caputo : bool
        Leave out what initial value and velocity contribute (Caputo); else Riemann-Liouville.
    starts : sequence of R sequences, optional
        Of each record, that of the first sample and its kinks; the first one alone by default.

    Returns
    -------
    ndarray, shape (K, R, N)
        At the first sample, where the Riemann-Liouville derivative has no finite value, its
        finite part.

    References
    ----------
    Caputo, Geophys. J. R. Astron. Soc. 13 (1967) 529-539. Lubich, SIAM J. Math. Anal. 17 (1986)
    704-719.

    Examples
    --------
    >>> t = 0.01 * np.arange(500)
    >>> y = causal_derivative(t[None] ** 2, np.array([0.5]), 0.01, steps=4, caputo=True)
    >>> bool(np.allclose(y[0, 0], 2 * t**1.5 / 1.329340388179137, atol=1e-10))
    True
    """
    records, samples = x.shape
    if starts is None:
        starts = [[fit_start(row)] for row in x]
    split = split_orders(orders)
    scales = dt**-orders
    sources = np.empty((len(split.wholes), records, samples))
    for source, whole in zip(sources, split.wholes, strict=True):
        for into, row, its in zip(source, x, starts, strict=True):
            whole_derivative(row, its, whole, steps, stride, out=into)
            for start in its:
                ends = taylor(start, whole) @ end_corrections(start.offset)
                part = into[start.first : min(start.first + ends.size, samples)]
                part += ends[: part.size]
    spectra = _spectra(split.rest, samples, INTEGRAL_STEPS)
    out = convolve(sources, split.choice, spectra, scales)
    for r, its in enumerate(starts):
        for start in its:
            heads = start_corrections(start, split)
            part = out[:, r, start.first : start.first + heads.shape[1]]
            part += scales[:, None] * heads[:, : part.shape[1]]
        for start in its[1:] if caputo else its:
            add_steps(out[:, r, start.first :], start, orders, scales)
    return out


def weighted_sum(x: Array, orders: Array, dt: float) -> Array:
    """Return the bare sum of Gruenwald and Letnikov over the samples.

    Parameters
    ----------
    x : ndarray, shape (R, N)
        Records.
    orders : ndarray, shape (K,)
        Orders, -1 to 2.
    dt : float
        Sampling interval, s.

    Returns
    -------
    ndarray, shape (K, R, N)

    Examples
    --------
    >>> weighted_sum(np.array([[1.0, 1.0, 1.0]]), np.array([0.5]), 1.0)
    array([[[1.   , 0.5  , 0.375]]])
    """
    split = split_orders(orders)
    sources = np.array(
        [[backward_difference(row, whole, 1, 1) for row in x] for whole in split.wholes]
    )
    spectra = _spectra(split.rest, x.shape[1], 1)
    return convolve(sources, split.choice, spectra, dt**-orders)


def taylor(start: Start, whole: int) -> Array:
    """Return the first coefficients of the m-th derivative's jump at a start, (6,)."""
    return differentiated(start.jumps, whole)[:POWERS]


def start_corrections(start: Start, split: Split) -> Array:
    """Return what to add to the first outputs behind a start, (K, 192), per sample^order."""
    rest = head_corrections(tuple(split.rest.tolist()), start.offset)
    coefficients = np.stack([taylor(start, whole) for whole in split.wholes])[split.choice]
    return np.asarray((coefficients[:, None, :] @ rest)[:, 0])


def add_steps(out: Array, start: Start, orders: Array, scales: Array, seen: int = 0) -> None:
    """Add the derivatives of a step in value and slope at a start, in place.

    Those of the record's start are what Riemann-Liouville's derivative has beyond Caputo's.

    Parameters
    ----------
    out : ndarray, shape (K, N)
    start : Start
    orders : ndarray, shape (K,)
    scales : ndarray, shape (K,)
        dt^-order.
    seen : int, optional
        Samples from the first one of the start to the first one of `out`. At the start itself,
        where the contribution has no finite value, nothing is added.
    """
    if not start.jumps[:2].any():
        return
    n = np.arange(seen, seen + out.shape[1]) + start.offset
    first = int(np.searchsorted(n, 0.0, side="right"))
    n = n[first:]
    log_n = np.log(n)

    def work(k: int) -> None:
        factors = scales[k] * start.jumps[:2] * rgamma([1.0 - orders[k], 2.0 - orders[k]])
        powers = np.exp(-orders[k] * log_n)
        powers *= factors[0] + factors[1] * n if orders[k] > 1.0 else factors[0]
        out[k, first:] += powers

    map_threads(work, [int(k) for k in np.flatnonzero(orders > 0.0)])


def _spectra(rest: Array, samples: int, steps: int) -> list[NDArray[np.complex128] | None]:
    """Spectra of the weights of each order; None where nothing is left to integrate."""
    left = np.flatnonzero(rest)
    made = weight_spectra(
        f"bdf{steps}", rest[left], samples, lambda a, count: convolution_weights(a, count, steps)
    )
    spectra: list[NDArray[np.complex128] | None] = [None] * rest.size
    for k, spectrum in zip(left, made, strict=True):
        spectra[k] = spectrum
    return spectra

"""Band-limited derivatives of noisy records that are not periodic."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import scipy.fft
from numpy.typing import ArrayLike

from models.checks import number
from models.fractional.continuation import continue_record, end_fit
from models.fractional.lowest_lines import lowest_lines
from models.fractional.orders import Array, checked_orders, checked_record
from models.fractional.spectral import TRANSITION, harmonic_factors, low_pass_gain
from models.fractional.window import kaiser_window

# Lengths at each end, in periods of the cut-off: fitted, and added beyond the record.
_FITTED = 6.0
_ADDED = 5.0
# A start that moves less than this share of the whole record is at rest.
_QUIET = 0.05
_KAISER = 18.0
# Power over the noise floor that chance alone does not reach.
_CLEAR = 20.0


def low_pass(y: ArrayLike, dt: float, *, cutoff: float, edge_noise: float = 1e-6) -> Array:
    """Smooth records with the filter that `band_limited_derivative` uses, without phase.

    Parameters
    ----------
    y : array_like, shape (..., N)
        Records: force, or a term of the motion.
    dt : float
        Sampling interval, s.
    cutoff : float
        Hz: all passes up to here, nothing above twice that.
    edge_noise : float, optional
        Noise over signal that the extension beyond the ends reckons with, at least; what the
        record shows above the filter counts in any case.

    Returns
    -------
    ndarray, shape (..., N)
        The filter reaches about 1/cutoff (s) to both sides, so that much at either end rests on
        the extension.

    Raises
    ------
    InputError
        For dt <= 0, a cut-off outside (0, Nyquist] or values that are not finite.

    Examples
    --------
    >>> t = np.arange(2000) / 1000
    >>> y = low_pass(np.sin(30 * t) + 0.01 * np.sin(2000 * t), 1e-3, cutoff=10.0)
    >>> bool(np.max(np.abs(y - np.sin(30 * t))[300:-300]) < 1e-3)
    True
    """
    result: Array = band_limited_derivative(y, [0.0], dt, cutoff=cutoff, edge_noise=edge_noise)[0]
    return result


def band_limited_derivative(
    x: ArrayLike, orders: ArrayLike, dt: float, *, cutoff: float, edge_noise: float = 1e-6
) -> Array:
    r"""Differentiate records of any shape below a cut-off frequency.

    Each end is continued by the band-limited motion that fits it best (regularised least
    squares), fading to the level that the motion has in the mean, or starts from at rest. Then
    the spectrum is multiplied by :math:`(i\omega)^\alpha` and a smooth low-pass. So nothing
    wraps round and no phase is lost.

    Parameters
    ----------
    x : array_like, shape (..., N)
        Records.
    orders : array_like, shape (K,)
        Orders, -1 to 2.
    dt : float
        Sampling interval, s.
    cutoff : float
        Hz: all passes up to here, nothing above twice that. See `noise_cutoff`.
    edge_noise : float, optional
        Noise over signal that the extension beyond the ends reckons with, at least; what the
        record shows above the filter counts in any case.

    Returns
    -------
    ndarray, shape (K, ..., N)
        The derivative from minus infinity (Weyl) of a motion that was at that level before its
        start. Within about 1/cutoff (s) of the ends the result rests on the extension; orders
        below 1 remember the unknown past for longer.

    Raises
    ------
    InputError
        For orders outside [-1, 2], dt <= 0, a cut-off outside (0, Nyquist] or values that are
        not finite.

    Examples
    --------
    >>> t = np.arange(2000) / 1000
    >>> v = band_limited_derivative(np.sin(30 * t), [1.0], 1e-3, cutoff=10.0)[0]
    >>> bool(np.max(np.abs(v / 30 - np.cos(30 * t))[300:-300]) < 5e-3)
    True
    """
    return band_limited(x, dt, cutoff=cutoff, edge_noise=edge_noise)(orders)


def band_limited(
    x: ArrayLike, dt: float, *, cutoff: float, edge_noise: float = 1e-6
) -> Callable[[ArrayLike], Array]:
    """Return what differentiates records below a cut-off; their spectrum is taken once.

    Parameters
    ----------
    x, dt, cutoff, edge_noise
        As of `band_limited_derivative`.

    Returns
    -------
    callable
        Maps orders (K,) to derivatives (K, ..., N).

    Raises
    ------
    InputError
        As `band_limited_derivative`; for orders where they are given.

    Examples
    --------
    >>> t = np.arange(2000) / 1000
    >>> differentiate = band_limited(np.sin(30 * t), 1e-3, cutoff=10.0)
    >>> differentiate([0.5, 1.0]).shape
    (2, 2000)
    """
    values, step = checked_record(x, dt, min_samples=4)
    limit = number("cutoff", cutoff, above=0.0, at_most=0.5 / step)
    samples = values.shape[-1]
    rows = values.reshape(-1, samples)
    added = max(int(math.ceil(_ADDED / (limit * step))), 4)
    fitted = min(samples, max(int(math.ceil(_FITTED / (limit * step))), 8))
    level = _level(rows, fitted)
    centred = rows - level
    least = number("edge_noise", edge_noise, above=0.0)
    ratio = np.maximum(_out_of_band(centred, limit * step), least)
    fit = end_fit(fitted, added, limit * step)
    length = int(scipy.fft.next_fast_len(2 * samples + 2 * added, real=True))
    extended = np.zeros((rows.shape[0], length))
    extended[:, :samples] = centred
    extended[:, samples : samples + added] = continue_record(
        centred[:, samples - fitted :], fit, ratio
    )
    extended[:, length - added :] = continue_record(
        centred[:, :fitted][:, ::-1], fit, ratio
    )[:, ::-1]
    frequency = scipy.fft.rfftfreq(length, step)
    frequency = frequency[: np.searchsorted(frequency, TRANSITION * limit) + 1]
    passing = lowest_lines(length, frequency.size)  # beyond them nothing passes
    spectrum = passing.of(extended)
    shape = values.shape

    def differentiate(orders: ArrayLike) -> Array:
        alpha, _ = checked_orders(orders)
        factors = harmonic_factors(alpha, 2.0 * np.pi * frequency)
        factors = factors * low_pass_gain(frequency, limit)
        out = np.empty((alpha.size, spectrum.shape[0], samples))
        for k in range(alpha.size):
            out[k] = passing.series(factors[k] * spectrum, samples)
            if alpha[k] == 0.0:
                out[k] += level
        return out.reshape(alpha.size, *shape)

    return differentiate


def _out_of_band(centred: Array, band: float) -> Array:
    """Rms of what the low-pass removes altogether, over the rms of all, (R,)."""
    samples = centred.shape[1]
    length = int(scipy.fft.next_fast_len(samples, real=True))
    power = np.abs(scipy.fft.rfft(centred * kaiser_window(samples, _KAISER), length)) ** 2
    above = power[:, scipy.fft.rfftfreq(length) > TRANSITION * band].sum(axis=1)
    share = np.sqrt(above / np.maximum(power.sum(axis=1), 1e-300))
    return np.asarray(np.minimum(share, 1.0))


def _level(rows: Array, fitted: int) -> Array:
    """Level before the record and far behind it, (R, 1).

    A record that starts at rest was at rest before; any other one moves about its mean.
    """
    start = rows[:, :fitted]
    quiet = start.std(axis=1) <= _QUIET * rows.std(axis=1)
    level: Array = np.where(quiet, start.mean(axis=1), rows.mean(axis=1))
    return level[:, None]


def noise_cutoff(x: ArrayLike, dt: float, order: float = 2.0) -> float:
    r"""Choose the cut-off above which differentiating adds more noise than signal.

    Minimises the expected error of the derivative: signal lost above the cut-off plus noise
    let through below, both weighted by :math:`\omega^{2\alpha}`. The noise floor is the level
    of the second quietest quarter of the spectrum's upper half.

    Parameters
    ----------
    x : array_like, shape (..., N)
        Records; one cut-off serves them all (the highest that one of them calls for).
    dt : float
        Sampling interval, s.
    order : float, optional
        Highest order wanted.

    Returns
    -------
    float
        Hz, between four cycles per record and the Nyquist frequency. A record without noise
        gives what rounding leaves.

    Raises
    ------
    InputError
        For an order outside [-1, 2], dt <= 0 or values that are not finite.

    Examples
    --------
    >>> t = np.arange(10000) / 1000
    >>> noise = 1e-4 * np.random.default_rng(1).standard_normal(t.size)
    >>> bool(5.0 < noise_cutoff(np.sin(10 * np.pi * t) + noise, 1e-3, 0.0) < 8.0)
    True
    """
    values, step = checked_record(x, dt, min_samples=16)
    alpha = float(checked_orders(order)[0][0])
    samples = values.shape[-1]
    rows = values.reshape(-1, samples)
    window = kaiser_window(samples, _KAISER)
    power = np.abs(scipy.fft.rfft((rows - rows.mean(axis=1, keepdims=True)) * window)) ** 2
    frequency = scipy.fft.rfftfreq(samples, step)
    nyquist = 0.5 / step
    parts = np.array_split(power[:, frequency >= 0.5 * nyquist], 4, axis=1)
    # The second quietest quarter: chance makes the quietest of short records too low.
    floors = np.sort([np.median(part, axis=1) for part in parts], axis=0)[1] / math.log(2.0)
    weight = np.where(frequency > 0.0, frequency, frequency[1]) ** (2.0 * alpha)
    highest = 0.0
    for spectrum, floor in zip(power, floors, strict=True):
        signal = np.where(spectrum > _CLEAR * floor, spectrum - floor, 0.0)
        lost = np.cumsum((signal * weight)[::-1])[::-1]
        passed = np.cumsum(floor * weight)
        cost = passed.copy()
        cost[:-1] += lost[1:]
        highest = max(highest, float(frequency[int(np.argmin(cost))]))
    lowest = min(4.0 / (samples * step), nyquist)
    return float(min(max(highest, lowest), nyquist))

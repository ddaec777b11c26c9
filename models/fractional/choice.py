"""The scheme that suits a record: by its noise, its smoothness and whether it repeats."""

from __future__ import annotations

import functools
import math
from dataclasses import dataclass

import numpy as np

from models.fractional.band_limit import noise_cutoff
from models.fractional.harmonics import HarmonicFit, fit_harmonics
from models.fractional.kinks import Kink, find_kinks
from models.fractional.noise import Roughness, roughness
from models.fractional.orders import Array
from models.fractional.spectral import TRANSITION
from models.fractional.weights import BDF_STEPS, convolution_weights, symbol_series

# Expected relative errors above which a fit of harmonics, or a low-pass, is tried instead.
_FIT_ABOVE = 1e-5
_FILTER_ABOVE = 3e-3
# A fit explains a record where it leaves no more than this times the noise.
_EXPLAINED = 1.25
_NORM_WEIGHTS = 64
_JUNCTION = 6


@dataclass(frozen=True)
class Choice:
    """A scheme and what it needs."""

    scheme: str
    """"bdf2" to "bdf6", "spectral", "harmonics" or "band-limited"."""
    cutoff: float | None = None
    """Hz, where there is a low-pass."""
    fits: tuple[HarmonicFit, ...] = ()
    """One for each record, for "harmonics"."""
    kinks: tuple[tuple[Kink, ...], ...] = ()
    """Those of each record, where some record has any."""


def expected_noise(measured: Roughness, orders: Array, p: int) -> Array:
    """Relative rms error, (K,), that noise makes in a BDF scheme of `p` steps.

    Examples
    --------
    >>> t = np.arange(2000) / 1000
    >>> noise = 1e-4 * np.random.default_rng(0).standard_normal(t.size)
    >>> measured = roughness(np.sin(30 * t) + noise)
    >>> bool(expected_noise(measured, np.array([1.9]), 1)[0] > 0.1)
    True
    """
    gain = _noise_gain(tuple(orders.tolist()), p)
    return np.asarray(measured.noise * gain / _scaled_size(measured, orders))


@functools.lru_cache(maxsize=64)
def _noise_gain(orders: tuple[float, ...], p: int) -> Array:
    """Rms of the derivative of white noise of unit size and sampling interval, (K,)."""
    gain: Array = np.linalg.norm(convolution_weights(np.array(orders), _NORM_WEIGHTS, p), axis=1)
    return gain


def expected_truncation(measured: Roughness, orders: Array, p: int) -> Array:
    """Relative rms error, (K,), that a BDF scheme of `p` steps makes on a smooth record.

    Examples
    --------
    >>> measured = roughness(np.sin(0.03 * np.arange(2000)))
    >>> bool(0.01 < expected_truncation(measured, np.array([1.5]), 1)[0] < 0.05)
    True
    """
    size = max(measured.size, 1e-300)
    # The second holds for what is smooth but for its start, as a ramp is.
    ratio = max(measured.differences[p - 1] / size, (measured.differences[0] / size) ** p)
    return np.asarray(np.abs(symbol_series(orders, p)[:, p]) * ratio)


def _scaled_size(measured: Roughness, orders: Array) -> Array:
    """Size of the derivative times dt^order, (K,), as if the record had one frequency."""
    size = max(measured.size, 1e-300)
    turn = max(measured.differences[0] / size, 1e-300)
    return np.asarray(np.maximum(size * turn**orders, 1e-300))


def best_steps(rows: Array, orders: Array) -> tuple[str, float]:
    """Return the BDF scheme that balances truncation against noise, and its expected error.

    Parameters
    ----------
    rows : ndarray, shape (R, N)
    orders : ndarray, shape (K,)

    Returns
    -------
    name : str
        "bdf2" to "bdf6".
    error : float
        Relative rms error of the worst order and record.

    Examples
    --------
    >>> best_steps(np.sin(0.05 * np.arange(1000))[None], np.array([0.5]))[0]
    'bdf6'
    """
    measured = [roughness(row) for row in rows]
    errors = {}
    for name, p in BDF_STEPS.items():
        if name != "gl":
            each = [
                np.hypot(expected_noise(m, orders, p), expected_truncation(m, orders, p))
                for m in measured
            ]
            errors[name] = float(np.max(each))
    best = min(errors, key=lambda name: errors[name])
    return best, errors[best]


def choose_causal(rows: Array, orders: Array, dt: float) -> Choice:
    """Choose for a derivative from the first sample on.

    The number of steps balances truncation against noise, as both are seen in the record.
    Kinks of a clean record are found and treated apart. Where noise spoils all schemes, a
    record of few harmonics is replaced by their fit, any other one low-passed.

    Parameters
    ----------
    rows : ndarray, shape (R, N)
    orders : ndarray, shape (K,)
    dt : float

    Returns
    -------
    Choice

    Examples
    --------
    >>> x = np.sin(0.001 * np.arange(20000) ** 1.2)
    >>> choose_causal(x[None], np.array([0.5]), 1.0).scheme in BDF_STEPS
    True
    """
    name, error = best_steps(rows, orders)
    if error <= _FIT_ABOVE or rows.shape[1] < 32:
        kinks = tuple(find_kinks(row) for row in rows)
        return Choice(name, kinks=kinks if any(kinks) else ())
    best = Choice(name)
    fits = _explaining_fits(rows, [roughness(row) for row in rows])
    if fits:
        return Choice("harmonics", fits=fits)
    if error <= _FILTER_ABOVE:
        return best
    cutoff = noise_cutoff(rows, dt, float(orders.max()))
    return Choice("band-limited", cutoff) if TRANSITION * cutoff * dt < 0.5 else best


def choose_steady(rows: Array, orders: Array, dt: float) -> Choice:
    """Choose for a derivative from minus infinity.

    Clean whole periods are differentiated by their spectrum, records of few harmonics by their
    fit, and anything else below a cut-off.

    Parameters
    ----------
    rows : ndarray, shape (R, N)
    orders : ndarray, shape (K,)
    dt : float

    Returns
    -------
    Choice

    Examples
    --------
    >>> x = np.sin(2 * np.pi * np.arange(250) / 100)
    >>> choose_steady(x[None], np.array([0.5]), 0.01).scheme
    'harmonics'
    """
    measured = [roughness(row) for row in rows]
    noisy = any(m.noise > 1e-9 * m.size for m in measured)
    periodic = all(_closes(row) for row in rows)
    if periodic and not noisy:
        return Choice("spectral")
    fits = _explaining_fits(rows, measured)
    if fits:
        return Choice("harmonics", fits=fits)
    if rows.shape[1] < 16:
        return Choice("spectral")
    cutoff = noise_cutoff(rows, dt, float(orders.max()))
    return Choice("spectral" if periodic else "band-limited", cutoff)


def _explaining_fits(rows: Array, measured: list[Roughness]) -> tuple[HarmonicFit, ...]:
    """Return fits of harmonics if they leave nothing but noise in every record, else nothing."""
    fits = []
    for row, m in zip(rows, measured, strict=True):
        fit = fit_harmonics(row)
        # Phase accumulates rounding in proportion to the length.
        rounding = 1e-15 * row.size * m.size
        if fit is None or fit.residual > max(_EXPLAINED * m.noise, min(rounding, 1e-9 * m.size)):
            return ()
        fits.append(fit)
    return tuple(fits)


def _closes(x: Array) -> bool:
    """Whether the record goes on from its end to its start as smoothly as it runs inside."""
    if x.size < 4 * _JUNCTION:
        return True
    joined = np.concatenate([x[-2 * _JUNCTION :], x[: 2 * _JUNCTION]])
    inside, across = x, joined
    for d in range(1, _JUNCTION + 1):
        inside, across = np.diff(inside), np.diff(across)
        # Differences of order d that take samples from both sides of the junction.
        middle = across[2 * _JUNCTION - d : 2 * _JUNCTION]
        rounding = math.comb(2 * d, d) ** 0.5 * 4e-16 * float(np.max(np.abs(x)))
        if np.max(np.abs(middle)) > 1.5 * np.max(np.abs(inside)) + 4.0 * rounding:
            return False
    return True

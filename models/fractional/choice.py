"""The scheme that suits a record: by its noise, its smoothness and whether it repeats."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from models.fractional.band_limit import noise_cutoff
from models.fractional.harmonics import HarmonicFit, fit_harmonics
from models.fractional.kinks import find_kinks
from models.fractional.noise import Roughness, roughness
from models.fractional.orders import Array
from models.fractional.quadrature import Quadrature, best_quadrature
from models.fractional.spectral import TRANSITION
from models.fractional.start import Start, fit_start

# Expected relative errors above which a fit of harmonics, or a low-pass, is tried instead.
_FIT_ABOVE = 1e-5
_FILTER_ABOVE = 3e-3
# A fit explains a record where it leaves no more than this times the noise.
_EXPLAINED = 1.25
_JUNCTION = 6


@dataclass(frozen=True)
class Choice:
    """A scheme and what it needs."""

    scheme: str
    """"bdf2" to "bdf6", "spectral", "harmonics" or "band-limited"."""
    stride: int = 1
    """Samples between the points of the backward differences, for "bdf..."."""
    cutoff: float | None = None
    """Hz, where there is a low-pass."""
    fits: tuple[HarmonicFit, ...] = ()
    """One for each record, for "harmonics"."""
    starts: tuple[tuple[Start, ...], ...] = ()
    """Of each record, that of the first sample and its kinks, for "bdf..."."""


def choose_causal(rows: Array, orders: Array, dt: float) -> Choice:
    """Choose for a derivative from the first sample on.

    Steps and stride of the quadrature balance truncation against noise, as both are seen in the
    record. Kinks are found and treated apart. Where noise spoils all schemes, a
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
    >>> choose_causal(x[None], np.array([0.5]), 1.0).scheme
    'bdf6'
    """
    best, starts = _quadrature(rows, orders)
    causal = Choice(best.scheme, best.stride, starts=starts)
    if best.error <= _FIT_ABOVE or rows.shape[1] < 32:
        return causal
    fits = _explaining_fits(rows, [roughness(row) for row in rows])
    if fits:
        return Choice("harmonics", fits=fits)
    if best.error <= _FILTER_ABOVE:
        return causal
    cutoff = noise_cutoff(rows, dt, float(orders.max()))
    low = TRANSITION * cutoff * dt < 0.5
    return Choice("band-limited", cutoff=cutoff) if low else causal


def _quadrature(
    rows: Array, orders: Array
) -> tuple[Quadrature, tuple[tuple[Start, ...], ...]]:
    """Return the quadrature for records without their kinks, and all starts.

    A stride that suits the record with its kinks is one that sees them. They are treated apart
    where that helps.
    """
    smooth = tuple((fit_start(row),) for row in rows)
    best = best_quadrature(rows, orders, smooth)
    kinks = [find_kinks(row, best.stride) for row in rows]
    starts = tuple((*own, *more) for own, more in zip(smooth, kinks, strict=True))
    if any(kinks):
        apart = best_quadrature(rows, orders, starts)
        if apart.error < best.error:
            return apart, starts
    return best, smooth


def choose_clean(rows: Array, orders: Array) -> Choice:
    """Choose for a derivative from the first sample on of smoothed records.

    Parameters
    ----------
    rows : ndarray, shape (R, N)
    orders : ndarray, shape (K,)

    Returns
    -------
    Choice

    Examples
    --------
    >>> choose_clean(np.sin(0.05 * np.arange(1000))[None], np.array([0.5])).scheme
    'bdf6'
    """
    starts = tuple((fit_start(row),) for row in rows)
    best = best_quadrature(rows, orders, starts)
    return Choice(best.scheme, best.stride, starts=starts)


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
    return Choice("spectral" if periodic else "band-limited", cutoff=cutoff)


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

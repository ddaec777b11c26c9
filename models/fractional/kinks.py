"""Kinks inside a record: where one smooth motion gives way to another."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from models.fractional.causal import causal_derivative
from models.fractional.correction import (
    HEAD_SAMPLES,
    MOMENTS,
    POWERS,
    end_corrections,
    head_corrections,
)
from models.fractional.orders import Array
from models.fractional.start import DEGREE, start_coefficients
from models.fractional.weights import BDF_STEPS

_DIFFERENCES = 6
# A difference this many times the rms of all, or of its neighbourhood, is no part of them.
_OUTSTANDING = 15.0
_NEIGHBOURHOOD = 64
_MOST = 16
_ROOM = 3 * DEGREE
# What continuous derivatives may leave at the kink, over its first jump.
_CONTINUOUS = 1e-2
_SMOOTHEST = 5


@dataclass(frozen=True)
class Kink:
    """A jump in some derivative."""

    position: float
    """Samples from the first one; need not be whole."""
    jumps: Array
    """(6,) Taylor coefficients of the motion after less the motion before, per sample^k."""


def find_kinks(x: Array) -> tuple[Kink, ...]:
    """Find where derivatives of a smooth record jump.

    High differences of a smooth record are small; over a kink they stand out for six samples.
    The motions on both sides are continued to each other, and the kink lies where as many of
    their derivatives agree as can.

    Parameters
    ----------
    x : ndarray, shape (N,)

    Returns
    -------
    tuple of Kink
        In order; empty for records that are noisy, smooth, or rough throughout.

    Examples
    --------
    >>> t = np.arange(2000) / 500
    >>> kinks = find_kinks(np.sin(t) + np.clip(t - 2.0007, 0.0, None) ** 3)
    >>> [round(kink.position, 3) for kink in kinks]
    [1000.35]
    """
    spans = _outstanding(x)
    found = []
    for i, (before, after) in enumerate(spans):
        first = spans[i - 1][1] if i else 0
        last = spans[i + 1][0] if i + 1 < len(spans) else x.size - 1
        if before - first < _ROOM or last - after < _ROOM:
            continue
        kink = _between(x[first : before + 1], x[after : last + 1], before, after)
        if kink is not None and kink.position + MOMENTS + 1 < x.size:
            found.append(kink)
    return tuple(found)


def kinked_derivative(
    x: Array,
    orders: Array,
    dt: float,
    kinks: Sequence[Sequence[Kink]],
    *,
    scheme: str,
    caputo: bool,
) -> Array:
    """Differentiate as `causal_derivative` does, each kink treated like a start of its own.

    Parameters
    ----------
    x : ndarray, shape (R, N)
    orders : ndarray, shape (K,)
    dt : float
    kinks : sequence of R sequences
    scheme : str
    caputo : bool

    Returns
    -------
    ndarray, shape (K, R, N)

    Examples
    --------
    >>> t = np.arange(2000) / 500
    >>> x = np.clip(t - 2.0007, 0.0, None) ** 3
    >>> exact = 6 * np.clip(t - 2.0007, 0.0, None) ** 1.5 / 1.329340388179137
    >>> y = kinked_derivative(
    ...     x[None], np.array([1.5]), 1 / 500, [find_kinks(x)], scheme="bdf5", caputo=True
    ... )
    >>> bool(np.max(np.abs(y[0, 0] - exact)) < 1e-5)
    True
    """
    source = x.copy()
    for row, its in zip(source, kinks, strict=True):
        for kink in its:
            first, offset = _next_sample(kink)
            row[first : first + MOMENTS] += kink.jumps @ end_corrections(POWERS, offset)
    out = causal_derivative(source, orders, dt, scheme=scheme, caputo=caputo)
    scales = dt**-orders[:, None]
    for r, its in enumerate(kinks):
        for kink in its:
            first, offset = _next_sample(kink)
            rest = head_corrections(tuple(orders.tolist()), BDF_STEPS[scheme], POWERS, offset)
            size = min(HEAD_SAMPLES, x.shape[1] - first)
            out[:, r, first : first + size] += scales * (kink.jumps @ rest)[:, :size]
    return out


def _next_sample(kink: Kink) -> tuple[int, float]:
    """First sample behind the kink and how far behind, 0 < offset <= 1."""
    first = int(np.floor(kink.position)) + 1
    return first, first - kink.position


def _outstanding(x: Array) -> list[tuple[int, int]]:
    """Return the last sample surely before and the first surely after each suspected kink."""
    if x.size < 4 * _ROOM:
        return []
    rough = np.abs(np.diff(x, n=_DIFFERENCES))
    level = float(np.sqrt(np.mean(rough**2)))
    if float(rough.max()) < _OUTSTANDING * level:
        return []
    spans: list[tuple[int, int]] = []
    # Kinks of different size: each time the largest one left, judged by its neighbourhood.
    left = rough.copy()
    for _ in range(_MOST + 1):
        peak = int(np.argmax(left))
        around = rough[max(peak - _NEIGHBOURHOOD, 0) : peak + _NEIGHBOURHOOD]
        typical = float(np.median(around))
        if left[peak] < _OUTSTANDING * max(typical, 1e-300) or left[peak] < 1e-3 * rough.max():
            break
        near = np.arange(max(peak - _DIFFERENCES, 0), min(peak + _DIFFERENCES + 1, rough.size))
        high = near[rough[near] > 8.0 * typical]
        before = int(min(high[-1], high[0] + _DIFFERENCES - 1)) - 1
        after = int(max(high[0] + _DIFFERENCES, high[-1] + 1)) + 1
        spans.append((before, after))
        left[max(before - 2 * _DIFFERENCES, 0) : after + _DIFFERENCES] = 0.0
    return sorted(spans) if len(spans) <= _MOST else []


def _between(left: Array, right: Array, before: int, after: int) -> Kink | None:
    """Return the kink between two smooth stretches that end at `before` and start at `after`."""
    count = DEGREE + 1
    backwards = start_coefficients(np.ascontiguousarray(left[::-1]), count)
    backwards = backwards * (-1.0) ** np.arange(count)
    middle = 0.5 * (before + after)
    half = middle - before
    jump = np.polynomial.Polynomial(start_coefficients(right, count))
    jump = jump(np.polynomial.Polynomial([-half, 1.0]))
    jump -= np.polynomial.Polynomial(backwards)(np.polynomial.Polynomial([half, 1.0]))
    for m in range(_SMOOTHEST, 0, -1):
        place = _nearest_root(jump.deriv(m - 1), half + 1.0)
        if place is None:
            continue
        shifted = np.asarray(jump(np.polynomial.Polynomial([place, 1.0])).coef, dtype=np.float64)
        local: Array = np.pad(shifted, (0, count))[:POWERS]
        if np.max(np.abs(local[:m]), initial=0.0) <= _CONTINUOUS * abs(local[m]):
            local[:m] = 0.0
            return Kink(middle + place, local)
    return None


def _nearest_root(polynomial: np.polynomial.Polynomial, reach: float) -> float | None:
    """Return the real root closest to zero within `reach`."""
    roots = polynomial.roots()
    real = roots.real[np.abs(roots.imag) < 1e-9 * (1.0 + np.abs(roots.real))]
    near = real[np.abs(real) <= reach]
    return float(near[np.argmin(np.abs(near))]) if near.size else None

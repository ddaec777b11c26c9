"""Kinks inside a record: where one smooth motion gives way to another."""

from __future__ import annotations

import numpy as np
from numpy.polynomial import Polynomial
from numpy.polynomial.polynomial import polyval
from numpy.typing import NDArray

from models.fractional.blocks import blocks
from models.fractional.correction import MOMENTS
from models.fractional.orders import Array
from models.fractional.start import DEGREE, Start, fit_start

_DIFFERENCES = 6
# A difference this many times the rms of all, or of its neighbourhood, is no part of them.
_OUTSTANDING = 15.0
_NEIGHBOURHOOD = 64
_MOST = 16
_ROOM = 3 * DEGREE
# What continuous derivatives may leave at the kink, over its first jump.
_CONTINUOUS = 1e-2
_SMOOTHEST = 5
# What a kink leaves of the differences that stand out, at most.
_LEFT = 0.1
# Of a position in samples: no better known, and a kink at a sample shall lie there.
_DIGITS = 3


def find_kinks(x: Array, stride: int = 1) -> tuple[Start, ...]:
    """Find where derivatives of a smooth record jump.

    High differences of a smooth record are small; over a kink they stand out for six samples.
    The motions on both sides are continued to each other, and the kink lies where as many of
    their derivatives agree as can.

    Parameters
    ----------
    x : ndarray, shape (N,)
    stride : int, optional
        Samples from one point of the differences to the next: a long one sees kinks that
        rounding or noise hide from neighbouring samples.

    Returns
    -------
    tuple of Start
        In order; empty for records that are noisy, smooth, or rough throughout.

    Examples
    --------
    >>> t = np.arange(2000) / 500
    >>> kinks = find_kinks(np.sin(t) + np.clip(t - 2.0007, 0.0, None) ** 3)
    >>> [round(kink.position, 3) for kink in kinks]
    [1000.35]
    """
    thinned = _outstanding(x[::stride])
    spans = [(stride * before, stride * after) for before, after in thinned]
    room = stride * _ROOM
    found = []
    for i, (before, after) in enumerate(spans):
        first = spans[i - 1][1] if i else 0
        last = spans[i + 1][0] if i + 1 < len(spans) else x.size - 1
        if before - first < room or last - after < room:
            continue
        kink = _between(x[first : before + 1], x[after : last + 1], before, after)
        if kink is None or kink.position + MOMENTS + 1 >= x.size:
            continue
        around = np.arange(before - room // 2, after + room // 2, stride)
        if _explains(kink, x[around], around):
            found.append(kink)
    return tuple(found)


def find_starts(x: Array, stride: int = 1) -> tuple[Start, ...]:
    """Return the start at the first sample and that at each kink.

    Examples
    --------
    >>> t = np.arange(2000) / 500
    >>> starts = find_starts(np.sin(t) + np.clip(t - 2.0007, 0.0, None) ** 3)
    >>> [start.first for start in starts]
    [0, 1001]
    """
    return (fit_start(x), *find_kinks(x, stride))


def _outstanding(x: Array) -> list[tuple[int, int]]:
    """Return the last sample surely before and the first surely after each suspected kink."""
    if x.size < 4 * _ROOM:
        return []
    largest, squares, count = 0.0, 0.0, x.size - _DIFFERENCES
    for part in blocks(0, count):
        rough = np.diff(x[part.start : part.stop + _DIFFERENCES], n=_DIFFERENCES)
        largest = max(largest, float(rough.max()), -float(rough.min()))
        squares += float(rough @ rough)
    if largest < _OUTSTANDING * np.sqrt(squares / count):
        return []
    rough = np.abs(np.diff(x, n=_DIFFERENCES))
    spans: list[tuple[int, int]] = []
    # Kinks of different size: each time the largest one left, judged by its neighbourhood.
    left = rough.copy()
    for _ in range(_MOST + 1):
        peak = int(np.argmax(left))
        around = rough[max(peak - _NEIGHBOURHOOD, 0) : peak + _NEIGHBOURHOOD]
        typical = float(np.median(around))
        if left[peak] < _OUTSTANDING * max(typical, 1e-300) or left[peak] < 1e-3 * largest:
            break
        near = np.arange(max(peak - _DIFFERENCES, 0), min(peak + _DIFFERENCES + 1, rough.size))
        high = near[rough[near] > 8.0 * typical]
        before = int(min(high[-1], high[0] + _DIFFERENCES - 1)) - 1
        after = int(max(high[0] + _DIFFERENCES, high[-1] + 1)) + 1
        spans.append((before, after))
        left[max(before - 2 * _DIFFERENCES, 0) : after + _DIFFERENCES] = 0.0
    return sorted(spans) if len(spans) <= _MOST else []


def _between(left: Array, right: Array, before: int, after: int) -> Start | None:
    """Return the kink between two smooth stretches that end at `before` and start at `after`."""
    backwards = fit_start(np.ascontiguousarray(left[::-1])).motion
    backwards = backwards * (-1.0) ** np.arange(backwards.size)
    fit = fit_start(right)
    middle = 0.5 * (before + after)
    half = middle - before
    motion = Polynomial(fit.motion)(Polynomial([-half, 1.0]))
    jump = motion - Polynomial(backwards)(Polynomial([half, 1.0]))
    for m in range(_SMOOTHEST, 0, -1):
        root = _nearest_root(jump.deriv(m - 1), half + 1.0)
        if root is None:
            continue
        place = round(middle + root, _DIGITS) - middle
        jumps = _taylor(jump, place)
        if np.max(np.abs(jumps[:m]), initial=0.0) <= _CONTINUOUS * abs(jumps[m]):
            jumps[:m] = 0.0
            return Start(middle + place, _taylor(motion, place), jumps, fit.width)
    return None


def _explains(kink: Start, x: Array, n: NDArray[np.intp]) -> bool:
    """Whether the samples are smooth but for the kink."""
    behind = np.clip(n - kink.position, 0.0, None)
    left = x - polyval(behind, kink.jumps) * (behind > 0.0)
    with_it, without = (np.max(np.abs(np.diff(y, n=_DIFFERENCES))) for y in (x, left))
    return bool(without < _LEFT * with_it)


def _taylor(polynomial: Polynomial, place: float) -> Array:
    """Coefficients about `place`, (9,)."""
    shifted = polynomial(Polynomial([place, 1.0])).coef
    return np.pad(np.asarray(shifted, dtype=np.float64), (0, DEGREE + 1))[: DEGREE + 1]


def _nearest_root(polynomial: Polynomial, reach: float) -> float | None:
    """Return the real root closest to zero within `reach`."""
    roots = polynomial.roots()
    real = roots.real[np.abs(roots.imag) < 1e-9 * (1.0 + np.abs(roots.real))]
    near = real[np.abs(real) <= reach]
    return float(near[np.argmin(np.abs(near))]) if near.size else None

"""Whole derivatives from the first sample on, by backward differences over a stride."""

from __future__ import annotations

import functools
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.polynomial import polynomial
from numpy.typing import NDArray

from models.fractional.blocks import BLOCK, blocks
from models.fractional.orders import Array
from models.fractional.start import Start
from models.fractional.weights import difference_polynomial


@dataclass(frozen=True)
class Split:
    r"""Orders as whole derivatives and integrals of them, :math:`D^\alpha = I^{m-\alpha}D^m`."""

    wholes: tuple[int, ...]
    """(V,) the m that occur, ascending."""
    choice: NDArray[np.intp]
    """(K,) which of them each order takes: the least one that is not below it."""
    rest: Array
    """(K,) orders that are left, -1 to 0."""


def split_orders(orders: Array) -> Split:
    """Split orders into whole derivatives and integrals of them.

    Examples
    --------
    >>> split = split_orders(np.array([-0.5, 0.75, 1.0, 1.25]))
    >>> split.wholes, split.choice.tolist(), split.rest.tolist()
    ((0, 1, 2), [0, 1, 1, 2], [-0.5, -0.25, 0.0, -0.75])
    """
    each = np.maximum(np.ceil(orders), 0.0)
    wholes, choice = np.unique(each, return_inverse=True)
    return Split(tuple(int(m) for m in wholes), choice, orders - each)


def reach(whole: int, steps: int, stride: int) -> int:
    """Return how many samples back a backward difference looks.

    Examples
    --------
    >>> reach(2, 6, 10)
    120
    """
    return whole * steps * stride


def backward_difference(
    x: Array, whole: int, steps: int, stride: int, *, past: int = 0
) -> Array:
    r"""Apply :math:`(\delta(E^{-s})/s)^m`, E the shift by one sample; zeros before the first.

    Parameters
    ----------
    x : ndarray, shape (N,)
    whole : int
        m, 0 to 2.
    steps : int
        Steps p of the backward difference formula: the error is of order (s dt)^p.
    stride : int
        s. Noise, and rounding with it, is amplified by s^-m only.
    past : int, optional
        Samples at the start that are only looked back at.

    Returns
    -------
    ndarray, shape (N - past,)
        Per sample^m.

    Examples
    --------
    >>> backward_difference(np.arange(5.0) ** 2, 1, 2, 1)
    array([0. , 1.5, 4. , 6. , 8. ])
    """
    # Plain differences first: of neighbours they are exact, and the rest, whose taps add up to
    # one, rounds what is small already.
    plain = x
    for _ in range(whole):
        plain = np.concatenate([plain[:stride], plain[stride:] - plain[:-stride]])
    taps = _taps(whole, steps) / float(stride) ** whole
    out: Array = taps[0] * plain[past:]
    term: Array = np.empty(out.size)
    for lag, tap in zip(range(stride, x.size, stride), taps[1:], strict=False):
        first = max(lag - past, 0)
        np.multiply(plain[past - lag + first : x.size - lag], tap, out=term[first:])
        out[first:] += term[first:]
    return out


@functools.cache
def _taps(whole: int, steps: int) -> Array:
    """Coefficients of (delta(zeta) / (1 - zeta))^m."""
    rest = [float(sum(difference_polynomial(steps)[: k + 1])) for k in range(steps)]
    return np.asarray(polynomial.polypow(rest, whole), dtype=np.float64)


def whole_derivative(
    x: Array, starts: Sequence[Start], whole: int, steps: int, stride: int, *, out: Array
) -> None:
    """Write the m-th derivative, each start's samples without those before it.

    Parameters
    ----------
    x : ndarray, shape (N,)
    starts : sequence of Start
        In order; the first one at the first sample.
    whole, steps, stride
        As for `backward_difference`.
    out : ndarray, shape (N,)
        Per sample^m.

    Examples
    --------
    >>> from models.fractional.start import fit_start
    >>> x = np.arange(30.0) ** 2
    >>> found = np.empty(30)
    >>> whole_derivative(x, [fit_start(x)], 2, 6, 1, out=found)
    >>> bool(np.allclose(found, 2.0))
    True
    """
    behind = reach(whole, steps, stride)
    for part in blocks(0, x.size, 4 * max(BLOCK, behind)):
        past = min(part.start, behind)
        seen = x[part.start - past : part.stop]
        out[part] = backward_difference(seen, whole, steps, stride, past=past)
    for start in starts:
        near = slice(start.first, start.first + behind)
        out[near] = started_derivative(x[near], start, whole, steps, stride)


def started_derivative(
    x: Array, start: Start, whole: int, steps: int, stride: int
) -> Array:
    """Return the m-th derivative behind a start: that of its fit, and of what the fit leaves.

    What is left has no past: it is differentiated as if it were zero before.

    Parameters
    ----------
    x : ndarray, shape (N,)
        Samples from the first one of the start on.
    start : Start
    whole, steps, stride
        As for `backward_difference`.

    Returns
    -------
    ndarray, shape (N,)
        Per sample^m.

    Examples
    --------
    >>> from models.fractional.start import fit_start
    >>> x = np.arange(30.0) ** 2
    >>> bool(np.allclose(started_derivative(x[:12], fit_start(x), 2, 6, 1), 2.0))
    True
    """
    n = np.arange(x.size) + start.offset
    left = x - polynomial.polyval(n, start.motion)
    fitted = polynomial.polyval(n, differentiated(start.motion, whole))
    return np.asarray(fitted + backward_difference(left, whole, steps, stride))


def differentiated(coefficients: Array, whole: int) -> Array:
    """Return the Taylor coefficients of the m-th derivative, (n - m,).

    Examples
    --------
    >>> differentiated(np.array([5.0, 4.0, 3.0]), 1)
    array([4., 6.])
    """
    return np.asarray(polynomial.polyder(coefficients, whole))

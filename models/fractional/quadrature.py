"""The causal quadrature that suits a record: steps and stride of its backward differences."""

from __future__ import annotations

import functools
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from models.fractional.differences import backward_difference, reach
from models.fractional.noise import roughness, smooth_differences
from models.fractional.orders import Array
from models.fractional.start import Start
from models.fractional.weights import BDF_STEPS, INTEGRAL_STEPS, convolution_weights

# The first of equals is taken.
_SCHEMES = ("bdf6", "bdf5", "bdf4", "bdf3", "bdf2")
_STEPS = np.array([BDF_STEPS[name] for name in _SCHEMES])
_NORM_WEIGHTS = 64
# Points that a stride leaves of a record, at least.
_RUN = 16
# Logarithm of a ratio that is hopeless, still far from overflow.
_LARGE = 300.0


@dataclass(frozen=True)
class Quadrature:
    """Steps and stride, and what they are expected to leave."""

    scheme: str
    """"bdf2" to "bdf6"."""
    stride: int
    """Samples from one point of the backward differences to the next."""
    error: float
    """Relative rms error of the worst order and record."""


def noise_gains(orders: Array, strides: Sequence[int]) -> Array:
    r"""Rms of the derivative of white noise of unit size, per sample^order.

    With stride 1 that is the norm of the weights of differences and integral together. A stride
    s divides it by :math:`s^m` where the integral behind the m-th difference passes mostly the
    noise's high frequencies, and by :math:`s^{\alpha+1/2}` where it passes mostly the low ones.

    Parameters
    ----------
    orders : ndarray, shape (K,)
    strides : sequence of S int

    Returns
    -------
    ndarray, shape (S, K, 6)
        For 1 to 6 steps.

    Examples
    --------
    >>> noise_gains(np.array([1.0]), [1, 10])[:, 0, 0].round(4)
    array([1.4142, 0.1414])
    """
    whole = np.maximum(np.ceil(orders), 0.0)
    powers = np.minimum(whole, np.abs(orders + 0.5))
    slower = np.array(strides, dtype=np.float64)[:, None] ** -powers
    return np.asarray(slower[:, :, None] * _norms(tuple(orders.tolist())))


@functools.lru_cache(maxsize=64)
def _norms(orders: tuple[float, ...]) -> Array:
    """Norms of the weights of each order and number of steps, (K, 6)."""
    whole = np.maximum(np.ceil(orders), 0.0)
    weights = convolution_weights(orders - whole, _NORM_WEIGHTS, INTEGRAL_STEPS)
    each = [
        [backward_difference(row, int(m), p, 1) for p in BDF_STEPS.values()]
        for row, m in zip(weights, whole, strict=True)
    ]
    norms: Array = np.linalg.norm(each, axis=2)
    return norms


def best_quadrature(
    rows: Array, orders: Array, starts: Sequence[Sequence[Start]]
) -> Quadrature:
    """Return steps and stride that balance truncation against noise.

    Strides are powers of two, and never look past the fit at a start.

    Parameters
    ----------
    rows : ndarray, shape (R, N)
    orders : ndarray, shape (K,)
    starts : sequence of R sequences
        Of each record, that of the first sample and the kinks.

    Returns
    -------
    Quadrature

    Examples
    --------
    >>> from models.fractional.start import fit_start
    >>> x = np.sin(0.05 * np.arange(1000))
    >>> best = best_quadrature(x[None], np.array([0.5]), [[fit_start(x)]])
    >>> best.scheme, best.stride
    ('bdf6', 1)
    """
    width = min(start.width for its in starts for start in its)
    most = max(int(np.ceil(orders.max())), 0)
    longest = min(width // reach(most, _STEPS[-1], 1), rows.shape[1] // _RUN) if most else 1
    strides = [1]
    while 2 * strides[-1] <= longest:
        strides.append(2 * strides[-1])
    each = [_errors(row, its, orders, strides) for row, its in zip(rows, starts, strict=True)]
    errors = np.max(each, axis=0)
    for s, stride in enumerate(strides[1:], start=1):
        errors[s, most * stride * _STEPS > width] = np.inf
    s, scheme = divmod(int(np.argmin(errors)), len(_SCHEMES))
    return Quadrature(_SCHEMES[scheme], strides[s], float(errors[s, scheme]))


def _errors(
    row: Array, starts: Sequence[Start], orders: Array, strides: Sequence[int]
) -> Array:
    """Relative rms errors of the worst order by truncation and noise, (S, 5)."""
    rough = roughness(row)
    highest = int(_STEPS[0]) + 2
    pieces = np.split(row, [start.first for start in starts[1:]])
    differences = [
        smooth_differences(pieces, rough.noise, highest=highest, stride=s) for s in strides
    ]
    # Logarithms of the sizes of the record and its differences, (S, 9).
    sizes = np.concatenate([np.full((len(strides), 1), rough.size), differences], axis=1)
    sizes = np.log(np.maximum(sizes, 1e-300))
    # And of those of fractional orders between them, (S, K, 7).
    below = np.where(orders > 1.0, 1, 0)
    higher = below[:, None] + np.arange(_STEPS[0] + 1)
    part = (orders - below)[:, None]
    between = (1.0 - part) * sizes[:, higher] + part * sizes[:, higher + 1]
    # A ramp has no second derivative: there, as if the record had one frequency.
    single = (1.0 - orders) * sizes[:, :1] + orders * sizes[:, 1:2]
    derived = np.maximum(between[:, :, 0], single)
    ratios = between[:, :, 1:] - derived[:, :, None]
    # The second holds for what is smooth but for its start, as a ramp is.
    ratios = np.maximum(ratios[:, :, _STEPS - 1], ratios[:, :, :1] * _STEPS)
    truncation = np.exp(np.minimum(ratios, _LARGE)) / (_STEPS + 1.0)
    # Differences and integral err with opposite signs, the integral over single samples.
    whole = np.maximum(np.ceil(orders), 0.0)
    fine = np.array(strides, dtype=np.float64)[:, None]
    integral = (whole - orders) * fine**-INTEGRAL_STEPS * truncation[:, :, 0]
    truncation = np.abs(whole[:, None] * truncation - integral[:, :, None])
    gains = noise_gains(orders, strides)[:, :, _STEPS - 1]
    noise = rough.noise * fine**orders * np.exp(np.minimum(-derived, _LARGE))
    return np.asarray(np.hypot(truncation, noise[:, :, None] * gains).max(axis=1))

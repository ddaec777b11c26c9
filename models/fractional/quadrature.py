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


def noise_gain(orders: Array, steps: int, stride: int) -> Array:
    r"""Rms, (K,), of the derivative of white noise of unit size, per sample^order.

    With stride 1 that is the norm of the weights of differences and integral together. A stride
    s divides it by :math:`s^m` where the integral behind the m-th difference passes mostly its
    high frequencies, and by :math:`s^{\alpha+1/2}` where it passes mostly the low ones.

    Parameters
    ----------
    orders : ndarray, shape (K,)
    steps, stride : int

    Examples
    --------
    >>> noise_gain(np.array([1.0]), 1, 10)
    array([0.14142136])
    """
    whole = np.maximum(np.ceil(orders), 0.0)
    slower = float(stride) ** -np.minimum(whole, np.abs(orders + 0.5))
    return np.asarray(_norms(tuple(orders.tolist()), steps) * slower)


@functools.lru_cache(maxsize=64)
def _norms(orders: tuple[float, ...], steps: int) -> Array:
    """Norms of the weights of each order."""
    alpha = np.array(orders)
    whole = np.maximum(np.ceil(alpha), 0.0)
    weights = convolution_weights(alpha - whole, _NORM_WEIGHTS, INTEGRAL_STEPS)
    each = [
        backward_difference(row, int(m), steps, 1) for row, m in zip(weights, whole, strict=True)
    ]
    norms: Array = np.linalg.norm(each, axis=1)
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
    measured = [_measure(row, its) for row, its in zip(rows, starts, strict=True)]
    width = min(start.width for its in starts for start in its)
    most = max(int(np.ceil(orders.max())), 0)
    best = Quadrature(_SCHEMES[-1], 1, np.inf)
    stride = 1
    while stride == 1 or 0 < reach(most, _STEPS[-1], stride) <= width:
        gains = np.stack([noise_gain(orders, BDF_STEPS[scheme], stride) for scheme in _SCHEMES])
        # (R, 2, 5): truncation and noise of each scheme.
        expected = np.array([_expected(m, orders, stride, gains) for m in measured])
        truncation, noise = expected.max(axis=0)
        for scheme, error in zip(_SCHEMES, np.hypot(truncation, noise), strict=True):
            fits = stride == 1 or reach(most, BDF_STEPS[scheme], stride) <= width
            if fits and error < best.error:
                best = Quadrature(scheme, stride, float(error))
        stride *= 2
    return best


@dataclass(frozen=True)
class _Measured:
    """What the errors of a quadrature follow from."""

    pieces: tuple[Array, ...]
    """Stretches of the record between its kinks."""
    size: float
    """rms about the mean."""
    noise: float
    """Standard deviation of the white part."""


def _measure(row: Array, starts: Sequence[Start]) -> _Measured:
    rough = roughness(row)
    pieces = tuple(np.split(row, [start.first for start in starts[1:]]))
    return _Measured(pieces, rough.size, rough.noise)


def _expected(measured: _Measured, orders: Array, stride: int, gains: Array) -> Array:
    """Relative rms errors of the worst order by truncation and noise, (2, 5)."""
    differences = smooth_differences(
        measured.pieces, measured.noise, highest=_STEPS[0] + 2, stride=stride
    )
    # Logarithms of the sizes of the record and its differences, (9,), and between them, (K, 7).
    sizes = np.log(np.maximum(np.concatenate([[measured.size], differences]), 1e-300))
    below = np.where(orders > 1.0, 1, 0)
    higher = below[:, None] + np.arange(_STEPS[0] + 1)
    part = (orders - below)[:, None]
    between = (1.0 - part) * sizes[higher] + part * sizes[higher + 1]
    # A ramp has no second derivative: there, as if the record had one frequency.
    derived = np.maximum(between[:, 0], (1.0 - orders) * sizes[0] + orders * sizes[1])[:, None]
    ratios = between[:, 1:] - derived
    # The second holds for what is smooth but for its start, as a ramp is.
    ratios = np.maximum(ratios[:, _STEPS - 1], np.multiply.outer(ratios[:, 0], _STEPS))
    whole = np.maximum(np.ceil(orders), 0.0)
    each = np.exp(np.minimum(ratios, _LARGE)) / (_STEPS + 1.0)
    # Differences and integral err with opposite signs, the integral over single samples.
    integral = (whole - orders) * each[:, 0] * float(stride) ** -INTEGRAL_STEPS
    truncation = np.abs(whole[:, None] * each - integral[:, None])
    noise = measured.noise * gains * np.exp(np.minimum(-derived[:, 0], _LARGE))
    noise *= float(stride) ** orders
    return np.stack([truncation.max(axis=0), noise.max(axis=1)])

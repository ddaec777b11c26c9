"""The causal quadrature that suits a record: steps and stride of its backward differences."""

from __future__ import annotations

import functools
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from models.fractional.differences import backward_difference, reach
from models.fractional.noise import above_noise, difference_powers, roughness, whole_noise
from models.fractional.orders import Array
from models.fractional.start import Start
from models.fractional.weights import BDF_STEPS, INTEGRAL_STEPS, convolution_weights

# The first of equals is taken.
_SCHEMES = ("bdf6", "bdf5", "bdf4", "bdf3", "bdf2")
_STEPS = np.array([BDF_STEPS[name] for name in _SCHEMES])
_NORM_WEIGHTS = 64
# Differences up to this one are needed, for the second derivative by six steps.
_HIGHEST = 8
# Truncation below which the rounding of the transforms is all that is left.
_ROUNDING = 1e-13
# Truncation below which differences are sure to see the motion.
_RESOLVED = 0.1
# Times the noise's error, below which truncation is no reason for a shorter stride: some of what
# passes for it is noise that is uneven.
_NOISY = 10.0
# Motion is what stands above so many times the noise of the whole record.
_PLAINLY = 4.0
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


def noise_gains(orders: Array, stride: int) -> Array:
    r"""Rms of the derivative of white noise of unit size, per sample^order.

    With stride 1 that is the norm of the weights of differences and integral together. A stride
    s divides it by :math:`s^m` where the integral behind the m-th difference passes mostly the
    noise's high frequencies, and by :math:`s^{\alpha+1/2}` where it passes mostly the low ones.

    Parameters
    ----------
    orders : ndarray, shape (K,)
    stride : int

    Returns
    -------
    ndarray, shape (K, 6)
        For 1 to 6 steps.

    Examples
    --------
    >>> noise_gains(np.array([1.0]), 10)[0, 0].round(4)
    np.float64(0.1414)
    """
    whole = np.maximum(np.ceil(orders), 0.0)
    powers = np.minimum(whole, np.abs(orders + 0.5))
    slower = float(stride) ** -powers
    return np.asarray(slower[:, None] * _norms(tuple(orders.tolist())))


# Kept: six numbers of each order, the same for all records.
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
    longest = min(width // reach(most, _STEPS[-1], 1), rows.shape[1] // _RUN) if most else 0
    measured = [_measure(row, its) for row, its in zip(rows, starts, strict=True)]
    best = Quadrature(_SCHEMES[-1], 1, np.inf)
    # From long strides, which are soon seen through, to where noise alone makes shorter ones
    # worse.
    for doublings in range(max(int(longest), 1).bit_length() - 1, -1, -1):
        stride = 2**doublings
        each = [_errors(m, orders, stride) for m in measured]
        truncation, noise = np.max(each, axis=0)
        errors = np.hypot(truncation, noise)
        if stride > 1:
            errors[most * stride * _STEPS > width] = np.inf
        scheme = int(np.argmin(errors))
        if errors[scheme] < best.error:
            best = Quadrature(_SCHEMES[scheme], stride, float(errors[scheme]))
        elif truncation[scheme] < min(_RESOLVED, _NOISY * noise[scheme]):
            break
        if truncation[scheme] < _ROUNDING:
            break
    return best


@dataclass(frozen=True)
class _Measured:
    """What the errors of a quadrature follow from."""

    pieces: list[Array]
    """Stretches of the record between its kinks."""
    size: float
    """rms about the mean."""
    noise: float
    """Standard deviation of the white part."""
    uneven: float
    """Its rms over the whole record, where it is larger in some parts than in others."""
    powers: Array
    """(8,) mean squares of the differences of neighbouring samples."""


def _measure(row: Array, starts: Sequence[Start]) -> _Measured:
    rough = roughness(row)
    pieces = np.split(row, [start.first for start in starts[1:]])
    powers = difference_powers(pieces, highest=_HIGHEST, stride=1)
    uneven = max(rough.noise, whole_noise(powers))
    return _Measured(pieces, rough.size, rough.noise, uneven, powers)


def _errors(measured: _Measured, orders: Array, stride: int) -> Array:
    """Relative rms errors of the worst order by truncation and noise, (2, 5)."""
    powers = measured.powers
    if stride > 1:
        powers = difference_powers(measured.pieces, highest=_HIGHEST, stride=stride)
    differences = above_noise(powers, measured.noise)
    seen = _between(np.concatenate([[measured.size], differences]), orders)
    # A pulse may lie between the points of a long stride: it makes no more than this.
    plain = above_noise(measured.powers, _PLAINLY * measured.uneven)
    growth = float(stride) ** np.arange(1, _HIGHEST + 1)
    differences = np.maximum(differences, plain * growth)
    most = _between(np.concatenate([[measured.size], differences]), orders)
    ratios = most[:, 1:] - seen[:, :1]
    # The second holds for what is smooth but for its start, as a ramp is.
    ratios = np.maximum(ratios[:, _STEPS - 1], ratios[:, :1] * _STEPS)
    truncation = np.exp(np.minimum(ratios, _LARGE)) / (_STEPS + 1.0)
    # Differences and integral err with opposite signs, the integral over single samples.
    whole = np.maximum(np.ceil(orders), 0.0)[:, None]
    integral = (whole - orders[:, None]) * truncation[:, :1] * float(stride) ** -INTEGRAL_STEPS
    truncation = np.abs(whole * truncation - integral)
    gains = noise_gains(orders, stride)[:, _STEPS - 1] * float(stride) ** orders[:, None]
    noise = measured.noise * gains * np.exp(np.minimum(-most[:, :1], _LARGE))
    return np.stack([truncation.max(axis=0), noise.max(axis=0)])


def _between(sizes: Array, orders: Array) -> Array:
    """Logarithms of sizes of differences of each order and of those 1 to 6 higher, (K, 7).

    Parameters
    ----------
    sizes : ndarray, shape (9,)
        Of the record and its whole differences.
    orders : ndarray, shape (K,)
    """
    logs = np.log(np.maximum(sizes, 1e-300))
    below = np.where(orders > 1.0, 1, 0)[:, None] + np.arange(_STEPS[0] + 1)
    part = orders[:, None] - below[:, :1]
    between = (1.0 - part) * logs[below] + part * logs[below + 1]
    # A ramp has no second derivative: there, as if the record had one frequency.
    single = (1.0 - orders) * logs[0] + orders * logs[1]
    between[:, 0] = np.maximum(between[:, 0], single)
    return np.asarray(between)

"""Noise floor and smoothness of a sampled record, seen in its differences."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from models.fractional.blocks import BLOCK, blocks
from models.fractional.orders import Array

_HIGHEST = 10
_BLOCKS = 8
_BLOCK_SAMPLES = 512
_FEWEST = 24
_GRAIN = 16


@dataclass(frozen=True)
class Roughness:
    """Size of a record and of its noise."""

    size: float
    """rms about the mean, in units of the record."""
    noise: float
    """Standard deviation of the white part, same unit."""


def roughness(x: Array) -> Roughness:
    """Measure the noise from a few blocks of consecutive samples.

    White noise of standard deviation s makes d-th differences of s sqrt(binomial(2d, d)); the
    motion's share falls with d where it is sampled well. The least estimate over d is kept, each
    the median over the blocks, so that a kink or a pulse does not count.

    Parameters
    ----------
    x : ndarray, shape (N,)

    Returns
    -------
    Roughness
        With fewer than 24 samples noise can't be told from motion and is taken as rounding.

    Examples
    --------
    >>> t = np.arange(4000) / 1000
    >>> noise = 1e-4 * np.random.default_rng(0).standard_normal(t.size)
    >>> bool(0.8e-4 < roughness(np.sin(30 * t) + noise).noise < 1.2e-4)
    True
    """
    mean = float(x.mean())
    squares = 0.0
    for part in blocks(0, x.size):
        centred = x[part] - mean
        squares += float(centred @ centred)
    size = math.sqrt(squares / x.size)
    rounding = np.finfo(np.float64).eps * max(float(x.max()), -float(x.min())) / 4.0
    if x.size < _FEWEST:
        return Roughness(size, rounding)
    estimates = []
    differences = _blocks(x, min(max(x.size // 4, _FEWEST), _BLOCK_SAMPLES))
    for d in range(1, _HIGHEST + 1):
        differences = differences[:, 1:] - differences[:, :-1]
        squares = np.einsum("bn,bn->b", differences, differences)
        estimates.append(squares / (differences.shape[1] * math.comb(2 * d, d)))
    noise = math.sqrt(float(np.median(estimates, axis=1).min()))
    return Roughness(size, max(noise, rounding))


def difference_powers(pieces: Sequence[Array], *, highest: int, stride: int) -> Array:
    """Return the mean squares of differences over a stride.

    Parameters
    ----------
    pieces : sequence of ndarrays, shape (n_i,)
        The stretches of a record between its kinks.
    highest : int
    stride : int
        Samples from one point of a difference to the next, a power of two.

    Returns
    -------
    ndarray, shape (highest,)
        First to highest differences; the highest that a piece is long enough for stands for
        those above it.

    Examples
    --------
    >>> t = np.arange(100.0)
    >>> difference_powers([t**2], highest=3, stride=4)[1:]
    array([1024.,    0.])
    """
    # A long stride starts at every 16th sample: pulses do not fall between.
    grain = min(stride, _GRAIN)
    lag = stride // grain
    squares, counts = [0.0] * highest, [0] * highest
    for piece in pieces:
        thinned = piece[::grain]
        for part in blocks(0, thinned.size, max(BLOCK, 4 * highest * lag)):
            differences = thinned[part]
            for d in range(min(highest, (differences.size - 1) // lag)):
                differences = differences[lag:] - differences[:-lag]
                squares[d] += float(differences @ differences)
                counts[d] += differences.size
    means = [total / count for total, count in zip(squares, counts, strict=True) if count]
    return np.array(means + means[-1:] * (highest - len(means)))


def above_noise(powers: Array, noise: float) -> Array:
    """Return the rms of differences less what white noise adds.

    Parameters
    ----------
    powers : ndarray, shape (D,)
        Mean squares of the first to D-th differences.
    noise : float
        Standard deviation of the white part.

    Returns
    -------
    ndarray, shape (D,)

    Examples
    --------
    >>> above_noise(np.array([4.0, 6.0]), 1.0).round(3)
    array([1.414, 0.   ])
    """
    return np.asarray(np.sqrt(np.maximum(powers - noise**2 * _gains(powers.size), 0.0)))


def whole_noise(powers: Array) -> float:
    """Return the rms noise of a whole record, however it is spread over it.

    Parameters
    ----------
    powers : ndarray, shape (D,)
        Mean squares of the first to D-th differences of neighbouring samples.

    Returns
    -------
    float
        Standard deviation; the least estimate over d, as the motion's share falls with d.

    Examples
    --------
    >>> whole_noise(np.array([4.0, 6.0]))
    1.0
    """
    return math.sqrt(float(np.min(powers / _gains(powers.size))))


def _gains(highest: int) -> Array:
    """Mean squares of the first to highest differences of white noise of unit size."""
    return np.array([float(math.comb(2 * d, d)) for d in range(1, highest + 1)])


def _blocks(x: Array, samples: int) -> Array:
    """Return blocks spread evenly over the record, (8, samples)."""
    starts = np.linspace(0, x.size - samples, _BLOCKS).astype(np.intp)
    return np.asarray(x[starts[:, None] + np.arange(samples)])

"""Noise floor and smoothness of a sampled record, seen in its differences."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from models.fractional.orders import Array

_HIGHEST = 10
_BLOCKS = 8
_BLOCK_SAMPLES = 512
_FEWEST = 24
# Noise may be so much stronger here and there. Truncation hidden below that is no larger than
# the error that the noise makes itself.
_UNEVEN = 4.0


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
    size = float(np.std(x))
    rounding = np.finfo(np.float64).eps * float(np.max(np.abs(x))) / 4.0
    if x.size < _FEWEST:
        return Roughness(size, rounding)
    estimates = []
    differences = _blocks(x, min(max(x.size // 4, _FEWEST), _BLOCK_SAMPLES))
    for d in range(1, _HIGHEST + 1):
        differences = differences[:, 1:] - differences[:, :-1]
        level = np.median(np.einsum("bn,bn->b", differences, differences)) / differences.shape[1]
        estimates.append(math.sqrt(float(level) / math.comb(2 * d, d)))
    return Roughness(size, max(min(estimates), rounding))


def smooth_differences(
    pieces: Sequence[Array], noise: float, *, highest: int, stride: int
) -> Array:
    """Return the rms of differences over a stride, less what white noise adds.

    Parameters
    ----------
    pieces : sequence of ndarrays, shape (n_i,)
        The stretches of a record between its kinks.
    noise : float
        Standard deviation of the white part.
    highest : int
    stride : int
        Samples from one point of a difference to the next.

    Returns
    -------
    ndarray, shape (highest,)
        First to highest differences; the highest that a piece is long enough for stands for
        those above it.

    Examples
    --------
    >>> t = np.arange(100.0)
    >>> smooth_differences([t**2], 0.0, highest=3, stride=5)[1:]
    array([50.,  0.])
    """
    squares, counts = np.zeros(highest), np.zeros(highest)
    for piece in pieces:
        thinned = piece[::stride]
        few = thinned.size <= _BLOCKS * _BLOCK_SAMPLES
        differences = thinned[None] if few else _blocks(thinned, _BLOCK_SAMPLES)
        for d in range(min(highest, differences.shape[1] - 1)):
            differences = differences[:, 1:] - differences[:, :-1]
            flat = differences.ravel()
            squares[d] += float(flat @ flat)
            counts[d] += flat.size
    formed = int(np.count_nonzero(counts))
    gains = np.array([math.comb(2 * d, d) for d in range(1, formed + 1)])
    smooth = np.sqrt(
        np.clip(squares[:formed] / counts[:formed] - _UNEVEN * noise**2 * gains, 0.0, None)
    )
    return np.pad(smooth, (0, highest - formed), mode="edge")


def _blocks(x: Array, samples: int) -> Array:
    """Return blocks spread evenly over the record, (8, samples)."""
    starts = np.linspace(0, x.size - samples, _BLOCKS).astype(np.intp)
    return np.asarray(x[starts[:, None] + np.arange(samples)])

"""Noise floor and smoothness of a sampled record, seen in its differences."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from models.fractional.blocks import blocks
from models.fractional.orders import Array

_HIGHEST = 10
_RUNS = 32
_RUN_SAMPLES = 64
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


def smooth_differences(
    x: Array, noise: float, strides: Sequence[int], *, highest: int, breaks: Sequence[int] = ()
) -> Array:
    """Return the rms of differences over strides, less what white noise adds.

    They are taken from runs of samples spread evenly over the record.

    Parameters
    ----------
    x : ndarray, shape (N,)
    noise : float
        Standard deviation of the white part.
    strides : sequence of S int
        Samples from one point of a difference to the next, ascending.
    highest : int
    breaks : sequence of int, optional
        First samples behind kinks: runs that hold one do not count, unless all do.

    Returns
    -------
    ndarray, shape (S, highest)
        First to highest differences; the highest that the record is long enough for stands for
        those above it.

    Examples
    --------
    >>> t = np.arange(100.0)
    >>> smooth_differences(t**2, 0.0, [1, 5], highest=3)[:, 1:]
    array([[ 2.,  0.],
           [50.,  0.]])
    """
    steps = np.array(strides)[:, None]
    count = min(_RUN_SAMPLES, (x.size - 1) // strides[-1] + 1)
    spans = (count - 1) * steps
    firsts = ((x.size - 1 - spans) * np.linspace(0.0, 1.0, _RUNS)).astype(np.intp)
    crossed = np.zeros(firsts.shape, dtype=bool)
    for at in breaks:
        crossed |= (firsts < at) & (at <= firsts + spans)
    counted = ~crossed | crossed.all(axis=1, keepdims=True)
    shares = counted / counted.sum(axis=1, keepdims=True)
    differences = x[firsts[:, :, None] + steps[:, :, None] * np.arange(count)]
    sizes = []
    for d in range(1, min(highest, count - 1) + 1):
        differences = differences[:, :, 1:] - differences[:, :, :-1]
        squares = np.einsum("srn,srn->sr", differences, differences) / (count - d)
        added = _UNEVEN * noise**2 * math.comb(2 * d, d)
        sizes.append(np.sqrt(np.clip((squares * shares).sum(axis=1) - added, 0.0, None)))
    return np.stack(sizes + sizes[-1:] * (highest - len(sizes)), axis=1)


def _blocks(x: Array, samples: int) -> Array:
    """Return blocks spread evenly over the record, (8, samples)."""
    starts = np.linspace(0, x.size - samples, _BLOCKS).astype(np.intp)
    return np.asarray(x[starts[:, None] + np.arange(samples)])

"""Noise floor of a sampled record and how much a scheme amplifies it."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from models.fractional.orders import Array

DIFFERENCES = 10
_BLOCKS = 8
_BLOCK_SAMPLES = 512
# Median of |N(0, 1)|.
_MEDIAN = 0.6744897501960817


@dataclass(frozen=True)
class Roughness:
    """Size of a record, of its noise, and of its successive differences."""

    size: float
    """rms about the mean, in units of the record."""
    noise: float
    """Standard deviation of the white part, same unit."""
    differences: Array
    """(10,) rms of the first to tenth differences less what white noise adds, same unit."""


def roughness(x: Array) -> Roughness:
    """Measure noise and smoothness from a few blocks of consecutive samples.

    White noise of standard deviation s makes d-th differences of s sqrt(binomial(2d, d)); the
    motion's share falls with d where it is sampled well. The least estimate over d is kept.

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
    blocks = _blocks(x)
    size = float(np.std(x))
    rounding = np.finfo(np.float64).eps * float(np.max(np.abs(x))) / 4.0
    rms = np.zeros(DIFFERENCES)
    estimates = []
    differences = blocks
    for d in range(1, min(DIFFERENCES, blocks.shape[1] - 2) + 1):
        differences = np.diff(differences, axis=1)
        rms[d - 1] = math.sqrt(float(np.mean(differences**2)))
        gain = math.sqrt(math.comb(2 * d, d))
        estimates.append(float(np.median(np.abs(differences))) / (_MEDIAN * gain))
    noise = max(min(estimates, default=0.0), rounding) if x.size >= 24 else rounding
    gains = np.array([math.comb(2 * d, d) for d in range(1, DIFFERENCES + 1)])
    smooth = np.sqrt(np.clip(rms**2 - noise**2 * gains, 0.0, None))
    return Roughness(size, noise, smooth)


def _blocks(x: Array) -> Array:
    """Return blocks spread evenly over the record, (B, samples)."""
    if x.size <= 2 * _BLOCK_SAMPLES:
        return x[None, :]
    count = min(_BLOCKS, x.size // _BLOCK_SAMPLES)
    starts = np.linspace(0, x.size - _BLOCK_SAMPLES, count).astype(np.intp)
    return np.asarray(x[starts[:, None] + np.arange(_BLOCK_SAMPLES)])

"""Coloured noise of several kinds whose covariance is known exactly: all-pole filters.

The first p samples are whitened by the Cholesky factor of their covariance and the others by the
filter's inverse, so that a signal is whitened without an approximation at its beginning.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.linalg import solve_triangular, toeplitz
from scipy.signal import lfilter, lfiltic

KINDS = ("first-order", "power-law", "resonance", "band-limited")
_LONGEST = 256
_RESPONSE = 1 << 15


@dataclass(frozen=True)
class Noise:
    """Stationary noise of unit variance: y[n] = gain w[n] - a[1] y[n-1] - ... - a[p] y[n-p]."""

    kind: str
    poles: np.ndarray
    """(p + 1,) 1, a[1], ..., a[p]."""

    @cached_property
    def _statistics(self) -> tuple[float, np.ndarray]:
        impulse = np.zeros(_RESPONSE)
        impulse[0] = 1.0
        response = lfilter([1.0], self.poles, impulse)
        power = np.abs(np.fft.rfft(response, 2 * _RESPONSE)) ** 2
        lags = np.fft.irfft(power)[: self.poles.size - 1]
        return float(1.0 / np.sqrt(lags[0])), lags / lags[0]

    @property
    def gain(self) -> float:
        """Standard deviation of the innovation."""
        return self._statistics[0]

    @property
    def autocovariance(self) -> np.ndarray:
        """(p,) at lags 0 to p - 1."""
        return self._statistics[1]

    @cached_property
    def _factor(self) -> np.ndarray:
        return np.linalg.cholesky(toeplitz(self.autocovariance))

    def draw(self, size: int, rng) -> np.ndarray:
        """Return `size` samples, stationary from the first."""
        order = self.poles.size - 1
        start = self._factor @ rng.standard_normal(order)
        state = lfiltic([1.0], self.poles, start[::-1])
        rest, _ = lfilter([1.0], self.poles, self.gain * rng.standard_normal(size - order),
                          zi=state)
        return np.concatenate([start, rest])

    def whiten(self, signals: np.ndarray) -> np.ndarray:
        """Return (N, k) signals such that this noise would become white, of unit variance."""
        order = self.poles.size - 1
        first = solve_triangular(self._factor, signals[:order], lower=True)
        rest = lfilter(self.poles, [1.0], signals, axis=0)[order:] / self.gain
        return np.concatenate([first, rest])


def power_law(exponent: float, order: int) -> np.ndarray:
    """Return the poles of noise whose power falls as f^-exponent down to about rate / order.

    Kasdin, N. J., Proc. IEEE 83 (1995) 802: the binomial series of (1 - 1/z)^(exponent / 2).
    """
    steps = np.arange(1.0, order + 1.0)
    return np.concatenate([[1.0], np.cumprod((steps - 1.0 - 0.5 * exponent) / steps)])


def random_noise(rng, kind: str, samples: int) -> Noise:
    """Return noise of a kind with random colour, for records of at least `samples`."""
    first = np.array([1.0, -rng.uniform(0.0, 0.98)])
    if kind == "first-order":
        return Noise(kind, first)
    if kind == "power-law":
        order = min(_LONGEST, samples // 3)
        mild = np.array([1.0, -rng.uniform(0.0, 0.5)])
        return Noise(kind, np.convolve(power_law(rng.uniform(0.5, 1.5), order), mild))
    if kind == "resonance":
        radius, angle = rng.uniform(0.9, 0.99), rng.uniform(0.02, 0.8) * np.pi
        pair = np.array([1.0, -2.0 * radius * np.cos(angle), radius**2])
        return Noise(kind, np.convolve(pair, np.array([1.0, -rng.uniform(0.0, 0.9)])))
    pole = float(np.exp(-2.0 * np.pi * rng.uniform(0.03, 0.3)))
    return Noise(kind, np.convolve([1.0, -pole], [1.0, -pole]))

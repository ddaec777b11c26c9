"""The solution of a sine fit at one frequency: its noise, and what is significant."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from discover.sine_fit.basis import Basis
from discover.sine_fit.design import ComplexArray
from discover.sine_fit.moments import Moments
from models.checks import Array
from models.fractional.lowest_lines import lowest_lines

_NEAREST = 24  # bins whose median is the noise beside a harmonic
_BESIDE = 8  # bins beyond those, which a harmonic hides
_FEWEST = 8  # bins clear of harmonics, from which a level can be told
_NEGLIGIBLE = 1e-12  # of the fundamental: rounding, not a harmonic


@dataclass(frozen=True)
class SineFit:
    """A sine test's fit: ``x(t) = trend (t - mean(t)) + Re sum_k c_k exp(i k w t)``."""

    frequency: float
    """Hz, of the fundamental."""
    frequency_std_error: float
    """Hz, from the noise near the fundamental; 0 where the frequency was given."""
    coefficients: ComplexArray
    """(H + 1,) in x's unit: c_0 (real) is the mean, c_k the k-th harmonic's phasor at t = 0."""
    std_errors: Array
    """(H + 1,) of each coefficient's real or imaginary part, from the noise near it."""
    trend: float
    """x's unit per s, about the mid of the record; 0 where not significant."""
    noise_rms: float
    """Root mean square of the residual over its degrees of freedom."""
    white_level: float
    """Standard deviation of white noise with the residual's median spectral density."""
    residual: Array
    """(N,) what trend and harmonics leave of x."""
    quality: float
    """Share of x's variance (mean and trend removed) that the harmonics explain, at most 1."""
    cycles: float
    """Duration times frequency; whole or not."""

    @property
    def amplitude(self) -> float:
        """Return the fundamental's amplitude, in x's unit."""
        return float(abs(self.coefficients[1]))

    @property
    def phase(self) -> float:
        """Return the fundamental's phase at t = 0, rad: ``A cos(w t + phase)``."""
        return float(np.angle(self.coefficients[1]))

    @property
    def distortion(self) -> float:
        """Return the harmonics' root sum square above the first, over the amplitude."""
        return float(np.linalg.norm(self.coefficients[2:]) / self.amplitude)

    def to_dict(self) -> dict[str, Any]:
        """Return the fit without its residual, complex numbers as [real, imaginary]."""
        return {
            "frequency_hz": self.frequency,
            "frequency_std_error_hz": self.frequency_std_error,
            "coefficients": [[float(c.real), float(c.imag)] for c in self.coefficients],
            "trend": self.trend,
            "noise_rms": self.noise_rms,
            "white_level": self.white_level,
            "quality": self.quality,
            "cycles": self.cycles,
        }


def significant(
    beta: Array, variance: Array, local: Mapping[int, float], orders: Sequence[int], duration: float
) -> tuple[tuple[int, ...], bool]:
    """Return the harmonics that stand out of the noise, and whether the trend does.

    Parameters
    ----------
    beta, variance : ndarray, shape (2 + 2 H,)
        Coefficients and the inverse normal matrix's diagonal: mean, harmonics, trend.
    local : mapping
        The noise's density beside each harmonic, and beside the mean (0), as a white variance.
    orders : sequence of int
        The harmonics.
    duration : float
        s.
    """
    kept = [1]
    largest = float(np.hypot(*beta[1:3]))
    for i, k in enumerate(orders[1:], start=1):
        pair = beta[1 + 2 * i : 3 + 2 * i]
        expected = 0.5 * float(variance[1 + 2 * i : 3 + 2 * i].sum()) * local[k]
        size = float(pair @ pair)
        if size > 2.0 * np.log(1e3) * expected and size > (_NEGLIGIBLE * largest) ** 2:
            kept.append(k)
    index = 1 + 2 * len(orders)
    slope = float(beta[index])
    error = np.sqrt(float(variance[index]) * local[0])
    reach = abs(slope) * duration
    return tuple(kept), bool(abs(slope) > 4.0 * error and reach > _NEGLIGIBLE * largest)


class Solution:
    """A linear fit at one frequency, with what its residual says about its coefficients."""

    def __init__(
        self,
        at: Moments,
        z: Array,
        frequency: float,
        orders: tuple[int, ...],
        *,
        trend: bool = True,
        with_frequency: bool,
    ) -> None:
        self.tau, self.z, self.frequency, self.orders, self.trend = (
            at.time, z, frequency, orders, trend
        )  # fmt: skip
        basis = Basis(at, frequency, orders, trend=trend)
        self.beta, inverse, self.residual = basis.solve(z)
        self.with_frequency = with_frequency
        if with_frequency:
            inverse = basis.inverse(self.beta)
        self.variance = np.diag(inverse)
        self.size = self.beta.size + int(with_frequency)
        self._measure_noise()

    def _measure_noise(self) -> None:
        """Set the noise density (as a white variance) at each harmonic and overall."""
        n = self.z.size
        self.total = float(self.residual @ self.residual) / max(n - self.size, 1)
        cycles, bins = self._cycles, n // 2 + 1
        # Beyond the last harmonic all bins are free: so many are enough.
        count = min(int(np.ceil(max(self.orders) * cycles)) + _NEAREST + _BESIDE, bins)
        free = self._free(count)
        self.few = int(free.sum()) < _FEWEST
        if self.few:
            self.local = {k: self.total for k in (0, *self.orders)}
            return
        lowest = lowest_lines(n, count)
        density = self._density(lowest.of) if lowest.block else self._whole[:count]
        positions, levels = self._bins(count)[free], density[free]
        self.local = {}
        for k in (0, *self.orders):
            at = int(np.searchsorted(positions, k * cycles))
            beside = slice(max(at - _NEAREST, 0), at + _NEAREST)
            distance = np.abs(positions[beside] - k * cycles)
            near = np.argsort(distance, kind="stable")[:_NEAREST]
            self.local[k] = float(np.median(levels[beside][near]) / np.log(2.0))

    @property
    def white(self) -> float:
        """The noise's median density, as a white variance."""
        if self.few:
            return self.total
        return float(np.median(self._whole[self._free(self._whole.size)]) / np.log(2.0))

    @property
    def _cycles(self) -> float:
        return self.frequency * float(self.tau[-1] - self.tau[0])

    def _bins(self, count: int) -> Array:
        """Return the lowest frequencies, in units of 1/duration."""
        return np.asarray(np.arange(count) * (self.z.size - 1) / self.z.size)

    def _free(self, count: int) -> NDArray[np.bool_]:
        """Return which of the lowest bins are clear of harmonics."""
        bins, cycles = self._bins(count), self._cycles
        nearest = np.clip(np.round(bins / cycles), 0, max(self.orders))
        clear = np.abs(bins - nearest * cycles) > 2.0
        return np.asarray(clear & (bins < 0.5 * self.z.size - 1.0))

    @cached_property
    def _whole(self) -> Array:
        return self._density(np.fft.rfft)

    def _density(self, spectrum: Callable[[Array], ComplexArray]) -> Array:
        window = np.hanning(self.z.size)
        return np.asarray(np.abs(spectrum(self.residual * window)) ** 2 / float(window @ window))

    def significant(self) -> tuple[tuple[int, ...], bool]:
        """Return the harmonics that stand out of the noise, and whether the trend does."""
        duration = float(self.tau[-1] - self.tau[0])
        return significant(self.beta, self.variance, self.local, self.orders, duration)

    def result(self, middle: float, offset: float, scale: float) -> SineFit:
        """Return the fit in the record's own time and unit."""
        highest = max(self.orders)
        coefficients = np.zeros(highest + 1, dtype=np.complex128)
        errors = np.zeros(highest + 1)
        coefficients[0] = self.beta[0] * scale + offset
        errors[0] = np.sqrt(self.variance[0] * self.local[0])
        for i, k in enumerate(self.orders):
            turn = np.exp(-2j * np.pi * k * self.frequency * middle)
            phasor = complex(self.beta[1 + 2 * i], self.beta[2 + 2 * i])
            coefficients[k] = phasor * turn * scale
            errors[k] = np.sqrt(0.5 * self.variance[1 + 2 * i : 3 + 2 * i].sum() * self.local[k])
        slope = float(self.beta[-1]) if self.trend else 0.0
        plain = self.z - self.beta[0] - slope * self.tau
        variance = float(plain @ plain)
        quality = 1.0 - float(self.residual @ self.residual) / variance if variance else 0.0
        error = 0.0
        if self.with_frequency:
            error = float(np.sqrt(self.variance[-1] * self.local[1])) / (2.0 * np.pi)
        errors *= scale
        residual = self.residual * scale
        for array in (coefficients, errors, residual):
            array.flags.writeable = False
        return SineFit(
            frequency=self.frequency,
            frequency_std_error=error,
            coefficients=coefficients,
            std_errors=errors,
            trend=slope * scale,
            noise_rms=float(np.sqrt(self.total)) * scale,
            white_level=float(np.sqrt(self.white)) * scale,
            residual=residual,
            quality=quality,
            cycles=self.frequency * float(self.tau[-1] - self.tau[0]),
        )

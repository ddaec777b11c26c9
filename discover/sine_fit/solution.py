"""The linear part of a sine fit: solution at one frequency, its noise, what is significant."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.linalg import cho_factor, cho_solve

from discover.sine_fit.design import ComplexArray, harmonic_design
from discover.sine_fit.harmonic_sums import Columns, Harmonics, Moments, columns_of
from models.checks import Array

_NEAREST = 24  # bins whose median is the noise beside a harmonic
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


class Basis:
    """Mean, harmonics and perhaps a trend at samples, as products alone: no column is formed."""

    def __init__(
        self, at: Moments, frequency: float, orders: tuple[int, ...], *, trend: bool
    ) -> None:
        self.at, self.frequency, self.orders, self.trend = at, frequency, orders, trend
        self.columns = columns_of(orders, trend=trend)
        self._harmonics = Harmonics(at, frequency)
        self._own = self._harmonics.own(2 * max(orders), powers=3)

    def solve(self, y: Array, beta: Array | None = None) -> tuple[Array, Array, Array]:
        """Return least-squares coefficients, the inverse normal matrix, and what is left of y.

        Parameters
        ----------
        y : ndarray, shape (N,)
            Signal.
        beta : ndarray, shape (C,), optional
            Coefficients whose derivative by angular frequency is a further column.
        """
        columns = self.columns if beta is None else self._turning(beta)
        gram = columns.products(self._own)
        if beta is not None:
            gram = _last_as_one(_last_as_one(gram, self.columns.size).T, self.columns.size)
        norms = np.sqrt(np.diagonal(gram))
        gram = gram / np.outer(norms, norms)
        values = np.linalg.eigvalsh(gram)
        if values[0] > 1e-6 * values[-1]:  # nearly orthogonal: squaring the condition costs nothing
            factor = cho_factor(gram)
            solution, left = np.zeros(norms.size), y
            for _ in range(2):
                solution = solution + cho_solve(factor, self._along(columns, left) / norms) / norms
                left = y - self._fitted(solution, beta)
            inverse = cho_solve(factor, np.eye(norms.size))
        else:
            design = self._design(beta)
            u, s, vt = np.linalg.svd(design / norms, full_matrices=False)
            s = np.maximum(s, 1e-13 * s[0])
            solution = vt.T @ ((u.T @ y) / s) / norms
            inverse = (vt.T / s**2) @ vt
            left = y - design @ solution
        return solution, inverse / np.outer(norms, norms), left

    def _along(self, columns: Columns, y: Array) -> Array:
        """Return products of columns with a signal; beyond the basis' own they are one."""
        highest, powers = max(self.orders), 1 + int(columns.power.max())
        sums = self._harmonics.sums(y[None], highest, powers=powers)
        return _last_as_one(columns.along(sums)[0], self.columns.size)

    def _turning(self, beta: Array) -> Columns:
        """Return the columns, and those whose sum is the derivative by angular frequency."""
        k = np.array(self.orders)
        turning = Columns(k, np.ones_like(k), 1j * k * self._phasors(beta)[k])
        return self.columns.followed_by(turning)

    def _fitted(self, solution: Array, beta: Array | None) -> Array:
        """Return what coefficients make of the columns, (N,)."""
        size = self.columns.size
        fitted = self._harmonics.series(self._phasors(solution))
        if self.trend:
            fitted += solution[size - 1] * self.at.time
        if beta is not None:
            turning = 1j * np.arange(max(self.orders) + 1) * self._phasors(beta)
            fitted += solution[-1] * self.at.time * self._harmonics.series(turning)
        return fitted

    def _phasors(self, solution: Array) -> ComplexArray:
        phasors = np.zeros(max(self.orders) + 1, dtype=np.complex128)
        phasors[0] = solution[0]
        for i, k in enumerate(self.orders):
            phasors[k] = complex(solution[1 + 2 * i], solution[2 + 2 * i])
        return phasors

    def _design(self, beta: Array | None) -> Array:
        tau = self.at.time
        design = harmonic_design(tau, self.frequency, self.orders)
        parts = [design, tau[:, None]] if self.trend else [design]
        if beta is not None:
            parts.append(frequency_column(tau, design, beta, self.orders)[:, None])
        return np.concatenate(parts, axis=1)


def _last_as_one(values: Array, size: int) -> Array:
    """Return rows (C, ...) of which those from `size` on, where there are any, are added up."""
    if values.shape[0] == size:
        return values
    return np.concatenate([values[:size], values[size:].sum(axis=0, keepdims=True)])


def frequency_column(tau: Array, design: Array, beta: Array, orders: Sequence[int]) -> Array:
    """Return the derivative of the fit by angular frequency."""
    column = np.zeros(tau.size)
    for i, k in enumerate(orders):
        cosine, minus_sine = design[:, 1 + 2 * i], design[:, 2 + 2 * i]
        column += k * (beta[1 + 2 * i] * minus_sine - beta[2 + 2 * i] * cosine)
    return np.asarray(column * tau)


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
            inverse = basis.solve(self.residual, self.beta)[1]
        self.variance = np.diag(inverse)
        self.size = self.beta.size + int(with_frequency)
        self._measure_noise()

    def _measure_noise(self) -> None:
        """Set the noise density (as a white variance) at each harmonic and overall."""
        n = self.z.size
        freedom = max(n - self.size, 1)
        self.total = float(self.residual @ self.residual) / freedom
        duration = float(self.tau[-1] - self.tau[0])
        window = np.hanning(n)
        density = np.abs(np.fft.rfft(self.residual * window)) ** 2 / float(window @ window)
        bins = np.arange(density.size) * (n - 1) / n  # in units of 1/duration
        cycles = self.frequency * duration
        nearest = np.clip(np.round(bins / cycles), 0, max(self.orders))
        free = (np.abs(bins - nearest * cycles) > 2.0) & (bins < 0.5 * n - 1.0)
        if int(free.sum()) < 8:
            self.white = self.total
            self.local = {k: self.total for k in (0, *self.orders)}
            return
        positions, levels = bins[free], density[free]
        self.white = float(np.median(levels) / np.log(2.0))
        self.local = {}
        for k in (0, *self.orders):
            at = int(np.searchsorted(positions, k * cycles))
            beside = slice(max(at - _NEAREST, 0), at + _NEAREST)
            distance = np.abs(positions[beside] - k * cycles)
            near = np.argsort(distance, kind="stable")[:_NEAREST]
            self.local[k] = float(np.median(levels[beside][near]) / np.log(2.0))

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

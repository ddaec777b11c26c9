"""Least-squares fit of a sine record: frequency, offset, trend and harmonics."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.fft import next_fast_len
from scipy.linalg import cho_factor, cho_solve

from models.checks import Array, InputError, finite_array, number

ComplexArray = NDArray[np.complex128]

_SCAN_CYCLES = 12.0  # below this many cycles a spectrum's peak is off by its own mirror image
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


def harmonic_design(
    time: ArrayLike, frequency: float, harmonics: int | Sequence[int], *, trend: bool = False
) -> Array:
    """Return the columns of a least-squares fit of harmonics.

    Parameters
    ----------
    time : array_like, shape (N,)
        Time, s.
    frequency : float
        Fundamental, Hz.
    harmonics : int or sequence of int
        The highest harmonic, or the harmonics themselves.
    trend : bool, optional
        Append a column ``t - mean(t)``.

    Returns
    -------
    ndarray, shape (N, 1 + 2 H) or (N, 2 + 2 H)
        One, then ``cos(k w t)`` and ``-sin(k w t)`` for each harmonic, so that the pair of a
        harmonic's coefficients is the real and the imaginary part of its phasor; then the trend.

    Examples
    --------
    >>> harmonic_design([0.0, 0.25], 1.0, 1).round(12).tolist()
    [[1.0, 1.0, -0.0], [1.0, 0.0, -1.0]]
    """
    t = finite_array("time", time, ndim=1)
    orders = range(1, harmonics + 1) if isinstance(harmonics, int) else harmonics
    if t.size > 1 and len(orders) > 2:
        base = np.exp(2j * np.pi * frequency * t)
        waves = _powers(base, orders)
    else:
        waves = [np.exp(2j * np.pi * k * frequency * t) for k in orders]
    design = np.empty((t.size, 1 + 2 * len(waves) + int(trend)), order="F")
    design[:, 0] = 1.0
    for column, wave in enumerate(waves):
        design[:, 1 + 2 * column] = wave.real
        design[:, 2 + 2 * column] = -wave.imag
    if trend:
        design[:, -1] = t - t.mean()
    return design


def harmonic_series(time: ArrayLike, frequency: float, coefficients: ArrayLike) -> Array:
    """Return ``Re sum_k c_k exp(2 pi i k f t)``.

    Parameters
    ----------
    time : array_like, shape (N,)
        Time, s.
    frequency : float
        Fundamental, Hz.
    coefficients : array_like, shape (H + 1,)
        Complex phasors c_0 to c_H.

    Returns
    -------
    ndarray, shape (N,)

    Examples
    --------
    >>> harmonic_series([0.0, 0.25], 1.0, [1.0, 2.0, 0.5]).round(12).tolist()
    [3.5, 0.5]
    """
    t = finite_array("time", time, ndim=1)
    phasors = np.asarray(coefficients, dtype=np.complex128)
    wave = np.exp(2j * np.pi * frequency * t)
    total = np.zeros(t.size, dtype=np.complex128)
    for c in phasors[::-1]:  # Horner: no power is formed
        total = total * wave + c
    return np.ascontiguousarray(total.real)


def fit_sine(
    time: ArrayLike,
    x: ArrayLike,
    *,
    frequency: float | None = None,
    harmonics: int = 7,
    where: str = "",
) -> SineFit:
    """Fit frequency, mean, trend and significant harmonics by least squares.

    The frequency starts from the spectrum's peak (for few cycles from a scan of exact fits) and
    is refined by Gauss-Newton steps with all linear coefficients eliminated (variable
    projection). Whole cycles are not needed. A harmonic is kept where its amplitude exceeds what
    the noise beside it in the spectrum gives with probability 1e-3.

    Parameters
    ----------
    time : array_like, shape (N,)
        Time, s, strictly increasing; uniform or not.
    x : array_like, shape (N,)
        Signal whose fundamental is its strongest line.
    frequency : float, optional
        Hz; held exactly where given, found where not.
    harmonics : int, optional
        The highest harmonic tried, lowered where the sampling does not resolve it.
    where : str, optional
        Name of the record for messages.

    Returns
    -------
    SineFit

    Raises
    ------
    InputError
        On fewer than 8 samples, values that are not finite, or a signal that does not vary.

    Notes
    -----
    Golub and Pereyra, Inverse Problems 19 (2003) R1. For white noise the standard error of the
    frequency tends to the Cramer-Rao bound ``sqrt(6 / N) s / (pi A T)`` (Rife and Boorstyn, IEEE
    Trans. Inf. Theory 20 (1974) 591).

    Examples
    --------
    >>> t = np.arange(460) / 200.0
    >>> fit = fit_sine(t, 0.02 * np.sin(2 * np.pi * 1.3 * t) + 0.001)
    >>> round(fit.frequency, 9), round(fit.amplitude, 9), round(float(fit.coefficients[0].real), 9)
    (1.3, 0.02, 0.001)
    """
    t = finite_array("time", time, ndim=1, min_size=8, where=where)
    y = finite_array("x", x, ndim=1, min_size=8, where=where)
    if t.shape != y.shape:
        raise InputError("x", expected=f"of shape {t.shape}", found=f"{y.shape}", where=where)
    middle = float(t.mean())
    tau = t - middle
    duration = float(t[-1] - t[0])
    if not duration > 0.0 or np.any(np.diff(t) <= 0.0):
        raise InputError("time", expected="strictly increasing", found="a step <= 0", where=where)
    offset = float(y.mean())
    scale = float(np.abs(y - offset).max())
    if scale <= 1e-14 * abs(offset) or scale == 0.0:
        raise InputError("x", expected="varying", found="a constant", where=where)
    z = (y - offset) / scale
    found = frequency is None
    if frequency is None:
        f = _start(tau, z, duration)
        f = _refine(tau, z, f, _allowed(min(harmonics, 3), f, t.size, duration), settled=1e-3)
    else:
        f = number("frequency", frequency, above=0.0, where=where)
    orders = _allowed(harmonics, f, t.size, duration)
    if found:
        f = _refine(tau, z, f, orders)
    solution = _Solution(tau, z, f, orders, with_frequency=found)
    kept, keep_trend = solution.significant()
    if (kept, keep_trend) != (orders, True):
        if found:
            f = _refine(tau, z, f, kept, trend=keep_trend)
        solution = _Solution(tau, z, f, kept, trend=keep_trend, with_frequency=found)
    return solution.result(middle, offset, scale)


def _powers(base: ComplexArray, orders: Sequence[int]) -> list[ComplexArray]:
    """Return the powers of unit phasors by repeated products (exact to a few ulp per step)."""
    result = []
    wave, reached = np.ones_like(base), 0
    for k in orders:
        if k <= reached:
            wave, reached = np.ones_like(base), 0
        while reached < k:
            wave = wave * base
            reached += 1
        result.append(wave)
    return result


def _allowed(harmonics: int, frequency: float, size: int, duration: float) -> tuple[int, ...]:
    """Return the harmonics that the mean sampling and the number of samples resolve."""
    nyquist = 0.5 * (size - 1) / duration
    highest = min(harmonics, int(0.9 * nyquist / frequency), (size - 4) // 4)
    return tuple(range(1, max(highest, 1) + 1))


def _start(tau: Array, z: Array, duration: float) -> float:
    """Return the frequency of the strongest line, good to a fraction of 1/duration."""
    size = z.size
    grid = np.linspace(tau[0], tau[-1], size)
    even = z if np.allclose(grid, tau, rtol=0.0, atol=1e-3 * duration / size) else np.interp(
        grid, tau, z
    )
    slope = (grid @ even) / (grid @ grid)
    padded = next_fast_len(4 * size, real=True)
    spectrum = np.abs(np.fft.rfft((even - even.mean() - slope * grid) * np.hanning(size), padded))
    bin_width = (size - 1) / duration / padded
    lowest = max(1, int(0.5 / duration / bin_width))
    peak = lowest + int(np.argmax(spectrum[lowest:]))
    shift = 0.0
    if 0 < peak < spectrum.size - 1 and spectrum[peak - 1 : peak + 2].min() > 0.0:
        a, b, c = np.log(spectrum[peak - 1 : peak + 2])
        curvature = a - 2.0 * b + c
        shift = 0.5 * (a - c) / curvature if curvature < 0.0 else 0.0
    start = (peak + shift) * bin_width
    if start * duration >= _SCAN_CYCLES:
        return float(start)
    return _scan(tau, z, start, duration)


def _scan(tau: Array, z: Array, start: float, duration: float) -> float:
    """Return the best of exact fits at frequencies within 1.5/duration of the start."""
    stride = max(1, z.size // 800)
    t, y = tau[::stride], z[::stride]
    lowest = 0.4 / duration
    best, best_cost = start, np.inf
    for f in np.linspace(max(lowest, start - 1.5 / duration), start + 1.5 / duration, 61):
        design = harmonic_design(t, float(f), _allowed(2, float(f), t.size, duration), trend=True)
        residual = y - design @ np.linalg.lstsq(design, y, rcond=None)[0]
        cost = float(residual @ residual)
        if cost < best_cost:
            best, best_cost = float(f), cost
    return best


def _solve(design: Array, y: Array) -> tuple[Array, Array]:
    """Return the least-squares solution and the inverse of the normal matrix."""
    norms = np.sqrt(np.einsum("ij,ij->j", design, design))
    gram = (design.T @ design) / np.outer(norms, norms)
    values = np.linalg.eigvalsh(gram)
    if values[0] > 1e-6 * values[-1]:  # nearly orthogonal: squaring the condition costs nothing
        factor = cho_factor(gram)
        beta = cho_solve(factor, (design.T @ y) / norms) / norms
        beta = beta + cho_solve(factor, (design.T @ (y - design @ beta)) / norms) / norms
        inverse = cho_solve(factor, np.eye(norms.size))
    else:
        u, s, vt = np.linalg.svd(design / norms, full_matrices=False)
        s = np.maximum(s, 1e-13 * s[0])
        beta = vt.T @ ((u.T @ y) / s) / norms
        inverse = (vt.T / s**2) @ vt
    return beta, inverse / np.outer(norms, norms)


def _frequency_column(tau: Array, design: Array, beta: Array, orders: Sequence[int]) -> Array:
    """Return the derivative of the fit by angular frequency."""
    column = np.zeros(tau.size)
    for i, k in enumerate(orders):
        cosine, minus_sine = design[:, 1 + 2 * i], design[:, 2 + 2 * i]
        column += k * (beta[1 + 2 * i] * minus_sine - beta[2 + 2 * i] * cosine)
    return np.asarray(column * tau)


def _refine(
    tau: Array,
    z: Array,
    frequency: float,
    orders: Sequence[int],
    *,
    trend: bool = True,
    settled: float = 1e-10,
) -> float:
    """Return the frequency at the least-squares minimum, to `settled` rad over the record."""
    duration = float(tau[-1] - tau[0])
    lowest = 0.3 / duration
    omega, last_cost, step = 2.0 * np.pi * frequency, np.inf, 0.0
    for _ in range(25):
        design = harmonic_design(tau, omega / (2.0 * np.pi), orders, trend=trend)
        beta, _ = _solve(design, z)
        residual = z - design @ beta
        cost = float(residual @ residual)
        if cost > last_cost * (1.0 + 1e-12) and abs(step) * duration > 1e-9:
            step *= 0.5
            omega -= step
            continue
        last_cost = cost
        column = _frequency_column(tau, design, beta, orders)
        full = np.column_stack([design, column])
        step = float(_solve(full, residual)[0][-1])
        step = float(np.clip(step, -1.5 / duration, 1.5 / duration))
        step = max(step, 2.0 * np.pi * lowest - omega)
        omega += step
        if abs(step) * duration < settled:
            break
    return float(omega / (2.0 * np.pi))


class _Solution:
    """A linear fit at one frequency, with what its residual says about its coefficients."""

    def __init__(
        self,
        tau: Array,
        z: Array,
        frequency: float,
        orders: tuple[int, ...],
        *,
        trend: bool = True,
        with_frequency: bool,
    ) -> None:
        self.tau, self.z, self.frequency, self.orders, self.trend = tau, z, frequency, orders, trend
        design = harmonic_design(tau, frequency, orders, trend=trend)
        self.beta, inverse = _solve(design, z)
        self.residual = z - design @ self.beta
        self.with_frequency = with_frequency
        if with_frequency:
            column = _frequency_column(tau, design, self.beta, orders)
            inverse = _solve(np.column_stack([design, column]), z)[1]
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
            near = np.argsort(np.abs(positions - k * cycles), kind="stable")[:24]
            self.local[k] = float(np.median(levels[near]) / np.log(2.0))

    def significant(self) -> tuple[tuple[int, ...], bool]:
        """Return the harmonics that stand out of the noise, and whether the trend does."""
        kept = [1]
        largest = float(np.hypot(*self.beta[1:3]))
        for i, k in enumerate(self.orders[1:], start=1):
            pair = self.beta[1 + 2 * i : 3 + 2 * i]
            variance = 0.5 * float(self.variance[1 + 2 * i : 3 + 2 * i].sum()) * self.local[k]
            size = float(pair @ pair)
            if size > 2.0 * np.log(1e3) * variance and size > (_NEGLIGIBLE * largest) ** 2:
                kept.append(k)
        index = 1 + 2 * len(self.orders)
        slope = float(self.beta[index])
        error = np.sqrt(float(self.variance[index]) * self.local[0])
        reach = abs(slope) * float(self.tau[-1] - self.tau[0])
        return tuple(kept), bool(abs(slope) > 4.0 * error and reach > _NEGLIGIBLE * largest)

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

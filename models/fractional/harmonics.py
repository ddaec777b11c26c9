"""Steady-state derivative by fitted harmonics: exact for cycles that are not whole."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.fft
from numpy.typing import NDArray

from models.fractional.orders import Array
from models.fractional.spectral import harmonic_factors
from models.fractional.window import kaiser_window

_KAISER = 14.0
_ITERATIONS = 20
# Below this many cycles the window's main lobe reaches the mean and the line's own image.
_FEW_CYCLES = 10.0


@dataclass(frozen=True)
class HarmonicFit:
    """A mean and harmonics of one fundamental, fitted to a record."""

    omega: float
    """Fundamental, rad per sample."""
    coefficients: NDArray[np.complex128]
    """(H + 1,) x_n = Re sum_k c_k exp(i k omega n); the first is the mean."""
    residual: float
    """rms of what the harmonics leave, units of the record."""


def fit_harmonics(x: Array, *, highest: int = 10) -> HarmonicFit | None:
    """Fit a fundamental and its harmonics by least squares, the frequency included.

    Parameters
    ----------
    x : ndarray, shape (N,)
        Record of at least one and a half cycles.
    highest : int, optional
        Harmonics at most; those above the last one that stands clear of the noise are left
        out.

    Returns
    -------
    HarmonicFit or None
        None for records that are constant or too short to hold a cycle and a half.

    Examples
    --------
    >>> n = np.arange(500)
    >>> fit = fit_harmonics(np.sin(0.1 * n) + 0.1 * np.cos(0.3 * n))
    >>> bool(abs(fit.omega - 0.1) < 1e-10), fit.coefficients.size
    (True, 4)
    """
    if x.size < 16 or float(np.ptp(x)) == 0.0:
        return None
    omega = _strongest_line(x)
    if omega * x.size < 3.0 * np.pi:
        return None
    possible = min(highest, int(0.9 * np.pi / omega), (x.size // 4 - 2) // 2)
    if possible < 1:
        return None
    single = _refine(x, omega, 1)
    full = _refine(x, single.omega, possible)
    # A harmonic of noise alone has |c|^2 of 4 s^2 / N in the mean; the largest of several
    # thousand such stays below this.
    level = 4.0 * full.residual**2 / x.size * np.log(100.0 * x.size)
    real = np.flatnonzero(np.abs(full.coefficients[1:]) ** 2 > level) + 1
    return _refine(x, full.omega, int(real[-1])) if real.size else single


def harmonic_derivative(fit: HarmonicFit, orders: Array, dt: float, samples: int) -> Array:
    """Differentiate fitted harmonics in steady state (Weyl).

    Parameters
    ----------
    fit : HarmonicFit
    orders : ndarray, shape (K,)
    dt : float
        Sampling interval, s.
    samples : int

    Returns
    -------
    ndarray, shape (K, N)

    Examples
    --------
    >>> fit = HarmonicFit(0.1, np.array([0.0, -1j]), 0.0)
    >>> y = harmonic_derivative(fit, np.array([1.0]), 0.1, 3)
    >>> bool(np.allclose(y[0], np.cos(0.1 * np.arange(3))))
    True
    """
    k = np.arange(fit.coefficients.size)
    spectra = harmonic_factors(orders, k * fit.omega / dt) * fit.coefficients
    waves = np.exp(1j * fit.omega * np.outer(k, np.arange(samples)))
    return np.asarray((spectra @ waves).real)


def _strongest_line(x: Array) -> float:
    """Angular frequency per sample of the strongest line."""
    centred = (x - x.mean()) * kaiser_window(x.size, _KAISER)
    length = scipy.fft.next_fast_len(4 * x.size, real=True)
    size = np.abs(scipy.fft.rfft(centred, n=length))
    peak = int(np.clip(np.argmax(size), 1, size.size - 2))
    if peak * x.size < _FEW_CYCLES * length:
        return _best_of_few_cycles(x)
    left, middle, right = np.log(np.maximum(size[peak - 1 : peak + 2], 1e-300))
    curvature = left - 2.0 * middle + right
    shift = 0.5 * (left - right) / curvature if curvature < 0.0 else 0.0
    return float(2.0 * np.pi * (peak + shift) / length)


def _best_of_few_cycles(x: Array) -> float:
    """Frequency whose sine and mean leave least; a spectrum can't resolve it in a few cycles."""
    n = np.unique(np.linspace(0, x.size - 1, min(x.size, 1000)).astype(np.intp))
    trials = 2.0 * np.pi * np.arange(1.0, 1.5 * _FEW_CYCLES, 0.1) / x.size
    left = []
    for omega in trials:
        columns = np.stack([np.ones(n.size), np.cos(omega * n), np.sin(omega * n)])
        solution = np.linalg.solve(columns @ columns.T, columns @ x[n])
        left.append(float(np.sum((x[n] - solution @ columns) ** 2)))
    return float(trials[int(np.argmin(left))])


def _refine(x: Array, omega: float, count: int) -> HarmonicFit:
    """Gauss-Newton on frequency and coefficients together, time measured from the middle."""
    n = np.arange(x.size) - 0.5 * (x.size - 1)
    columns = np.empty((2 * count + 2, x.size))
    columns[0] = 1.0
    harmonics = np.arange(1, count + 1)
    for _ in range(_ITERATIONS):
        turn = np.exp(1j * omega * n)
        wave = np.ones_like(turn)
        for k in harmonics:
            wave = wave * turn
            columns[2 * k - 1], columns[2 * k] = wave.real, wave.imag
        linear = columns[:-1]
        gram = linear @ linear.T
        solution = np.linalg.solve(gram, linear @ x)
        residual = x - solution @ linear
        # One step of refinement makes up for the squared condition number.
        extra = np.linalg.solve(gram, linear @ residual)
        solution += extra
        residual -= extra @ linear
        a, b = solution[1::2], solution[2::2]
        slope = (harmonics * b) @ linear[1::2] - (harmonics * a) @ linear[2::2]
        columns[-1] = n / x.size * slope
        step = float(np.linalg.solve(columns @ columns.T, columns @ residual)[-1]) / x.size
        used = omega
        if abs(step) * x.size < 1e-11:
            break
        omega += step
    # From time that runs from the middle of the record to time from its first sample.
    shift = np.exp(-0.5j * used * harmonics * (x.size - 1))
    coefficients = np.concatenate([[solution[0]], (a - 1j * b) * shift])
    return HarmonicFit(used, coefficients, float(np.sqrt(np.mean(residual**2))))

"""The nonlinear part of a sine fit: its frequency, found and refined."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike
from scipy.fft import next_fast_len, rfft

from discover.sine_fit.basis import Basis
from discover.sine_fit.moments import Moments, moments
from discover.sine_fit.solution import SineFit, Solution
from models.checks import Array, InputError, finite_array, number

_ROUNDING = 1e-15  # of a signal's square sum: less is no difference
FEW_CYCLES = 12.0  # below this many cycles a spectrum's peak is off by its own mirror image


def fit_sine(
    time: ArrayLike,
    x: ArrayLike,
    *,
    frequency: float | None = None,
    near: float | None = None,
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
    near : float, optional
        Hz, to half a cycle over the record: where the search begins, found where not given.
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
    at = moments(t).since(middle)
    tau = at.time
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
        f = _start(tau, z, duration) if near is None else near
        short_tau, short_z = _block_means(tau, z, round(t.size / (duration * f)) // 64)
        short = moments(short_tau)
        orders = allowed_harmonics(min(harmonics, 3), f, short_tau.size, duration)
        f = _refine(short, short_z, f, orders, settled=1e-6)
    else:
        f = number("frequency", frequency, above=0.0, where=where)
    orders = allowed_harmonics(harmonics, f, t.size, duration)
    if found and len(orders) > 3:
        orders_short = allowed_harmonics(harmonics, f, short_tau.size, duration)
        f = _refine(short, short_z, f, orders_short, settled=1e-6)
    solution = Solution(at, z, f, orders, with_frequency=False)
    kept, keep_trend = solution.significant()
    if found:
        f = _refine(at, z, f, kept, trend=keep_trend)
    if found or (kept, keep_trend) != (orders, True):
        solution = Solution(at, z, f, kept, trend=keep_trend, with_frequency=found)
    return solution.result(middle, offset, scale)


def allowed_harmonics(
    harmonics: int, frequency: float, size: int, duration: float
) -> tuple[int, ...]:
    """Return the harmonics that the mean sampling and the number of samples resolve."""
    nyquist = 0.5 * (size - 1) / duration
    highest = min(harmonics, int(0.9 * nyquist / frequency), (size - 4) // 4)
    return tuple(range(1, max(highest, 1) + 1))


def _block_means(tau: Array, z: Array, length: int) -> tuple[Array, Array]:
    """Return means over blocks of samples: enough to find the frequency, and quicker."""
    if length < 2:
        return tau, z
    count = tau.size // length
    shape = (count, length)
    return tau[: count * length].reshape(shape).mean(1), z[: count * length].reshape(shape).mean(1)


def _start(tau: Array, z: Array, duration: float) -> float:
    """Return the frequency of the strongest line, good to a fraction of 1/duration."""
    size = z.size
    grid = np.linspace(tau[0], tau[-1], size)
    even = (
        z
        if np.allclose(grid, tau, rtol=0.0, atol=1e-3 * duration / size)
        else np.interp(grid, tau, z)
    )
    slope = (grid @ even) / (grid @ grid)
    padded = next_fast_len(4 * size, real=True)
    tapered = (even - even.mean() - slope * grid) * np.hanning(size)
    bin_width = (size - 1) / duration / padded
    start = strongest_line(np.abs(rfft(tapered, padded)) ** 2, bin_width, duration)
    return start if start * duration >= FEW_CYCLES else _scan(tau, z, start, duration)


def strongest_line(power: Array, width: float, duration: float) -> float:
    """Return the frequency of the strongest line, Hz, between bins of a spectrum.

    Parameters
    ----------
    power : ndarray, shape (B,)
        Of the signal with a window of Hann.
    width : float
        Hz from bin to bin.
    duration : float
        s, of the signal: what is slower than half a cycle is no line.

    Examples
    --------
    >>> time = np.arange(400) / 100.0
    >>> tapered = np.sin(2 * np.pi * 7.1 * time) * np.hanning(400)
    >>> round(strongest_line(np.abs(np.fft.rfft(tapered)) ** 2, 0.25, 4.0), 2)
    7.1
    """
    lowest = max(1, int(0.5 / duration / width))
    peak = lowest + int(np.argmax(power[lowest:]))
    shift = 0.0
    if 0 < peak < power.size - 1 and power[peak - 1 : peak + 2].min() > 0.0:
        a, b, c = np.log(power[peak - 1 : peak + 2])
        curvature = a - 2.0 * b + c
        shift = 0.5 * (a - c) / curvature if curvature < 0.0 else 0.0
    return float((peak + shift) * width)


def _scan(tau: Array, z: Array, start: float, duration: float) -> float:
    """Return the best of exact fits at frequencies within 1.5/duration of the start."""
    stride = max(1, z.size // 800)
    t, y = tau[::stride], z[::stride]
    lowest = 0.4 / duration
    tried = np.linspace(max(lowest, start - 1.5 / duration), start + 1.5 / duration, 61)
    angle = 2.0 * np.pi * tried[:, None] * t
    columns = np.stack(  # harmonics would fit half the frequency as well
        [np.broadcast_to(1.0, angle.shape), np.cos(angle), np.sin(angle),
         np.broadcast_to(t - t.mean(), angle.shape)], axis=2,
    )  # fmt: skip
    basis = np.linalg.qr(columns)[0]
    explained = np.sum((y @ basis) ** 2, axis=1)
    return float(tried[int(np.argmax(explained))])


def _refine(
    at: Moments,
    z: Array,
    frequency: float,
    orders: tuple[int, ...],
    *,
    trend: bool = True,
    settled: float = 1e-10,
) -> float:
    """Return the frequency at the least-squares minimum, to `settled` rad over the record."""
    duration = float(at.time[-1] - at.time[0])
    lowest = 0.3 / duration
    omega, last_cost, step = 2.0 * np.pi * frequency, np.inf, 0.0
    rounding = _ROUNDING * float(z @ z)
    for _ in range(25):
        cost, next_step = Basis(at, omega / (2.0 * np.pi), orders, trend=trend).newton(z)
        if cost > last_cost * (1.0 + 1e-12) + rounding and abs(step) * duration > 1e-9:
            step *= 0.5
            omega -= step
            continue
        last_cost = cost
        step = float(np.clip(next_step, -1.5 / duration, 1.5 / duration))
        step = max(step, 2.0 * np.pi * lowest - omega)
        omega += step
        if abs(step) * duration < settled:
            break
    return float(omega / (2.0 * np.pi))

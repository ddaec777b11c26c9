"""Noise beside the lines of a spectrum: its level where a periodic fit left nothing."""

from __future__ import annotations

import numpy as np

from models.checks import Array


def power_density(residual: Array, step: float) -> tuple[Array, Array]:
    """Return frequencies (Hz) and the one-sided power density of a Hann-tapered signal.

    Parameters
    ----------
    residual : ndarray, shape (N,)
        Signal.
    step : float
        Sampling interval, s.

    Returns
    -------
    frequencies, density : ndarray, shape (N // 2 + 1,)
        Density in squared units of the signal per Hz.
    """
    taper = np.hanning(residual.size + 2)[1:-1]
    spectrum = np.abs(np.fft.rfft(residual * taper)) ** 2
    return np.fft.rfftfreq(residual.size, step), 2.0 * step * spectrum / np.sum(taper**2)


def density_at_lines(
    residual: Array, step: float, lines: Array, removed: Array, *, half_width: float
) -> Array:
    """Return the noise density at each of `lines`, from the bins around it.

    A least-squares fit has removed the lines themselves: of the bins in each window the removed
    ones carry nothing, so the mean is over the degrees of freedom that are left.

    Parameters
    ----------
    residual : ndarray, shape (N,)
        What the fit left.
    step : float
        Sampling interval, s.
    lines : ndarray, shape (L,)
        Frequencies to judge at, Hz.
    removed : ndarray, shape (M,)
        Frequencies that the fit removed, Hz.
    half_width : float
        Half width of the window, Hz; at least four bins are taken on each side.

    Returns
    -------
    ndarray, shape (L,)
        One-sided density.
    """
    frequencies, density = power_density(residual, step)
    bin_width = frequencies[1]
    width = max(half_width, 4.0 * bin_width)
    total = np.concatenate(([0.0], np.cumsum(density)))
    low = np.clip(np.ceil((lines - width) / bin_width).astype(int), 0, frequencies.size - 1)
    high = np.clip(np.floor((lines + width) / bin_width).astype(int), 0, frequencies.size - 1)
    bins = high - low + 1
    gone = np.searchsorted(removed, (high + 0.5) * bin_width) - np.searchsorted(
        removed, (low - 0.5) * bin_width
    )
    return (total[high + 1] - total[low]) / np.maximum(bins - gone, 1)

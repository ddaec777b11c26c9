"""Noise beside the lines of a spectrum: its level where a periodic fit left nothing."""

from __future__ import annotations

import numpy as np

from models.checks import Array

_GAPS = 3.0  # between harmonics, to either side of a line
_OCTAVE = 0.3  # of a line's frequency, to either side of it
_MEDIAN_EFFICIENCY = 0.6  # of a median's freedom, against that of a mean of as many bins
_BEYOND = 64  # bins above what is near the last line: some of them are clear of harmonics
_FEWEST_BINS = 4.0  # between harmonics, for a gap to be there


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
    frequencies = np.asarray(np.fft.rfftfreq(residual.size, step), dtype=np.float64)
    return frequencies, 2.0 * step * spectrum / (taper @ taper)


def density_between_lines(
    residual: Array, step: float, frequency: float, lines: Array
) -> Array:
    """Return the noise density at each of `lines`, from the bins between a record's harmonics.

    Bins beside a multiple of the test's frequency are left out, fitted or not; of the others near
    a line the median is taken, so that neither mains hum nor a harmonic that aliasing has put
    between the lines counts as noise. With too few cycles for a gap between harmonics, the mean
    over the degrees of freedom that the fit has left is taken instead.

    Parameters
    ----------
    residual : ndarray, shape (N,)
        What a fit of the harmonics left.
    step : float
        Sampling interval, s.
    frequency : float
        Of the test, Hz.
    lines : ndarray, shape (L,)
        Frequencies to judge at, Hz.

    Returns
    -------
    ndarray, shape (L,)
        One-sided density.
    """
    frequencies, density = power_density(residual, step)
    bin_width = frequencies[1]
    widths = np.maximum(np.maximum(_GAPS * frequency, _OCTAVE * lines), 4.0 * bin_width)
    stop = int(np.max(lines + widths) / bin_width) + _BEYOND
    frequencies, density = frequencies[:stop], density[:stop]
    spacing = frequency / bin_width
    distance = np.abs(np.mod(frequencies / frequency + 0.5, 1.0) - 0.5) * spacing
    if spacing < _FEWEST_BINS:
        width = max(frequency, 4.0 * bin_width)
        near = np.abs(frequencies[None, :] - lines[:, None]) <= width
        gone = np.array([np.sum(distance[row] < 0.5) for row in near])
        bins = near.sum(axis=1)
        return np.asarray((near @ density) / np.maximum(bins - gone, 1))
    clear = np.flatnonzero(distance > 1.5)
    clear = clear if clear.size >= 5 else np.flatnonzero(distance > 0.5)
    result = np.empty(lines.size)
    for index, (line, width) in enumerate(zip(lines, widths, strict=True)):
        low, high = np.searchsorted(frequencies[clear], (line - width, line + width))
        low = max(min(low, clear.size - 5), 0)
        some = density[clear[low : max(high, low + 5)]]
        result[index] = float(np.median(some)) / _median_of_exponentials(some.size)
        result[index] *= _median_correction(some.size)
    return result


def _median_correction(bins: int) -> float:
    """Return the mean of the true over the estimated variance, from the median of few bins.

    A weight that is too large by chance would count as evidence.
    """
    freedom = 2.0 * bins * _MEDIAN_EFFICIENCY
    return freedom / max(freedom - 2.0, 2.0)


def _median_of_exponentials(count: int) -> float:
    """Return the expected median of `count` unit exponential variables."""
    odd = count if count % 2 else count - 1
    return float(np.sum(1.0 / np.arange((odd + 1) // 2, odd + 1)))

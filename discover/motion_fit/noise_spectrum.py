"""The force's noise in a sine test: a smooth spectrum from between its harmonics."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from discover.motion_fit.noise import power_density
from discover.motion_fit.repetition import Unrepeated, unrepeated
from discover.sine_fit import harmonic_design
from models.checks import Array

_MOST_HARMONICS = 100  # of the test, that are taken out
_SLOW = 3  # polynomials of time that follow a drift
_FEWEST_BINS = 14  # in one range of frequencies
_FEWEST_AT_END = 3  # in the last of them
_BINS = 48  # ranges of frequency, even in the logarithm
_SLOPE_FROM = 8  # lowest ranges, which tell the rise to low frequencies
_STEEPEST = 2.0  # power of the frequency, with which noise may rise to low ones
_CLEAR = 1.6  # bins from a harmonic: nearer ones are left out
_LEAST_LEFT = 0.2  # of the noise's power, after a harmonic for every cycle was taken out
_LEAST = 1e-300  # N^2/Hz, so that logarithms stay finite
_LINE = 15.0  # times the level: noise alone is above it once in three million bins


@dataclass(frozen=True)
class NoiseSpectrum:
    """A smooth density of noise."""

    frequencies: Array
    """(K,) Hz, rising."""
    density: Array
    """(K,) one-sided, N^2/Hz."""
    power: float
    """N^2: mean square of the noise, with mains hum and other lines that are no harmonics."""

    def at(self, frequencies: Array) -> Array:
        """Return the density at other frequencies (Hz), N^2/Hz."""
        known = np.log(self.frequencies), np.log(np.maximum(self.density, _LEAST))
        return np.asarray(np.exp(np.interp(np.log(frequencies), *known)))


def noise_spectrum(time: Array, force: Array, frequency: float, step: float) -> NoiseSpectrum:
    """Return the noise of a sine test's force.

    What repeats from cycle to cycle and every slow change is taken out first; what then lies
    between the harmonics is averaged (by medians, so that hum does not count) over ever wider
    ranges of frequency.

    Parameters
    ----------
    time, force : ndarray, shape (N,)
        s and N, on a grid of `step` of which samples may be missing.
    frequency : float
        Of the test, Hz.
    step : float
        Sampling interval, s.
    """
    found = unrepeated(time, force, frequency, step)
    if found is None:
        found = _between_harmonics(time, force, frequency, step)
    level = smooth_spectrum(found.frequencies, found.density, found.width, 0.5 / step)
    return with_rise(level, _slope_of_ranges(level), 0.1 * found.width)


def smooth_spectrum(
    frequencies: Array, periodogram: Array, width: float, end: float, kept: Array | None = None
) -> NoiseSpectrum:
    """Return the smooth level of a periodogram (B,) at rising frequencies (B,), Hz.

    Its whole spectrum has bins `width` (Hz) apart and goes to `end` (Hz); what is left out of it
    has the level of what is there. Of each bin's noise a fit has `kept` a share (B,), all without.
    """
    shares = np.ones(frequencies.size) if kept is None else kept
    edges = np.geomspace(frequencies[0], frequencies[-1] * 1.001, _BINS + 1)
    middle, level, start = list[float](), list[float](), 0
    power, below = 0.0, 0.5 * width
    for edge in edges[1:]:
        stop = int(np.searchsorted(frequencies, edge))
        left = float(np.sum(shares[start:stop]))
        if left >= _FEWEST_BINS or (edge == edges[-1] and left >= _FEWEST_AT_END):
            some = periodogram[start:stop]
            middle.append(float(np.exp(np.mean(np.log(frequencies[start:stop])))))
            level.append(_level(some) * some.size / left)
            power += level[-1] * (edge - below)
            power += float(np.sum(np.maximum(some - _LINE * level[-1], 0.0))) * width
            start, below = stop, edge
    if not middle:
        mean = float(np.sum(periodogram) / np.sum(shares))
        return NoiseSpectrum(np.array([frequencies[0]]), np.array([mean]), mean * end)
    power += level[-1] * max(end - below, 0.0)
    return NoiseSpectrum(np.array(middle), np.array(level), power)


def _between_harmonics(time: Array, force: Array, frequency: float, step: float) -> Unrepeated:
    """Return what a fit of many harmonics leaves: cycles or samples are too few to compare."""
    per_cycle = 1.0 / (step * frequency)
    count = int(max(min(_MOST_HARMONICS, 0.45 * per_cycle, (time.size - 8) // 4), 1))
    design = harmonic_design(time, frequency, count)[:, : 2 * count + 1]
    centred_time = 2.0 * (time - time[0]) / (time[-1] - time[0]) - 1.0
    trend = np.polynomial.legendre.legvander(centred_time, _SLOW)[:, 1:]
    whole = np.concatenate([design, trend], axis=1)
    gram = whole.T @ whole + 1e-9 * time.size * np.eye(whole.shape[1])
    left = force - whole @ np.linalg.solve(gram, whole.T @ force)
    at = np.rint((time - time[0]) / step).astype(int)
    residual = np.zeros(at[-1] + 1)
    residual[at] = left
    frequencies, density = power_density(residual, step)
    width = frequencies[1]
    distance = np.abs(np.mod(frequencies / frequency + 0.5, 1.0) - 0.5) * frequency / width
    clear = np.flatnonzero((distance > _CLEAR) & (frequencies > 1.5 * width))
    if clear.size < 2 * _FEWEST_BINS:
        clear = np.arange(2, frequencies.size)
        cycles = frequency / width  # of so many bins a harmonic, the fit has emptied one
        density = density / max(1.0 - 1.0 / cycles, _LEAST_LEFT)
    fitted = clear[frequencies[clear] < (count + 0.5) * frequency]
    clear = fitted if fitted.size else np.arange(1, frequencies.size)
    return Unrepeated(frequencies[clear], density[clear], float(width))


def _level(density: Array) -> float:
    """Return the level of exponentially scattered densities, whatever the greatest one is.

    That is their mean, which also sees a resonance; a hum, which fills the bins beside its own
    too, is left out.
    """
    top = int(np.argmax(density))
    middle = float(np.median(density)) / float(np.log(2.0))
    if density[top] <= _LINE * middle:
        return float(np.mean(density))
    others = np.delete(density, slice(max(top - 2, 0), top + 3))
    return float(np.mean(others)) if others.size else middle


def with_rise(noise: NoiseSpectrum, slope: float, lowest: float) -> NoiseSpectrum:
    """Return a density continued to `lowest` (Hz) with a power (`slope`) of the frequency.

    Hardly a line tells there, and that is where drifting noise is strongest.
    """
    frequencies, level = noise.frequencies, noise.density
    rise = (lowest / frequencies[0]) ** float(np.clip(slope, -_STEEPEST, 0.0))
    return NoiseSpectrum(
        np.append(lowest, frequencies), np.append(level[0] * rise, level), noise.power
    )


def slope_of_lines(frequencies: Array, periodogram: Array, kept: Array) -> float:
    """Return the power of the frequency with which noise goes, of which a fit has `kept` a share.

    The mean of what lines (B,) of exponential scatter tell (Whittle's likelihood).
    """
    slopes = np.linspace(-_STEEPEST, _STEEPEST, 4 * round(_STEEPEST) * 2 + 1)
    shape = frequencies ** slopes[:, None] * np.maximum(kept, _LEAST_LEFT)
    level = np.mean(periodogram / shape, axis=1, keepdims=True)
    value = -np.sum(np.log(np.maximum(level * shape, _LEAST)), axis=1)
    weight = np.exp(value - value.max())
    return float(weight @ slopes / weight.sum())


def _slope_of_ranges(noise: NoiseSpectrum) -> float:
    """Return the power of the frequency with which the lower part of a density goes."""
    few = min(_SLOPE_FROM, noise.frequencies.size)
    if few < 3:
        return 0.0
    known = np.maximum(noise.density[:few], _LEAST)  # a record without noise has none here either
    return float(np.polyfit(np.log(noise.frequencies[:few]), np.log(known), 1)[0])

"""The force's noise in a sine test, as a smooth spectrum from between its harmonics."""

from __future__ import annotations

import numpy as np

from discover.motion_fit import Observation
from discover.motion_fit.noise import power_density
from discover.sine_fit import harmonic_design
from models.checks import Array

_MOST_HARMONICS = 100
_FEWEST_BINS = 14
_BINS = 48
_SLOPE_FROM = 8
_STEEPEST = 2.0
_CLEAR = 1.6
_LEAST_LEFT = 0.2
_REVERSALS = (0.01, 0.03, 0.1)


def _jumps(observation: Observation) -> Array:
    """Return what jumps where motion reverses: its harmonics beyond Nyquist alias between lines."""
    v, x = observation.motion.velocity, observation.motion.displacement
    top, reach = float(np.abs(v).max()), float(np.abs(x).max())
    direction = np.sign(v)
    columns = [np.tanh(v / (s * top)) for s in _REVERSALS]
    return np.stack([direction, direction * x / reach, *columns], axis=1)


def noise_density(observation: Observation, slow: int) -> tuple[Array, Array]:
    """Return frequencies (Hz) and the one-sided density (N^2/Hz) of the force's noise.

    Everything periodic up to near the Nyquist frequency and every slow change is taken out
    first; what then lies between the harmonics is averaged (by medians, so that hum does not
    count) over ever wider ranges of frequency.

    Parameters
    ----------
    observation : Observation
        Of a sine test.
    slow : int
        Degree of the slow change that is taken out.
    """
    record = observation.record
    time, force = observation.time, observation.measured
    step, frequency = record.step, observation.frequency
    per_cycle = 1.0 / (step * frequency)
    count = int(min(_MOST_HARMONICS, 0.45 * per_cycle, (time.size - 8) // 4))
    design = harmonic_design(time, frequency, count)[:, : 2 * count + 1]
    late = 2.0 * (time - time[0]) / (time[-1] - time[0]) - 1.0
    trend = np.polynomial.legendre.legvander(late, slow)[:, 1:]
    whole = np.concatenate([design, trend, _jumps(observation)], axis=1)
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
    clear = clear[frequencies[clear] < (count + 0.5) * frequency]
    edges = np.geomspace(frequencies[clear[0]], frequencies[clear[-1]] * 1.001, _BINS + 1)
    middle, level, start = [], [], 0
    for edge in edges[1:]:
        stop = int(np.searchsorted(frequencies[clear], edge))
        if stop - start >= _FEWEST_BINS or (edge == edges[-1] and stop - start >= 3):
            some = clear[start:stop]
            middle.append(float(np.exp(np.mean(np.log(frequencies[some])))))
            level.append(_level(density[some]))
            start = stop
    if not middle:
        return np.array([frequency]), np.array([float(np.mean(density[clear]))])
    return _with_rise(np.array(middle), np.array(level), 0.1 * width)


def _level(density: Array) -> float:
    """Return the level of exponentially scattered densities, whatever the greatest one is.

    The median does not see a hum; the mean of all but the greatest does see a resonance.
    """
    expected = density.size - float(np.sum(1.0 / np.arange(1, density.size + 1)))
    rest = float(density.sum() - density.max()) / expected
    return max(float(np.median(density)) / float(np.log(2.0)), rest)


def _with_rise(frequencies: Array, level: Array, lowest: float) -> tuple[Array, Array]:
    """Return a density continued to `lowest` along the slope of its lower part.

    Below a test's frequency hardly a line is clear, and that is where drifting noise is strongest.
    """
    few = min(_SLOPE_FROM, frequencies.size)
    if few < 3:
        return frequencies, level
    slope = np.polyfit(np.log(frequencies[:few]), np.log(level[:few]), 1)[0]
    rise = (lowest / frequencies[0]) ** float(np.clip(slope, -_STEEPEST, 0.0))
    return np.append(lowest, frequencies), np.append(level[0] * rise, level)

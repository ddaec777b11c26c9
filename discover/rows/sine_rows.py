"""Rows of a sine test."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import solve_triangular
from scipy.sparse import csr_array

from discover.motion_fit import POINTS, Observation
from discover.rows.record_rows import RecordRows
from models.checks import Array, Indices
from models.motion import Motion

_SLOW = 3  # order of slow change
_MODULATED = 3  # harmonics whose size may change slowly
_FEWEST_CYCLES = 3.0  # from which such a change is told from the harmonics
_TOLERANCE = 3e-5  # of a record's force: no model is better
_REMAINDER = 6  # harmonics of the remainder
_MEAN_AT = 0.3  # of a line, where the spectrum of drifting noise is what moves the mean
_SLOW_DOUBT = 2.0  # times the noise's variance below the test's frequency: it is extrapolated
_MAINS = (50.0, 60.0)  # Hz
_HUM = 1e4  # times the noise's variance on a multiple of the mains


def sine_rows(observation: Observation) -> RecordRows:
    """Return the rows of a sine test.

    Parameters
    ----------
    observation : Observation
        Of kind "sine".

    Returns
    -------
    RecordRows
        With the mean, up to 31 harmonics, and from three cycles on the slow changes.
    """
    window, frequency = observation.windows[0], observation.frequency
    test, sampling = observation.test, observation.motion.step
    cycle = replace(observation.cycle_of(POINTS), test=test, sampling=sampling)
    motion, counts, force, on_cells = _cells(observation)
    duration = observation.duration
    count = window.omega.size - 1
    basis, order, lines = _basis(motion.time, frequency, count, duration)
    weight = np.sqrt(counts)
    basis = _orthonormal(basis * weight[:, None])
    variance = _variance(observation, lines, order, count, duration, float(counts.sum()))
    whitened = basis * weight[:, None] / np.sqrt(variance)

    def of_motion(columns: Array) -> Array:
        return np.asarray(columns @ whitened)

    size = np.sqrt(window.power * float(counts.sum()) / variance)
    phase = float(np.angle(_fundamental(observation.cycle_of(POINTS)))) + 0.5 * np.pi
    return RecordRows(
        observation=observation,
        motion=replace(motion, test=test, sampling=sampling),
        cycle=cycle,
        target=of_motion(force),
        size=size,
        of_motion=of_motion,
        cycle_rows=np.asarray(on_cells @ whitened),
        remainder=_remainder(size, count, phase),
        loudness=(size * _loudness(order, count))[None],
        windows=(slice(0, size.size),),
    )


def _fundamental(cycle: Motion) -> complex:
    turn = np.exp(-2j * np.pi * np.arange(cycle.displacement.size) / cycle.displacement.size)
    return complex(cycle.displacement @ turn)


def _cells(observation: Observation) -> tuple[Motion, Array, Array, csr_array]:
    """Return moments' motion (M,), the number of samples and the mean force (N) of each.

    And what each point of a cycle is of each, (G, M). Samples of a long record that are near in
    phase and time are averaged: no row sees the difference. In others each is its own cell.
    """
    sums = observation.sums
    if sums is None or observation.at is None:
        count = np.ones(observation.time.size)
        return observation.motion, count, observation.measured, _between(observation, POINTS)
    return observation.at(sums.moments), sums.counts, sums.means, sums.on_cycle


def _basis(
    time: Array, frequency: float, count: int, duration: float
) -> tuple[Array, Indices, Array]:
    """Return columns (M, R), the harmonic of each, and the order of slow change of each."""
    turn = np.exp(2j * np.pi * frequency * time)
    waves = np.empty((count, time.size), dtype=np.complex128)
    power = np.ones_like(turn)
    for k in range(count):
        power = power * turn
        waves[k] = power
    pairs = np.stack([waves.real, waves.imag], axis=1).reshape(2 * count, -1)
    centred_time = 2.0 * (time - time.min()) / max(float(np.ptp(time)), 1e-300) - 1.0
    slow = np.polynomial.legendre.legvander(centred_time, _SLOW)[:, 1:].T
    parts = [np.ones((1, time.size)), pairs, slow]
    order = [np.zeros(1), np.repeat(np.arange(1.0, count + 1.0), 2), np.zeros(_SLOW)]
    changes = [np.zeros(1 + 2 * count), np.arange(1.0, _SLOW + 1.0)]
    if duration * frequency > _FEWEST_CYCLES:
        lowest = pairs[: 2 * min(_MODULATED, count)]
        for degree in (0, 1):
            parts.append(lowest * slow[degree])
            order.append(np.repeat(np.arange(1.0, lowest.shape[0] // 2 + 1.0), 2))
            changes.append(np.full(lowest.shape[0], degree + 1.0))
    return (
        np.concatenate(parts).T,
        np.concatenate(order).astype(int),
        np.concatenate(changes),
    )


def _variance(
    observation: Observation,
    changes: Array,
    order: Indices,
    count: int,
    duration: float,
    samples: float,
) -> Array:
    """Return the noise's variance (R,) in each row of unit norm, N^2."""
    window, frequency = observation.windows[0], observation.frequency
    floor = samples * _TOLERANCE**2 * window.power
    if observation.noise is None:
        variance = samples * window.variance[np.minimum(order, count)] + floor
    else:
        wanted = order.astype(float) * frequency
        wanted[0] = _MEAN_AT / duration
        drift = (order == 0) & (changes > 0.0)
        wanted[drift] = 0.5 * changes[drift] / duration
        variance = 0.5 * observation.noise.at(wanted) * samples / duration + floor
    if window.through is not None:
        through = window.through[np.minimum(order, count)]
        variance = variance + np.where(changes > 0.0, 0.0, samples * through)
    variance = np.where((changes > 0.0) | (order == 0), _SLOW_DOUBT * variance, variance)
    step = observation.motion.step
    hum = _hum(order.astype(float) * frequency, 2.0 / duration, 1.0 / step) & (order > 2)
    return np.where(hum, _HUM * variance, variance)


def _hum(frequencies: Array, width: float, rate: float) -> NDArray[np.bool_]:
    """Return which lines (Hz) lie on a low multiple of the mains, folded at the sampling rate."""
    multiples = np.array([m * k for m in _MAINS for k in (1, 2, 3)])
    multiples = np.abs(multiples - rate * np.round(multiples / rate))
    distance = np.abs(frequencies[:, None] - multiples)
    return np.asarray(np.any(distance < width, axis=1))


def _remainder(size: Array, count: int, phase: float) -> Array:
    """Return the mean and the lowest harmonics in the motion's phase, (1 + 2 H, R).

    Their sizes fall as 1/k^2, and their squares add up to that of the record's force.
    """
    weights = 1.0 / np.arange(1.0, _REMAINDER + 1.0) ** 2
    mean = 0.25
    weights, mean = (v / np.sqrt(mean**2 + 2.0 * np.sum(weights**2)) for v in (weights, mean))
    rows = np.zeros((1 + 2 * _REMAINDER, size.size))
    rows[0, 0] = mean * size[0]
    for k in range(1, min(count, _REMAINDER) + 1):
        turn = np.array([[np.cos(k * phase), -np.sin(k * phase)],
                         [np.sin(k * phase), np.cos(k * phase)]])
        here = slice(2 * k - 1, 2 * k + 1)
        rows[here, here] = turn * size[here] * weights[k - 1]
    return rows


def _loudness(order: Indices, count: int) -> Array:
    """Return the relative size of an independent error in each row: none at the fundamental."""
    own = np.arange(order.size) < 1 + 2 * count
    falling = np.where(order == 0, 0.5, np.where(order == 1, 0.0, 1.0 / np.maximum(order, 1)))
    return np.asarray(np.where(own, falling, 0.1))


def _between(observation: Observation, points: int) -> csr_array:
    """Return what each point of a cycle (G) is of each sample (N), between two of them."""
    place = np.mod(observation.time * observation.frequency, 1.0) * points
    before = np.minimum(place.astype(int), points - 1)
    share = place - before
    samples = np.arange(place.size)
    return csr_array(
        (
            np.concatenate([1.0 - share, share]),
            (np.concatenate([before, (before + 1) % points]), np.tile(samples, 2)),
        ),
        shape=(points, place.size),
    )


def _orthonormal(columns: Array) -> Array:
    """Return columns (M, R) made orthonormal one after the other, by Cholesky's factor."""
    gram = columns.T @ columns
    scale = np.sqrt(np.diagonal(gram))
    try:
        factor = np.linalg.cholesky(gram / np.outer(scale, scale))
    except np.linalg.LinAlgError:
        basis, triangle = np.linalg.qr(columns)
        return np.asarray(basis * np.sign(np.diagonal(triangle)))
    return np.asarray(
        solve_triangular(factor, (columns / scale).T, lower=True, check_finite=False).T
    )

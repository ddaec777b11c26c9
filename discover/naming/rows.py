"""Whitened rows of a record: its harmonics, and how they change while the record lasts.

A sine test's lines alone can't show what changes over time. Its rows are therefore the record's
projections on an orthonormal set: the mean, the harmonics, a slow change of the mean and a slow
change of the lowest harmonics. Other records are windowed, and their windows show it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from scipy.linalg import solve_triangular
from scipy.sparse import csr_array, diags_array

from discover.motion_fit import Observation, real_rows
from discover.sine_fit import harmonic_design
from models.checks import Array
from models.constitutive import FittedTerm

_TOLERANCE = 1e-4  # of a record's force: no model is better, and no misfit below it matters
_SAMPLES = 2500  # of a record, that impacts are fitted to
_SLOW = 3
_MODULATED = 3
_MEAN_AT = 0.3  # of a line, where the spectrum of drifting noise is what moves the mean
_SLOW_DOUBT = 2.0  # of the noise's variance below the test's frequency: it is extrapolated
_MAINS = (50.0, 60.0)
_NEW = 1e-3  # of the greatest column, that each has to add to those before it


@dataclass(frozen=True)
class RecordRows:
    """A record's rows for regression, white where only noise is left."""

    observation: Observation
    """The record."""
    target: Array
    """(R,) the measured force."""
    project: Callable[[Array], Array]
    """Maps forces (..., N) on the motion's grid to rows (..., R)."""
    informative: float
    """Number of rows in which a model's error would show: few lines carry it."""
    held: tuple[FittedTerm, ...] = ()
    """Terms of the model in this record that are not fitted."""
    cycle_rows: Array | csr_array | None = None
    """(G, R) maps a force on the cycle's grid to rows, as `project` does with the same force at
    the samples; None where there is no cycle."""
    sample_rows: Array | None = None
    """(N, R) of `project`, where that is all it does; None where it is not one matrix."""
    steady: int | None = None
    """Number of the first rows, which a change over the record's time leaves; None: all."""

    @cached_property
    def sizes(self) -> dict[str, float]:
        """Greatest displacement (m), speed (m/s) and measured force (N)."""
        motion = self.observation.motion
        return {
            "displacement": float(np.abs(motion.displacement).max()),
            "speed": float(np.abs(motion.velocity).max()),
            "force": float(np.abs(self.observation.measured).max()),
        }

    @cached_property
    def samples(self) -> RecordRows:
        """The first samples of a sine test, over their noise, as rows; others as they are.

        Impacts are shorter than the shortest harmonic: only samples see when they happen.
        """
        o = self.observation
        if o.cycle is None or not o.record.uniform:
            return self
        count = min(o.time.size, _SAMPLES)
        floor = _TOLERANCE**2 * o.windows[0].power
        noise = sum(w.share * w.noise_power for w in o.windows)
        scale = 1.0 / np.sqrt(noise + floor)

        def project(columns: Array) -> Array:
            return np.asarray(scale * np.asarray(columns)[..., :count])

        o = o.resolved
        on_cycle = scale * _between(o)[:, :count]
        return RecordRows(o, project(o.measured), project, 8.0, self.held, on_cycle)


def weighed_by(rows: RecordRows, noise: float) -> RecordRows:
    """Return rows whose noise is that many times what it was."""
    return _mapped(rows, diags_array(np.full(rows.target.size, 1.0 / noise), format="csr"))


def smoothed(samples: RecordRows, width: float) -> RecordRows:
    """Return samples each averaged twice over a share of a cycle; others as they are."""
    o = samples.observation
    if samples.cycle_rows is None or samples.sample_rows is not None:
        return samples
    count = int(width / (o.motion.step * o.frequency))
    if count < 2:
        return samples
    kernel = np.convolve(np.full(count, 1.0 / count), np.full(count, 1.0 / count))
    places = np.arange(kernel.size) - count + 1
    size = samples.target.size
    return _mapped(samples, diags_array(kernel, offsets=places, shape=(size, size), format="csr"))


def _mapped(rows: RecordRows, onto: csr_array) -> RecordRows:
    """Return rows that are combined by a matrix (R, R)."""

    def project(columns: Array) -> Array:
        return np.asarray(rows.project(columns) @ onto)

    on_cycle = None if rows.cycle_rows is None else rows.cycle_rows @ onto
    at_samples = None if rows.sample_rows is None else rows.sample_rows @ onto
    return replace(
        rows, target=rows.target @ onto, project=project, cycle_rows=on_cycle,
        sample_rows=at_samples,
    )


def record_rows(
    observation: Observation, *, held: tuple[FittedTerm, ...] = ()
) -> RecordRows:
    """Return the rows of an observation, of whose model `held` is not fitted."""
    if observation.kind == "sine":
        return _sine_rows(observation, held)
    windows = observation.windows
    scales = []
    for w in windows:
        floor = _TOLERANCE**2 * w.power / max(w.omega.size, 1)
        scales.append(np.tile(1.0 / np.sqrt(w.variance + floor), 2))

    def project(columns: Array) -> Array:
        parts = [real_rows(w.project(columns)) * s for w, s in zip(windows, scales, strict=True)]
        return np.concatenate(parts, axis=-1)

    target = np.concatenate(
        [real_rows(w.force) * s for w, s in zip(windows, scales, strict=True)]
    )
    return RecordRows(observation, target, project, 8.0 * len(windows), held)


def _sine_rows(observation: Observation, held: tuple[FittedTerm, ...]) -> RecordRows:
    window = observation.windows[0]
    time, size = observation.time, observation.time.size
    count = window.omega.size - 1
    frequency = window.frequency
    duration = float(time[-1] - time[0])
    harmonics = harmonic_design(time, frequency, count)[:, : 2 * count + 1]
    late = 2.0 * (time - time[0]) / duration - 1.0
    slow = np.polynomial.legendre.legvander(late, _SLOW)[:, 1:]
    parts, lines = [harmonics, slow], [0.0] * _SLOW
    long_enough = duration * frequency > 3.0
    if long_enough:
        lowest = harmonics[:, 1 : 1 + 2 * min(_MODULATED, count)]
        parts += [lowest * slow[:, [order]] for order in (0, 1)]
        lines += 2 * [float(k // 2 + 1) for k in range(lowest.shape[1])]
    basis = _orthonormal(np.concatenate(parts, axis=1))
    order = np.concatenate(([0.0], np.repeat(np.arange(1.0, count + 1), 2), lines)).astype(int)
    if observation.noise is not None:
        wanted = order * frequency
        wanted[0] = _MEAN_AT / duration
        wanted[2 * count + 1 : 2 * count + 1 + _SLOW] = 0.5 * np.arange(1, _SLOW + 1) / duration
        variance = 0.5 * observation.noise.at(wanted) * size / duration
        variance += size * _TOLERANCE**2 * window.power
    else:
        variance = size * (window.variance + _TOLERANCE**2 * window.power)[order]
    variance[2 * count + 1 :] *= _SLOW_DOUBT
    variance[0] *= _SLOW_DOUBT
    hum = _hum(order * frequency, 2.0 / duration, (size - 1) / duration)
    variance[np.logical_and(hum, order > 2)] *= 1e4
    scale = 1.0 / np.sqrt(variance)
    whitened = basis * scale

    def project(columns: Array) -> Array:
        return np.asarray(columns @ whitened)

    return RecordRows(
        observation, project(observation.measured), project, 8.0, held,
        _cycle_rows(observation, whitened), whitened, 2 * count + 1,
    )


def _orthonormal(columns: Array) -> Array:
    """Return columns (N, K) made orthonormal one after the other, each along what is new of it.

    By Cholesky's factor of their products, whose round-off is that of their condition squared.
    """
    try:
        triangle = np.linalg.cholesky(columns.T @ columns).T
    except np.linalg.LinAlgError:
        triangle = np.zeros((1, 1))
    new = np.diagonal(triangle)
    if new.min() > _NEW * new.max():
        return np.asarray(solve_triangular(triangle, columns.T, trans="T", check_finite=False).T)
    basis, triangle = np.linalg.qr(columns)
    return np.asarray(basis * np.sign(np.diagonal(triangle)))


def _cycle_rows(observation: Observation, whitened: Array) -> Array | None:
    """Return the rows (G, R) of the cycle's points."""
    return None if observation.cycle is None else np.asarray(_between(observation) @ whitened)


def _between(observation: Observation) -> csr_array:
    """Return what each of the cycle's points (G) is of each sample (N), between two of them."""
    if observation.cycle is None:
        raise ValueError("only a sine test has a cycle")
    size = observation.cycle.displacement.size
    place = np.mod(observation.motion.time * observation.frequency, 1.0) * size
    before = np.minimum(place.astype(int), size - 1)
    share = place - before
    samples = np.arange(place.size)
    return csr_array(
        (
            np.concatenate([1.0 - share, share]),
            (np.concatenate([before, (before + 1) % size]), np.tile(samples, 2)),
        ),
        shape=(size, place.size),
    )


def _hum(frequencies: Array, width: float, rate: float) -> Array:
    """Return which lines lie on a low multiple of the mains, folded at the sampling rate."""
    multiples = np.array([m * k for m in _MAINS for k in (1, 2, 3)])
    multiples = np.abs(multiples - rate * np.round(multiples / rate))
    distance = np.abs(frequencies[:, None] - multiples)
    return np.asarray(np.any(distance < width, axis=1))

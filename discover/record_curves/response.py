"""What a model leaves of a record: over frequency, over the cycle, with itself later on.

Spectra and coherence by Welch's method: P. D. Welch, IEEE Trans. Audio Electroacoust. 15 (1967) 70.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from discover.motion_fit import Observation
from discover.residual_data import Response
from discover.rows import Accuracy
from models.checks import Array

_SEGMENTS = 8  # of a record, at least, that its spectra are averaged over
_LEAST_SEGMENT = 64  # samples
_POINTS = 120  # of a spectrum as drawn
_PHASES = 48  # parts of a cycle
_LAGS = 40  # samples, up to which what is left is correlated
_EXCITED = 1e-5  # of the displacement's greatest density, below which nothing is asked
_BEYOND = 2.5  # samples a cycle of the band's end, to which band-limited records are thinned

Complex = NDArray[np.complex128]


def response(accuracy: Accuracy) -> Response:
    """Return what the model of `accuracy` leaves of its record, for pictures."""
    from scipy.signal import welch  # loaded where used: it takes its time

    o = accuracy.observation
    place = o.at_samples(o.motion.displacement)
    speed = o.at_samples(o.motion.velocity)
    left = o.measured - accuracy.model_force
    step, even = _at_even_times(o, np.stack([place, o.measured, accuracy.model_force, left]))
    sine = o.kind == "sine"
    size = _segment(even.shape[1], step, o.frequency if sine else None)
    frequency, force = welch(even[1], 1.0 / step, nperseg=size)
    _, spread = welch(even[3], 1.0 / step, nperseg=size)
    inside = frequency > 0.0
    if o.cutoff is not None:
        inside &= frequency <= o.cutoff
    if sine:
        at, stiffness, coherence = _at_one(o, place, accuracy.model_force)
    else:
        at, stiffness, coherence = _over_band(even, step, size, inside)
    shown, force, spread = _merged(frequency[inside], force[inside], spread[inside])
    lag, correlation, limit = _correlation(even[3], step, None if sine else o.cutoff)
    phase, over_phase = _over_phase(place, speed, left)
    along = float(np.sum(accuracy.model_force**2))
    noise = accuracy.noise_power
    return Response(
        frequency=shown,
        force=np.sqrt(force),
        left=np.sqrt(spread),
        noise=_noise(o, shown, noise),
        stiffness_frequency=at,
        stiffness=stiffness[0],
        model_stiffness=stiffness[1],
        coherence=coherence,
        phase=phase,
        over_phase=over_phase,
        lag=lag,
        correlation=correlation,
        correlation_limit=limit,
        gain_percent=100.0 * float(left @ accuracy.model_force) / along if along else 0.0,
        error_over_noise=float(np.sqrt(accuracy.error_power / noise)) if noise > 0.0 else None,
    )


def _at_even_times(o: Observation, signals: Array) -> tuple[float, Array]:
    """Return signals (..., M) at even times, with the step, s."""
    time = o.time
    step = float((time[-1] - time[0]) / (time.size - 1))
    grid = time[0] + step * np.arange(time.size)
    if float(np.max(np.abs(time - grid))) < 0.01 * step:
        return step, signals
    return step, np.stack([np.interp(grid, time, s) for s in signals])


def _segment(size: int, step: float, frequency: float | None) -> int:
    """Return the samples of a segment; whole cycles of a sine test, so that its lines are sharp."""
    wished = max(_LEAST_SEGMENT, size // _SEGMENTS)
    if frequency is not None:
        cycle = 1.0 / (frequency * step)
        wished = max(wished, int(round(4.0 * cycle)))
    return min(size, wished)


def _at_one(o: Observation, place: Array, model: Array) -> tuple[Array, Complex, Array]:
    """Return the dynamic stiffness at a sine test's own frequency."""
    turning = 2.0 * np.pi * o.frequency * (o.time - o.time[0])
    design = np.stack([np.cos(turning), np.sin(turning), np.ones_like(turning)], axis=1)
    signals = np.stack([place, o.measured, model], axis=1)
    found = np.linalg.lstsq(design, signals, rcond=None)[0]
    phasors = found[0] - 1j * found[1]
    stiffness = (phasors[1:] / phasors[0])[:, None]
    return np.array([o.frequency]), stiffness, np.zeros(0)


def _over_band(
    even: Array, step: float, size: int, inside: NDArray[np.bool_]
) -> tuple[Array, Complex, Array]:
    """Return the dynamic stiffness and coherence of a record that holds many frequencies."""
    from scipy.signal import csd, welch

    place, measured, model = even[:3]
    frequency, along = welch(place, 1.0 / step, nperseg=size)
    _, power = welch(measured, 1.0 / step, nperseg=size)
    cross = np.stack([csd(place, f, 1.0 / step, nperseg=size)[1] for f in (measured, model)])
    kept = inside & (along > _EXCITED * float(along[inside].max(initial=0.0)))
    places = np.flatnonzero(kept)
    if places.size > _POINTS:
        wanted = np.geomspace(places[0] + 1, places[-1] + 1, _POINTS) - 1
        places = np.unique(places[np.searchsorted(places, wanted.astype(int))])
    stiffness = cross[:, places] / along[places]
    scale = np.maximum(along[places] * power[places], 1e-300)
    coherence = np.clip(np.abs(cross[0, places]) ** 2 / scale, 0.0, 1.0)
    if size * 2 > place.size:  # one segment is coherent with anything
        coherence = np.full(places.size, np.nan)
    return frequency[places], stiffness, coherence


def _merged(frequency: Array, *densities: Array) -> tuple[Array, ...]:
    """Return densities averaged over stretches of the logarithm of frequency."""
    if frequency.size <= _POINTS:
        return (frequency, *densities)
    edges = np.geomspace(frequency[0], frequency[-1] * 1.0001, _POINTS + 1)
    stretch = np.digitize(frequency, edges)
    _, first = np.unique(stretch, return_index=True)
    count = np.diff(np.append(first, frequency.size))
    return tuple(np.add.reduceat(v, first) / count for v in (frequency, *densities))


def _noise(o: Observation, frequency: Array, power: float) -> Array:
    """Return the noise's density, N/sqrt(Hz): of a sine test between its harmonics, else by line.

    The lines' variances tell its course; its power tells its height.
    """
    if o.noise is not None:
        return np.sqrt(o.noise.at(frequency))
    if o.kind == "sine" or not power:
        return np.zeros(0)
    level = np.zeros(frequency.size)
    for w in o.windows:
        order = np.argsort(w.omega)
        level += w.share * np.interp(
            frequency, w.omega[order] / (2.0 * np.pi), w.variance[order]
        )
    whole = float(np.trapezoid(level, frequency))
    return np.sqrt(level * power / whole) if whole > 0.0 else np.zeros(0)


def _over_phase(place: Array, speed: Array, left: Array) -> tuple[Array, Array]:
    """Return the mean of what is left over the cycle's phase, in turns."""
    x, v = (s / (float(np.std(s)) or 1.0) for s in (place - float(np.mean(place)), speed))
    turn = np.mod(np.arctan2(-v, x), 2.0 * np.pi)
    stretch = np.minimum((turn * (_PHASES / (2.0 * np.pi))).astype(int), _PHASES - 1)
    count = np.bincount(stretch, minlength=_PHASES)
    total = np.bincount(stretch, weights=left, minlength=_PHASES)
    mean = np.divide(total, count, out=np.full(_PHASES, np.nan), where=count > 0)
    return (np.arange(_PHASES) + 0.5) / _PHASES, mean


def _correlation(left: Array, step: float, cutoff: float | None) -> tuple[Array, Array, float]:
    """Return the correlation of what is left with itself; of a band's, at the band's own rate."""
    every = 1 if cutoff is None else max(1, int(1.0 / (_BEYOND * cutoff * step)))
    some = left[::every] - float(np.mean(left[::every]))
    power = float(some @ some)
    count = min(_LAGS, some.size // 4)
    if power <= 0.0 or count < 1:
        return np.zeros(0), np.zeros(0), 0.0
    values = np.array([float(some[:-k] @ some[k:]) / power for k in range(1, count + 1)])
    lag = np.asarray(every * step * np.arange(1, count + 1), dtype=float)
    return lag, values, 1.96 / float(np.sqrt(some.size))

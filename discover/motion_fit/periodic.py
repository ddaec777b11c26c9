"""Records that repeat: the periods are averaged, what differs between them is the noise."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from discover.motion_fit.band import EDGE, RELATIVE_FLOOR, choose_cutoff, smooth
from discover.motion_fit.observation import Lines, Observation, Window
from discover.records import Record
from models.checks import Array, InputError
from models.fractional import spectral_derivative
from models.motion import Motion


def _band_limited_period(time: Array, x: Array, step: float, cutoff: float) -> Motion:
    """Return the motion up to a frequency, Hz, of one period of the displacement."""
    mean = float(x.mean())
    keep = np.fft.rfft(x - mean)
    # Whole periods need no guard: what moves at the band's edge is part of the motion too.
    keep[int(np.ceil(cutoff / EDGE * x.size * step)) + 1 :] = 0.0
    smooth_x = np.fft.irfft(keep, n=x.size)

    def differentiate(orders: Array) -> Array:
        return np.asarray(spectral_derivative(smooth_x, orders, step))

    _, velocity, acceleration = differentiate(np.array([0.0, 1.0, 2.0]))
    return Motion(
        time, smooth_x + mean, velocity, acceleration, differentiate, "weyl", periodic=True
    )


def _projection(period: int, count: int) -> Callable[[Array], Lines]:
    """Return what gives the first lines of columns over one period, root mean square phasors."""
    scale = np.sqrt(2.0) / period

    def project(columns: Array) -> Lines:
        lines = np.fft.rfft(columns, axis=-1)[..., :count] * scale
        lines[..., 0] /= np.sqrt(2.0)
        return np.asarray(lines, dtype=np.complex128)

    return project


def observe_periodic(record: Record, usable: slice, period: int) -> Observation:
    """Return the observation of a record that repeats every `period` samples.

    Periods are averaged; what does not repeat is the noise. Derivatives are spectral.
    """
    if record.displacement is None:
        raise InputError("displacement", expected="given", where=record.file)
    step = record.step
    repeats = record.displacement[usable].size // period
    stop = usable.start + repeats * period if usable.start else repeats * period
    usable = slice(usable.start or 0, stop)
    each_x = record.displacement[usable].reshape(repeats, period)
    each_f = record.force[usable].reshape(repeats, period)
    x, force = each_x.mean(axis=0), each_f.mean(axis=0)
    cutoff = choose_cutoff(np.tile(x, 2), step)
    motion = _band_limited_period(record.time[usable][:period], x, step, cutoff)
    count = int(np.floor(cutoff * period * step)) + 1
    project = _projection(period, count)
    lines = project(force)
    spread = project(each_f - force)
    freedom = max(repeats - 1, 1)
    per_line = np.sum(np.abs(spread) ** 2, axis=0) / (2.0 * freedom * repeats)
    power = float(np.mean(force**2))
    variance = np.maximum(smooth(per_line, freedom), RELATIVE_FLOOR**2 * power)
    x_rms, v_rms = float(np.std(x)), float(np.std(motion.velocity))
    noise_f = float(np.sqrt(np.sum((each_f - force) ** 2) / (freedom * period)))
    noise_x = float(np.sqrt(np.sum((each_x - x) ** 2) / (freedom * period)))
    window = Window(
        omega=2.0 * np.pi * np.arange(count, dtype=np.float64) / (period * step),
        force=lines,
        variance=variance,
        project=project,
        frequency=v_rms / (2.0 * np.pi * x_rms),
        amplitude=float(np.sqrt(2.0) * x_rms),
        speed=float(np.sqrt(2.0) * v_rms),
        rest=float(np.mean((each_f - force) ** 2)),
        noise_power=noise_f**2,
    )
    return Observation(
        record=record,
        kind="periodic",
        motion=motion,
        windows=(window,),
        time=record.time[usable],
        measured=record.force[usable],
        at_samples=lambda column: np.tile(column, repeats),
        displacement_noise=noise_x,
        force_noise=noise_f,
        cutoff=cutoff,
        usable=usable,
    )

"""What kind of test a record is, found from its motion: sine, periodic, transient, trajectory."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from scipy.fft import irfft, next_fast_len, rfft

from discover.records import Record
from discover.sine_fit import FEW_CYCLES, SineFit, fit_sine, local_phasors, strongest_line
from models.checks import Array, InputError

KINDS = ("sine", "periodic", "transient", "trajectory")

_FEWEST_CYCLES = 1.5  # of a sine test
_MOST_DISTORTION = 0.2  # of the velocity: a hydraulic actuator has up to 0.1, a triangle wave 1
_MOST_STRUCTURE = 0.01  # share of the variance that is neither harmonics nor broad-band noise
_FEWEST_PERIODS = 4  # from which averaging over periods tells noise from motion
_REPEATS = 1e-3  # half the mean square change from period to period over the variance
_REST_SPEED = 0.02  # of the peak speed
_REST_FORCE = 0.15  # of the peak force


@dataclass(frozen=True)
class RecordKind:
    """What a record is and which part of it can be used."""

    kind: str
    """"sine", "periodic" (a waveform repeated in whole periods), "transient" (from rest) or
    "trajectory" (anything else: sweep, random, closed loop)."""
    usable: slice
    """Samples that are steady: start-up and run-down of a sine cut off, whole periods."""
    sine: SineFit | None
    """Fit of the displacement over the usable samples, without what it leaves; None where not a
    sine or not measured."""
    period: float | None
    """s, of a sine or periodic record; None otherwise."""
    cycles: float | None
    """Usable cycles of a sine, whole periods of a periodic record; None otherwise."""
    starts_at_rest: bool
    """True where the displacement's first samples have no speed."""

    @property
    def frequency(self) -> float | None:
        """Return the repetition frequency, Hz; None where nothing repeats."""
        return None if self.period is None else 1.0 / self.period

    @property
    def amplitude(self) -> float | None:
        """Return the displacement's fundamental amplitude, m; None where not a fitted sine."""
        return None if self.sine is None else self.sine.amplitude

    def to_dict(self) -> dict[str, Any]:
        """Return the kind with its frequency, cycles and usable range of samples."""
        return {
            "kind": self.kind,
            "usable": [self.usable.start, self.usable.stop],
            "frequency_hz": self.frequency,
            "amplitude_m": self.amplitude,
            "cycles": self.cycles,
            "starts_at_rest": self.starts_at_rest,
        }


def classify(record: Record) -> RecordKind:
    """Return what kind of test a record is, judged by its displacement alone.

    A record is a *sine* where, outside start-up and run-down, one frequency with few percent of
    harmonics explains all but broad-band noise for at least one and a half cycles; *periodic*
    where a waveform repeats over at least four whole periods of an integer number of samples;
    a *transient* where motion and force begin from rest; and a *trajectory* otherwise, of whole
    periods where it repeats two or three times.

    Parameters
    ----------
    record : Record
        Uniformly sampled where it has a displacement.

    Returns
    -------
    RecordKind

    Raises
    ------
    InputError
        Where a record has no displacement and no labelled frequency, or does not move.

    Examples
    --------
    >>> t = np.arange(2000) / 500.0
    >>> x = 0.01 * np.sin(2 * np.pi * 1.6 * t)
    >>> kind = classify(Record("run.csv", t, -100.0 * x, x))
    >>> kind.kind, round(kind.frequency, 6), round(kind.cycles, 3), kind.usable
    ('sine', 1.6, 6.397, slice(0, 2000, None))
    """
    return record.once(_classified)


def _classified(record: Record) -> RecordKind:
    size = record.time.size
    if record.displacement is None:
        if record.frequency is None:
            raise InputError(
                "frequency", expected="given where displacement is not", where=record.file
            )
        cycles = float(record.time[-1] - record.time[0]) * record.frequency
        return RecordKind(
            kind="sine",
            usable=slice(0, size),
            sine=None,
            period=1.0 / record.frequency,
            cycles=cycles,
            starts_at_rest=False,
        )
    x = record.displacement
    if not np.ptp(x) > 0.0:
        raise InputError("displacement", expected="varying", found="a constant", where=record.file)
    power = _power(x)
    rest = _starts_at_rest(x, power)
    steady = _steady_sine(record.time, x, power)
    if steady is not None:
        usable, fit = steady
        fit = replace(fit, residual=fit.residual[:0].copy())  # a kind is kept with its record
        return RecordKind("sine", usable, fit, 1.0 / fit.frequency, fit.cycles, rest)
    repeated = _repetition(x)
    if repeated is not None:
        usable, samples = repeated
        count = (usable.stop - usable.start) / samples
        if count < _FEWEST_PERIODS:
            return RecordKind("trajectory", usable, None, None, None, rest)
        return RecordKind("periodic", usable, None, samples * record.step, count, rest)
    kind = "transient" if rest and _force_at_rest(record.force) else "trajectory"
    return RecordKind(kind, slice(0, size), None, None, None, rest)


def _steady_sine(time: Array, x: Array, power: Array) -> tuple[slice, SineFit] | None:
    """Return the steady part of a sine test and its fit, or None where it is something else."""
    if x.size < 16 or _line_share(power) < 0.3:
        return None
    duration = float(time[-1] - time[0])
    rate = (x.size - 1) / duration
    line = strongest_line(power, rate / next_fast_len(x.size, real=True), duration)
    fit = fit_sine(time, x, near=_if_clear(line, duration))
    usable = slice(0, x.size)
    for _ in range(3):
        found = _steady_part(time, x, fit)
        if found is None:
            return None
        if found == usable:
            break
        usable = found
        fit = fit_sine(time[usable], x[usable])
    velocity = np.arange(fit.coefficients.size) * np.abs(fit.coefficients)
    distortion = float(np.linalg.norm(velocity[2:])) / fit.amplitude
    if fit.cycles < _FEWEST_CYCLES or distortion > _MOST_DISTORTION:
        return None
    variance = fit.noise_rms**2 / max(1.0 - fit.quality, 1e-300) if fit.quality < 1.0 else np.inf
    structure = (fit.noise_rms**2 - fit.white_level**2) / variance
    if fit.quality < 0.8 or structure > _MOST_STRUCTURE:
        return None
    return usable, fit


def _if_clear(line: float, duration: float) -> float | None:
    """Return the frequency of a line, Hz; None where the cycles are too few for its peak."""
    return line if line * duration >= FEW_CYCLES else None


def _detrended(x: Array) -> Array:
    """Return x without its mean and its straight trend."""
    ramp = np.linspace(-1.0, 1.0, x.size)
    return np.asarray(x - x.mean() - ramp * (ramp @ x) / (ramp @ ramp))


def _power(x: Array) -> Array:
    """Return the power spectrum of x, detrended and tapered."""
    padded = next_fast_len(x.size, real=True)
    return np.asarray(np.abs(rfft(_detrended(x) * np.hanning(x.size), padded)) ** 2)


def _line_share(power: Array) -> float:
    """Return the share of a tapered power in the strongest line and its harmonics."""
    peak = int(np.argmax(power))
    width = max(4, peak // 20)
    near = sum(
        float(power[max(k * peak - width, 0) : k * peak + width + 1].sum())
        for k in range(1, 4)
        if k == 1 or peak > 2 * width
    )
    return near / float(power.sum())


def _steady_part(time: Array, x: Array, fit: SineFit) -> slice | None:
    """Return the longest stretch of constant amplitude and phase, or None where it is short.

    It must hold at least three fifths of what moves: a stepped or swept sine is not a sine test.
    """
    if fit.cycles < 3.0:  # too few cycles to tell start-up from steady state
        return slice(0, x.size)
    starts, relative = local_phasors(time, x, fit)
    amplitude, phase = np.abs(relative), np.angle(relative)
    length = x.size - int(starts[-1]) if starts.size else x.size
    level = float(np.median(amplitude[amplitude > 0.3 * amplitude.max()]))
    moving = amplitude > 0.1 * level
    scatter = 1.4826 * float(np.median(np.abs(amplitude[moving] / level - 1.0)))
    direction = np.exp(1j * phase)
    middle = np.median(direction[moving].real) + 1j * np.median(direction[moving].imag)
    turn = np.angle(direction / middle)
    turn_scatter = 1.4826 * float(np.median(np.abs(turn[moving])))
    steady = np.abs(amplitude / level - 1.0) < np.clip(6.0 * scatter, 0.05, 0.25)
    steady &= np.abs(turn) < np.clip(6.0 * turn_scatter, 0.05, 0.25)
    if steady.all():
        return slice(0, x.size)
    edges = np.flatnonzero(np.diff(np.r_[0, steady.astype(np.int8), 0]))
    if edges.size == 0:
        return None
    begins, ends = edges[::2], edges[1::2]
    best = int(np.argmax(ends - begins))
    if ends[best] - begins[best] < 0.6 * np.count_nonzero(moving):
        return None
    period = round(1.0 / (fit.frequency * float(time[1] - time[0])))
    length = max(length, period)
    first = int(starts[begins[best]]) + (period // 2 if begins[best] > 0 else 0)
    last = int(starts[ends[best] - 1]) + length
    last = x.size if ends[best] == steady.size else last - period // 2
    return slice(first, min(last, x.size)) if last - first > 8 else None


def _repetition(x: Array) -> tuple[slice, int] | None:
    """Return the whole periods of a repeating record and the samples per period, or None."""
    for first in (0, x.size // 4):  # a start-up transient is left out at the second try
        period = _period(x[first:])
        if period is None:
            continue
        whole = x.size // period
        rows = x[x.size - whole * period :].reshape(whole, period)
        change = np.mean(np.diff(rows, axis=0) ** 2, axis=1)
        limit = max(5.0 * float(np.median(change)), 2.0 * _REPEATS * float(rows[-1].var()))
        odd = np.flatnonzero(change > limit)
        skip = int(odd[-1]) + 1 if odd.size else 0
        if whole - skip >= 2:
            return slice(x.size - (whole - skip) * period, x.size), period
    return None


def _period(x: Array) -> int | None:
    """Return the smallest lag in samples after which the record repeats, or None."""
    size = x.size
    longest = size // 2
    if longest < 16:
        return None
    z = _detrended(x)
    padded = next_fast_len(2 * size, real=True)
    products = irfft(np.abs(rfft(z, padded)) ** 2, padded)[: longest + 2]
    squares = np.r_[0.0, np.cumsum(z**2)]
    lags = np.arange(longest + 2)
    power = squares[size - lags] + squares[size] - squares[lags]
    change = 1.0 - 2.0 * products / np.maximum(power, 1e-300)  # 0: repeats, about 1: unrelated
    away = int(np.argmax(change > 0.3))
    if not change[away] > 0.3:
        return None
    inner = change[1:-1]
    lowest = (inner <= change[:-2]) & (inner <= change[2:]) & (inner < _REPEATS)
    candidates = np.flatnonzero(lowest[away:]) + away + 1
    for lag in candidates:
        below, here, above = change[lag - 1 : lag + 2]
        curvature = below - 2.0 * here + above
        shift = 0.5 * (below - above) / curvature if curvature > 0.0 else 0.0
        slip = abs(shift) * (size // int(lag))
        noise = here - 0.5 * curvature * shift**2
        # Over all periods the slip must change less than the noise does.
        if 0.5 * curvature * slip**2 < max(0.1 * noise, 1e-6):
            return int(lag)
    return None


def _starts_at_rest(x: Array, power: Array) -> bool:
    """Return whether the speed at the first sample vanishes beside the peak speed.

    The speed is that of a parabola through the first half radian of the fastest motion, so that
    noise averages out; where the sampling or the noise leaves it open the answer is no.
    """
    power = np.cumsum(power)
    fastest = max(int(np.searchsorted(power, 0.99 * power[-1])), 1)  # in bins
    count = min(int(next_fast_len(x.size, real=True) / (4.0 * np.pi * fastest)), x.size // 8)
    if count < 5:
        return False
    index = np.arange(count, dtype=np.float64)
    powers = np.vander(index / count, 3, increasing=True)
    rows = np.linalg.pinv(powers)
    windows = sliding_window_view(x, count)
    speed = np.abs(windows[:: max(1, x.size // 2000)] @ rows[1])
    peak = float(np.quantile(speed, 0.99))
    start = rows @ x[:count]
    noise = float(np.linalg.norm(x[:count] - powers @ start)) / np.sqrt(count - 3.0)
    doubt = 3.0 * noise * float(np.linalg.norm(rows[1]))
    return bool(doubt < 0.05 * peak and abs(start[1]) <= _REST_SPEED * peak + doubt)


def _force_at_rest(force: Array) -> bool:
    """Return whether the first force is small beside its peak."""
    start = float(np.abs(force[:5]).mean())
    return start <= _REST_FORCE * float(np.abs(force).max())

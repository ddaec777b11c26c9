"""Time as measured: rounding told from jitter, jitter resampled, gaps refused."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from discover.records import EVEN, GAP, on_grid
from models.checks import Array, InputError

FEWEST_SAMPLES = 16
"""A record of fewer samples is an error."""

_STRONG = 0.2  # of the step, root mean square: above it resampling costs accuracy


@dataclass(frozen=True)
class Sampled:
    """Columns on the record's final time."""

    time: Array
    """(N,) s, strictly increasing."""
    columns: Mapping[str, Array]
    """(N,) by name."""
    uniform: bool
    """Whether the steps are equal."""
    jitter: float
    """Root mean square deviation from the grid over the step, where resampled; else 0."""


def regular(
    time: Array,
    columns: Mapping[str, Array],
    *,
    raw_time: Array,
    resample: bool,
    where: str,
    place: Callable[[int], str],
) -> Sampled:
    """Return the columns on uniform time, or on time as it is where that is allowed.

    Time that deviates from a uniform grid by no more than its last printed digit (or single
    precision) was uniform and is put back on the grid; other jitter is removed by a cubic spline
    through the samples.

    Parameters
    ----------
    time : ndarray, shape (N,)
        s, as measured.
    columns : mapping of ndarray, shape (N,)
        Everything else.
    raw_time : ndarray, shape (N,)
        In the file's own unit.
    resample : bool
        Resample jitter and refuse gaps; without it non-uniform time stays.
    where : str
        Record, for messages.
    place : callable
        Names a row's place in the file.

    Raises
    ------
    InputError
        On too few samples, time that does not increase, or gaps.
    """
    size = time.size
    if size < FEWEST_SAMPLES:
        raise InputError(
            "samples", expected=f"at least {FEWEST_SAMPLES}", found=str(size), where=where
        )
    index = np.arange(size, dtype=np.float64)
    centred = index - index.mean()
    step = float(centred @ (time - time.mean()) / (centred @ centred))
    grid = time.mean() + step * centred
    deviation = np.abs(time - grid)
    scale = step / _raw_step(raw_time, centred)
    if step > 0.0 and deviation.max() <= max(_rounding(raw_time) * scale, EVEN * step):
        uniform = _anchored(time, step)
        return Sampled(uniform, columns, uniform=True, jitter=0.0)
    _check_increasing(time, where, place)
    if not resample:
        return Sampled(time, columns, uniform=False, jitter=0.0)
    _check_gaps(time, where, place)
    even = np.linspace(time[0], time[-1], size)
    resampled = on_grid(time, columns, even)
    jitter = float(np.sqrt(np.mean((time - even) ** 2)) / step)
    return Sampled(even, resampled, uniform=True, jitter=jitter)


def jitter_text(jitter: float, step: float, *, resampled: bool) -> tuple[str, str]:
    """Return the level and the text of what to tell about a record whose times jitter.

    Examples
    --------
    >>> jitter_text(0.05, 0.001, resampled=True)[0]
    'note'
    """
    text = (
        f"the time steps are not equal ({100.0 * jitter:.2g} % of {step:.4g} s, root mean square):"
    )
    if not resampled:
        return "note", text + " the sine test is fitted at the times as measured"
    text += " resampled onto a uniform grid by a cubic spline"
    if jitter > _STRONG:
        return "warning", text + "; so much jitter costs accuracy at high frequency"
    return "note", text


def _raw_step(raw_time: Array, centred: Array) -> float:
    slope = float(centred @ (raw_time - raw_time.mean()) / (centred @ centred))
    return slope if slope else 1.0


def _anchored(time: Array, step: float) -> Array:
    """Return the uniform grid with the mean of the time, from exactly 0 where it began there."""
    start = float(time.mean()) - step * 0.5 * (time.size - 1)
    if abs(start) < 0.5 * step and time[0] == 0.0:
        start = 0.0
    return np.asarray(start + step * np.arange(time.size), dtype=np.float64)


def _rounding(raw_time: Array) -> float:
    """Return how far rounding can have moved the times, in their unit.

    At most two steps: times printed to the second at 100 Hz say nothing.
    """
    largest = float(np.abs(raw_time).max())
    step = (float(raw_time[-1]) - float(raw_time[0])) / (raw_time.size - 1)
    single = 0.0
    with np.errstate(over="ignore", under="ignore"):
        in_single = raw_time.astype(np.float32).astype(np.float64)
    if np.array_equal(in_single, raw_time):
        single = 1.2e-7 * largest
    for digits in range(13):
        scaled = raw_time * 10.0**digits
        slack = 1e-6 + 4e-16 * largest * 10.0**digits
        if np.abs(scaled - np.round(scaled)).max() < min(slack, 0.01):
            quantum = 10.0**-digits
            # Half a digit from rounding, as much again from a line fitted through rounded times.
            return max(quantum, single) if quantum <= 2.0 * step else single
    return single


def _check_increasing(time: Array, where: str, place: Callable[[int], str]) -> None:
    bad = np.flatnonzero(np.diff(time) <= 0.0)
    if bad.size:
        row = int(bad[0]) + 1
        kind = "repeats" if time[row] == time[row - 1] else "falls"
        more = f" ({bad.size} such places)" if bad.size > 1 else ""
        raise InputError(
            "time",
            expected="strictly increasing",
            found=f"{time[row]:.9g} s after {time[row - 1]:.9g} s: it {kind}{more}",
            where=f"{where} {place(row)}",
        )


def _check_gaps(time: Array, where: str, place: Callable[[int], str]) -> None:
    steps = np.diff(time)
    typical = float(np.median(steps))
    bad = np.flatnonzero(steps > GAP * typical)
    if bad.size:
        row = int(bad[0]) + 1
        more = f" ({bad.size} such gaps)" if bad.size > 1 else ""
        raise InputError(
            "time",
            expected=f"without gaps, sampled every {typical:.6g} s",
            found=f"{steps[row - 1]:.6g} s from {time[row - 1]:.9g} s on{more}",
            where=f"{where} {place(row)}",
        )

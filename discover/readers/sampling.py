"""Time as measured: rounding told from jitter, uneven steps resampled, lost motion refused."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from scipy.ndimage import median_filter

from discover.readers.fastest_motion import fastest_motion
from discover.records import EVEN, GAP, on_grid
from models.checks import Array, Indices, InputError, number

FEWEST_SAMPLES = 16
"""A record of fewer samples is an error."""
LONGEST_GAP = 0.25
"""Of a cycle of the fastest motion: a spline bridges it with an error of 1.6 % of a sine."""

_STRONG = 0.2  # of the step, root mean square: above it resampling costs accuracy
_ENOUGH = 20.0  # samples a cycle of the fastest motion, beyond which a grid needs none
_NEIGHBOURS = 51  # steps whose median is the usual step there
_ANOTHER = 1.8  # times, from which the usual step has changed: jitter moves its median by less
_AT_REST = 0.02  # of the stroke: what moves less is at rest
_REST = 0.125  # of a cycle of the fastest motion, over which it has to move less
_STEPS = (1e-12, 1e9)  # s: beyond them a square is no number


@dataclass(frozen=True)
class Sampled:
    """Columns on the record's final time."""

    time: Array
    """(N,) s, strictly increasing."""
    columns: Mapping[str, Array]
    """(N,) by name."""
    uniform: bool
    """Whether the steps are equal."""
    jitter: float = 0.0
    """Root mean square deviation from the grid over the step, where resampled; else 0."""
    changes: tuple[float, float] | None = None
    """Smallest and largest usual step, s, where the sampling changed in the record."""
    gaps: int = 0
    """Gaps that were bridged."""
    longest_gap: float = 0.0
    """s, of the bridged ones."""
    fastest: float | None = None
    """Hz, the fastest motion, where gaps or a change of step were held to it."""

    @property
    def uneven(self) -> bool:
        """Return whether steps that were not equal have been made so."""
        return bool(self.jitter or self.changes or self.gaps)


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
    precision) was uniform and is put back on the grid; other steps are made equal by a cubic
    spline through the samples. A step that is longer than a quarter of a cycle of the fastest
    motion has lost it.

    Parameters
    ----------
    time : ndarray, shape (N,)
        s, as measured.
    columns : mapping of ndarray, shape (N,)
        Everything else.
    raw_time : ndarray, shape (N,)
        In the file's own unit.
    resample : bool
        Resample, by ``columns["displacement"]``; without it non-uniform time stays.
    where : str
        Record, for messages.
    place : callable
        Names a row's place in the file.

    Raises
    ------
    InputError
        On too few samples, time that does not increase, or gaps that lose the motion.
    """
    size = time.size
    if size < FEWEST_SAMPLES:
        raise InputError(
            "samples", expected=f"at least {FEWEST_SAMPLES}", found=str(size), where=where
        )
    index = np.arange(size, dtype=np.float64)
    centred = index - index.mean()
    step = float(centred @ (time - time.mean()) / (centred @ centred))
    if step > 0.0:
        number("sampling interval", step, at_least=_STEPS[0], at_most=_STEPS[1], where=where)
        grid = time.mean() + step * centred
        scale = step / _raw_step(raw_time, centred)
        allowed = max(_rounding(raw_time) * scale, EVEN * step)
        if np.abs(time - grid).max() <= allowed:
            return Sampled(_anchored(time, step), columns, uniform=True)
    _check_increasing(time, where, place)
    if not resample:
        return Sampled(time, columns, uniform=False)
    return _resampled(time, columns, step, where=where, place=place)


def _resampled(
    time: Array,
    columns: Mapping[str, Array],
    step: float,
    *,
    where: str,
    place: Callable[[int], str],
) -> Sampled:
    """Return the columns on a grid, or raise where the motion between samples is lost."""
    steps = np.diff(time)
    usual = median_filter(steps, size=min(_NEIGHBOURS, steps.size), mode="nearest")
    low, high = float(usual.min()), float(usual.max())
    changes = (low, high) if high > _ANOTHER * low else None
    gap = steps > GAP * (np.median(steps) if changes is None else usual)
    if changes is None and not gap.any():
        even = np.linspace(time[0], time[-1], time.size)
        jitter = float(np.sqrt(np.mean((time - even) ** 2)) / step)
        return Sampled(even, on_grid(time, columns, even), uniform=True, jitter=jitter)
    fastest = fastest_motion(time, columns["displacement"])
    _check_gaps(time, columns["displacement"], fastest, where, place)
    # The coarsest steps that lose nothing: finer ones would only repeat what was measured.
    chosen = float(np.clip(1.0 / (_ENOUGH * fastest), low, high))
    count = max(round(float(time[-1] - time[0]) / chosen) + 1, FEWEST_SAMPLES)
    even = np.linspace(time[0], time[-1], count)
    return Sampled(
        even,
        on_grid(time, columns, even),
        uniform=True,
        changes=changes,
        gaps=int(np.count_nonzero(gap)),
        longest_gap=float(steps[gap].max()) if gap.any() else 0.0,
        fastest=fastest,
    )


def resampling_text(sampled: Sampled, *, resampled: bool) -> tuple[str, str]:
    """Return the level and the text of what to tell about steps that were not equal.

    Parameters
    ----------
    sampled : Sampled
        From `regular`, uneven.
    resampled : bool
        Whether its grid is used: a sine test is fitted at the times as measured.

    Examples
    --------
    >>> t = np.arange(4.0)
    >>> resampling_text(Sampled(t, {}, uniform=True, jitter=0.05), resampled=True)[0]
    'note'
    """
    step = float(sampled.time[-1] - sampled.time[0]) / (sampled.time.size - 1)
    level, parts = "note", []
    if sampled.jitter:
        share = f"{100.0 * sampled.jitter:.2g} % of {step:.4g} s, root mean square"
        parts.append(f"the time steps are not equal ({share})")
    if sampled.changes:
        low, high = sampled.changes
        parts.append(f"the sampling changes within the record, from {low:.4g} to {high:.4g} s")
    if sampled.gaps and sampled.fastest:
        many = f"{sampled.gaps} gaps, the longest of" if sampled.gaps > 1 else "a gap of"
        rests = "at rest or " if sampled.longest_gap > LONGEST_GAP / sampled.fastest else ""
        parts.append(
            f"{many} {sampled.longest_gap:.4g} s, {rests}short beside its fastest motion"
            f" ({sampled.fastest:.3g} Hz)"
        )
    text = "; ".join(parts)
    if not resampled:
        return "note", text + ": the sine test is fitted at the times as measured"
    text += ": resampled onto a uniform grid by a cubic spline"
    if sampled.changes or sampled.gaps:
        text += f", every {step:.4g} s"
    if sampled.jitter > _STRONG:
        level = "warning"
        text += "; so much jitter costs accuracy at high frequency"
    return level, text


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
        single = 1.2e-7 * largest if 1.2e-7 * largest <= 2.0 * step else 0.0
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
            found=f"{time[row]:.9g} s after {time[row - 1]:.9g} s: it {kind}{more}; "
            + _remedy(time, bad),
            where=f"{where} {place(row)}",
        )


def _remedy(time: Array, bad: Indices) -> str:
    """Return what to do about time that does not increase."""
    steps = np.diff(time)
    if (steps[bad] == 0.0).all() and 4 * bad.size > steps.size:
        return (
            "many samples share one time, which is too coarse: give `sampling_rate` in [[records]],"
            " or --sampling-rate to `inerter init`"
        )
    tests = np.diff(np.r_[0, bad + 1, time.size])  # samples of each
    if tests.min() >= FEWEST_SAMPLES and (time[bad + 1] <= time[0]).all():
        return (
            'it begins again, as of several tests in one table: `group = "*"` in [[records]], of a'
            " workbook `sheet`, makes a record of each"
        )
    return "mend the file, or take the part before or after by `range` in [[records]]"


def _check_gaps(
    time: Array, displacement: Array, fastest: float, where: str, place: Callable[[int], str]
) -> None:
    steps = np.diff(time)
    longest = LONGEST_GAP / fastest
    # A logger may save little while nothing moves: there it loses nothing.
    long = np.flatnonzero(steps > longest)
    rests = (_rests(time, displacement, int(row), _REST / fastest) for row in long)
    bad = long[~np.fromiter(rests, dtype=bool, count=long.size)]
    if bad.size:
        row = int(bad[0]) + 1
        more = f" ({bad.size} such gaps)" if bad.size > 1 else ""
        raise InputError(
            "time",
            expected=f"without gaps of more than {longest:.4g} s, a quarter of a cycle of its"
            f" fastest motion ({fastest:.3g} Hz)",
            found=f"{steps[row - 1]:.6g} s from {time[row - 1]:.9g} s on{more}; cut the record"
            " there, or measure again",
            where=f"{where} {place(row)}",
        )


def _rests(time: Array, displacement: Array, row: int, span: float) -> bool:
    """Return whether the device rests over the step after a row.

    It is where it was, and before or after the step nothing moves for a `span` (s).
    """
    first, last = np.searchsorted(time, [time[row] - span, time[row + 1] + span])
    least = _AT_REST * float(np.ptp(displacement))
    before, after = displacement[first : row + 1], displacement[row + 1 : last]
    moved = abs(float(displacement[row + 1] - displacement[row]))
    return bool(moved <= least and min(np.ptp(before), np.ptp(after)) <= least)

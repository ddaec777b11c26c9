"""A sine test's force read late: behind a low-pass, or aligned from samples."""

from __future__ import annotations

import math
from collections.abc import Callable, Hashable
from dataclasses import replace

import numpy as np

from discover.motion_fit import Lines, Observation
from discover.naming.last import Last
from discover.naming.scales import COARSE
from models.checks import Array
from models.terms.low_pass import earlier, low_passed_lines, low_passed_samples
from models.terms.time_delay import Late, read_late

ForceOn = Callable[[Observation], Array]

_BEYOND = 4  # samples beyond a delay, that a spline needs
_RESOLVED = 8.0  # steps of a cycle's grid, from which a filter's time constant shows on it
_FINEST = 65536  # points of a cycle: beyond them are harmonics that no record shows
_REGULAR = 0.1  # of the sampling interval, by which times of regular samples differ
_MOST_MISSING = 16  # samples in a row
_DIGITAL = 0.01, COARSE  # samples of delay, between which a digital filter is its own
_SETTLES = 20.0  # delays, after which a filter has forgotten


def at(observation: Observation, time: Array) -> Observation:
    """Return a sine test at other times."""
    if observation.at is None:
        raise ValueError("only a sine test's motion is known at other times")
    return replace(observation, motion=observation.at(time))


def from_cycle(observation: Observation, force: Array) -> Array:
    """Return a force on a grid over one cycle (G,) at the record's samples, (N,)."""
    phase = np.mod(observation.motion.time * observation.frequency, 1.0)
    grid = np.arange(force.size + 1) / force.size
    return np.asarray(np.interp(phase, grid, np.append(force, force[0])))


_LINES: Last[Lines] = Last()  # behind many filters the force is the same
_LONGER: Last[Observation] = Last()  # by nearly equal delays
_LATE: Last[Late] = Last()  # by any delay
_BEFORE: Last[Array] = Last()  # behind many digital filters it is the same


def low_passed(
    observation: Observation, force: ForceOn, key: Hashable, delay: float, order: int
) -> Array:
    """Return a steady force behind a low-pass that delays slow forces, (N,) N.

    It is taken over one cycle, on a grid that is fine enough for the filter.

    Parameters
    ----------
    observation : Observation
        Of a sine test.
    force : callable
        Of it at other times.
    key : hashable
        What the force depends on.
    delay : float
        Of slow forces, s.
    order : int
        Of the filter.
    """
    cycle = observation.cycle
    if cycle is None or not shows(observation, delay):
        points = math.ceil(math.log2(_RESOLVED / (observation.frequency * delay)))
        cycle = observation.cycle_of(min(2**points, _FINEST))
    there = replace(observation, motion=cycle)
    lines = _LINES.of(cycle, (key, _grid(observation)), lambda: np.fft.rfft(force(there)))
    passed = low_passed_lines(lines, cycle.time.size, cycle.step, delay, order)
    return from_cycle(observation, passed)


def shows(observation: Observation, delay: float) -> bool:
    """Tell whether a low-pass's delay (s) shows on the grid of the record's cycle."""
    return observation.cycle is not None and delay > _RESOLVED * observation.cycle.step


def _grid(observation: Observation) -> int:
    """Return the number of points on which what has memory is evaluated."""
    return 0 if observation.cycle is None else observation.cycle.time.size


def summed(observation: Observation, force: ForceOn, delay: float, order: int) -> Array:
    """Return the same of a force that has no cycle, as a spline through samples has none."""
    ago, weights = earlier(order)
    moments = observation.motion.time - delay * ago[:, None]
    return np.asarray(weights @ [force(at(observation, time)) for time in moments])


def aligned(
    observation: Observation, force: ForceOn, key: Hashable, delay: float, degree: int
) -> Array:
    """Return a force as shifted by a spline through samples, some of them beyond the record."""
    own = observation.motion.time
    most = min(int(abs(delay) / _step(own)) + _BEYOND, own.size)
    longer = _longer(observation, most if delay >= 0.0 else -most)
    whole = longer.motion.time
    late = _LATE.of(longer.motion, (key, degree), lambda: read_late(force(longer), whole, degree))
    return late(delay)[np.searchsorted(whole, own)]


def is_digital(observation: Observation, delay: float) -> bool:
    """Tell whether a digital filter of a delay (s) differs from an analogue one on a record.

    Of a record whose samples do not follow each other evenly nothing digital is known.
    """
    own = observation.motion.time
    step = _step(own)
    least, most = _DIGITAL
    if not least * step < delay < most * step:
        return False
    spacing = np.diff(_with_missing(own, step))
    return bool(np.abs(spacing - step).max() < _REGULAR * step)


def low_passed_digitally(
    observation: Observation, force: ForceOn, key: Hashable, delay: float, order: int
) -> Array:
    """Return a force behind a low-pass that works on the samples, for long before the record."""
    own = observation.motion.time
    longer = _longer(observation, math.ceil(_SETTLES * _DIGITAL[1]))
    before = _BEFORE.of(longer.motion, key, lambda: force(longer))
    passed = low_passed_samples(before, _step(own), delay, order)
    return passed[np.searchsorted(longer.motion.time, own)]


def _step(time: Array) -> float:
    return float(np.median(np.diff(time)))


def _longer(observation: Observation, samples: int) -> Observation:
    """Return a sine test with so many samples before it (or after it, where negative)."""

    def make() -> Observation:
        own = observation.motion.time
        step = _step(own)
        beyond = step * np.arange(1, abs(samples) + 1)
        before = own[:0] if samples < 0 else own[0] - beyond[::-1]
        after = own[-1] + beyond if samples < 0 else own[:0]
        return at(observation, np.concatenate([before, _with_missing(own, step), after]))

    return _LONGER.of(observation.motion, (samples, _grid(observation)), make)


def _with_missing(time: Array, step: float) -> Array:
    """Return the times of regular samples with those that are missing.

    A record may have lost some, and a sine test's fit leaves out those at its reversals.
    """
    spacing = np.diff(time)
    missing = np.round(spacing / step).astype(int) - 1
    regular = np.abs(spacing - (missing + 1) * step) < _REGULAR * step
    if not 0 < missing.max(initial=0) <= _MOST_MISSING or not regular.all():
        return time
    behind = np.repeat(time, np.append(missing, 0))  # of each missing one the last that is there
    ahead = np.arange(behind.size) - np.searchsorted(behind, behind) + 1
    return np.sort(np.concatenate([time, behind + ahead * step]))

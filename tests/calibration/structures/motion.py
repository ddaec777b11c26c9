"""Exact motions: a sum of harmonics of a period, on a dense grid and at a record's samples."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy import fft

Array = np.ndarray
_DIRECT = 8  # lines up to which a sum at each sample is cheaper than the grid


@dataclass(frozen=True, eq=False)
class Motion:
    """x(t) = Re sum_k X_k exp(2 pi i k t/T), steady since ever."""

    period: float
    """T, s; far longer than the record where the motion starts from rest."""
    lines: Array
    """(K,) complex amplitudes X_k of the harmonics 0 to K - 1, m."""
    size: int
    """Points of the dense grid over one period."""
    time: Array
    """(N,) sample times within the period's frame, s."""
    places: Array | None = None
    """(N,) samples' places on the grid; None where they lie between its points."""
    repeats: bool = True
    """True where the record sees the steady state: friction's memory is run in beforehand."""

    @cached_property
    def rates(self) -> Array:
        """(K,) angular frequencies, rad/s."""
        return 2.0 * np.pi / self.period * np.arange(self.lines.size)

    def operated(self, order: float) -> Array:
        """Return the complex lines (K,) of the derivative of an order: (i omega)^order X."""
        return np.asarray(np.power(1j * self.rates, order) * self.lines)

    def grid(self, order: float) -> Array:
        """Return the derivative of an order on the grid (G,)."""
        return on_grid(self.operated(order), self.size)

    def samples(self, order: float) -> Array:
        """Return the derivative of an order at the samples (N,)."""
        if self.places is not None:
            return self.grid(order)[self.places]
        if self.lines.size <= _DIRECT:
            return at_times(self.operated(order), self.rates, self.time)
        return self.sampled(self.grid(order))

    def sampled(self, values: Array) -> Array:
        """Return values given on the grid (G,) at the samples (N,), linear between points."""
        if self.places is not None:
            return np.asarray(values[self.places])
        step = self.period / self.size
        place = np.mod(self.time, self.period) / step
        low = np.floor(place).astype(int)
        part = place - low
        low %= self.size
        return np.asarray((1.0 - part) * values[low] + part * values[(low + 1) % self.size])

    @cached_property
    def grid_x(self) -> Array:
        """(G,) displacement, m."""
        return self.grid(0.0)

    @cached_property
    def grid_v(self) -> Array:
        """(G,) velocity, m/s."""
        return self.grid(1.0)

    @cached_property
    def x(self) -> Array:
        """(N,) displacement at the samples, m."""
        return self.samples(0.0)

    @cached_property
    def v(self) -> Array:
        """(N,) velocity at the samples, m/s."""
        return self.samples(1.0)

    @cached_property
    def a(self) -> Array:
        """(N,) acceleration at the samples, m/s^2."""
        return self.samples(2.0)

    @cached_property
    def top_speed(self) -> float:
        """Greatest speed within the record, m/s."""
        return float(np.max(np.abs(self.v)))

    @cached_property
    def stroke(self) -> float:
        """Half of the way between the record's extremes, m."""
        return float(0.5 * np.ptp(self.x))


def on_grid(lines: Array, size: int) -> Array:
    """Return Re sum_k c_k exp(2 pi i k j/size) for lines (K,) at j = 0 to size - 1."""
    spectrum = np.zeros(size // 2 + 1, dtype=complex)
    count = min(lines.size, spectrum.size)
    spectrum[:count] = 0.5 * size * lines[:count]
    spectrum[0] = size * lines[0].real
    return np.asarray(fft.irfft(spectrum, n=size))


def lines_of(values: Array, count: int) -> Array:
    """Return the complex lines (count,) whose sum is a signal given on a grid (G,)."""
    lines = np.asarray(fft.rfft(values))[:count] * (2.0 / values.size)
    lines[0] *= 0.5
    return lines


def at_times(lines: Array, rates: Array, time: Array) -> Array:
    """Return Re sum_k c_k exp(i omega_k t) at any times (N,)."""
    result = np.zeros(time.size)
    for line, rate in zip(lines, rates, strict=True):
        if line != 0.0:
            result += (line * np.exp(1j * rate * time)).real
    return result


GRID = 16384
"""Points a period of a sine test: some tens within the presliding of the greatest amplitude."""


def sine(
    frequency: float,
    amplitude: float,
    time: Array,
    *,
    phase: float = 0.0,
    harmonics: tuple[complex, ...] = (),
    size: int = GRID,
) -> Motion:
    """Return a sine test, with harmonics from the second on as shares of the amplitude."""
    lines = amplitude * np.array([0.0, -1j, *harmonics], dtype=complex)
    lines *= np.exp(1j * phase * np.arange(lines.size))
    return Motion(1.0 / frequency, lines, size, time)


def ramp(s: Array) -> Array:
    """Return a rise from 0 to 1 over s in 0 to 1 with all derivatives zero at both ends."""
    inside = np.clip(s, 1e-3, 1.0 - 1e-3)
    with np.errstate(over="ignore"):
        rise = 1.0 / (1.0 + np.exp(1.0 / inside - 1.0 / (1.0 - inside)))
    return np.where(s <= 0.0, 0.0, np.where(s >= 1.0, 1.0, rise))


def padded(
    values: Array, rate: float, *, oversampling: int, pad: float, places: Array
) -> Motion:
    """Return a motion that rests before and long after the given course.

    Parameters
    ----------
    values : array, shape (M,)
        Displacement on the dense grid, zero at both ends, m.
    rate : float
        Sampling rate of the record, Hz.
    oversampling : int
        Grid points a sample.
    pad : float
        Rest after the course, in lengths of it: what a fractional derivative remembers of the
        period before falls with it.
    places : array of int, shape (N,)
        The samples' places on the grid.
    """
    size = fft.next_fast_len(int(values.size * (1.0 + pad)), real=True)
    whole = np.zeros(size)
    whole[: values.size] = values
    period = size / (rate * oversampling)
    time = places / (rate * oversampling)
    return Motion(period, lines_of(whole, size // 2), size, time, places, repeats=False)

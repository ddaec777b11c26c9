"""A record ready for regression: its motion, and the spectral lines of its force.

Regression works on spectral lines and not on samples. For a sine test the lines are the harmonics
of the force, fitted over all usable cycles; for other records the discrete spectrum of tapered
windows up to the band's end. Both are linear maps of the force, so a term passes the same map,
no phase is lost, and what the records' noise does to each line is known.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from discover.motion_fit.cycle_sums import CycleSums
from discover.motion_fit.noise_spectrum import NoiseSpectrum
from discover.records import Record
from models.checks import Array
from models.motion import Motion, harmonic_motion

Lines = NDArray[np.complex128]
_FINE = 8192  # points of a cycle in which a joint's impacts are simulated
_OUTSIDE = 0.01  # of a motion's square, that is below a record's frequencies, or above
_MOVES = 1e-9  # of the fundamental, below which a harmonic is round-off


def real_rows(lines: Lines) -> Array:
    """Return real and imaginary parts of (..., L) lines as (..., 2 L) rows."""
    return np.concatenate((lines.real, lines.imag), axis=-1)


@dataclass(frozen=True)
class Window:
    """A stretch of a record over which its lines are taken; all of it in a sine test.

    Lines are scaled so that the sum of their squared magnitudes is the mean square of the signal.
    """

    omega: Array
    """(L,) rad/s of the lines."""
    force: Lines
    """(L,) lines of the measured force, N."""
    variance: Array
    """(L,) noise variance of the real (and of the imaginary) part of each line, N^2."""
    project: Callable[[Array], Lines]
    """Maps columns on the motion's grid (..., N) to their lines (..., L)."""
    frequency: float
    """Hz: of the test, or the mean frequency |v|/|x| of the window."""
    amplitude: float
    """m: of the test, or root two times the displacement's standard deviation."""
    speed: float
    """m/s: velocity amplitude, likewise."""
    rest: float
    """N^2: mean square of the measured force that is in none of the lines."""
    noise_power: float
    """N^2: mean square of the force's noise."""
    share: float = 1.0
    """Part of the record's duration."""
    through: Array | None = None
    """(L,) of the variance, what the displacement's noise makes, N^2; None where it is not apart.
    """

    @property
    def power(self) -> float:
        """Mean square of the measured force, N^2."""
        return float(np.sum(np.abs(self.force) ** 2)) + self.rest


@dataclass(frozen=True)
class Observation:
    """A record with its motion and its windows."""

    record: Record
    """As read."""
    kind: str
    """"sine", "periodic", "transient" or "trajectory"."""
    motion: Motion
    """At the usable samples (of one period where they repeat exactly)."""
    windows: tuple[Window, ...]
    """At least one."""
    time: Array
    """(M,) s: the usable samples."""
    measured: Array
    """(M,) N: the usable force; low-passed to the band where the record is not a sine test."""
    at_samples: Callable[[Array], Array]
    """Maps a column on the motion's grid (N,) to the usable samples (M,)."""
    displacement_noise: float
    """m, root mean square."""
    force_noise: float
    """N, root mean square."""
    cutoff: float | None
    """Hz: end of the band; None for a sine test."""
    phase_fitted: bool = False
    """True where the record has no displacement and the motion's phase was fitted."""
    drift: float = 0.0
    """N/s: straight trend of the force that the lines exclude."""
    cycle: Motion | None = None
    """One cycle of a sine test on a dense grid, for steady-state simulation; None otherwise."""
    at: Callable[[Array], Motion] | None = None
    """The motion of a sine test at other times (M,), s; None where only the force's lines can be
    shifted."""
    noise: NoiseSpectrum | None = None
    """Of the force in a sine test that was sampled uniformly."""
    test: int = 0
    """Number of the record in its campaign, from 1; 0 where it is not known."""
    usable: slice = field(default_factory=lambda: slice(None))
    """Samples of the record that are used."""
    motion_error: Array = field(default_factory=lambda: np.zeros(0))
    """(H + 1,) m: standard error of the real (and of the imaginary) part of each phasor of a sine
    test's displacement; none where it is not measured."""
    sums: CycleSums | None = None
    """Of all usable samples of a sine test that has many; where they are not all held, `time`,
    `motion` and `measured` hold the first."""

    @property
    def samples(self) -> int:
        """Number of usable samples, in memory or not."""
        return self.measured.size if self.sums is None else self.sums.samples

    @property
    def whole(self) -> bool:
        """True where `time` and `measured` hold all usable samples."""
        return self.sums is None or self.sums.samples <= self.measured.size

    @property
    def duration(self) -> float:
        """s, from the first usable sample to the last."""
        if self.sums is not None:
            return self.sums.last - self.sums.first
        return float(self.time[-1] - self.time[0])

    @cached_property
    def resolved(self) -> Observation:
        """The same with a cycle whose grid shows impacts, which are shorter than a harmonic."""
        if self.cycle is None or self.cycle.displacement.size >= _FINE:
            return self
        return replace(self, cycle=self.cycle_of(_FINE))

    def cycle_of(self, points: int) -> Motion:
        """Return one cycle of a sine test on a grid of so many points, made once for each number.

        Raises
        ------
        ValueError
            For a record that is not a sine test.
        """
        if points not in self._cycles:
            self._cycles[points] = harmonic_motion(self._moving, self.frequency, samples=points)
        return self._cycles[points]

    @cached_property
    def _cycles(self) -> dict[int, Motion]:
        return {}

    @cached_property
    def _moving(self) -> Lines:
        """Phasors of the cycle's displacement up to the last harmonic that moves."""
        if self.cycle is None:
            raise ValueError("only a sine test has a cycle")
        place = self.cycle.displacement
        phasors = np.fft.rfft(place)[: place.size // 2] * (2.0 / place.size)
        phasors[0] *= 0.5
        moves = np.abs(phasors) > _MOVES * np.abs(phasors[1])
        return np.asarray(phasors[: np.flatnonzero(moves)[-1] + 1])

    @property
    def file(self) -> str:
        """Name of the record."""
        return self.record.file

    @property
    def held_out(self) -> bool:
        """True where the record is only predicted."""
        return self.record.held_out

    @property
    def frequency(self) -> float:
        """Hz, mean over windows."""
        return float(np.mean([w.frequency for w in self.windows]))

    @cached_property
    def span(self) -> tuple[float, float]:
        """Hz: the frequency of a sine test, twice; else between which the motion is.

        Below is one percent of the displacement's square, above one of the velocity's: what
        a test moves slowly is seen in its displacement, what it moves fast in its velocity.
        """
        if self.kind == "sine":
            return self.frequency, self.frequency
        time = self.motion.time
        frequency = np.fft.rfftfreq(time.size, time[1] - time[0])[1:]
        taper = np.hanning(time.size + 2)[1:-1]
        ends = []
        for moved, part in (
            (self.motion.displacement, _OUTSIDE), (self.motion.velocity, 1.0 - _OUTSIDE)
        ):
            below = np.cumsum(np.abs(np.fft.rfft(taper * (moved - moved.mean()))[1:]) ** 2)
            ends.append(float(frequency[np.searchsorted(below, part * below[-1])]))
        return ends[0], ends[1]

    @property
    def amplitude(self) -> float:
        """m, greatest over windows."""
        return max(w.amplitude for w in self.windows)

    @property
    def speed(self) -> float:
        """m/s, greatest over windows."""
        return max(w.speed for w in self.windows)

"""Sine tests: motion and force as harmonics, exact for any number of cycles."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.optimize import nnls

from discover.motion_fit.clear_samples import Clear, clear_samples
from discover.motion_fit.cycle_sums import PHASES, STRETCHES, CycleSums, cycle_sums
from discover.motion_fit.harmonic_lines import HarmonicLines, harmonic_lines, lines_of
from discover.motion_fit.noise import density_between_lines
from discover.motion_fit.noise_spectrum import noise_spectrum
from discover.motion_fit.observation import Lines, Observation, Window, real_rows
from discover.motion_fit.sine_found import SineFound
from discover.records import Record
from discover.sine_fit import Harmonics, LongFit, Moments, SineFit, moments
from models.checks import Array, InputError
from models.fractional import harmonic_factors
from models.motion import Motion, harmonic_motion

HARMONICS = 31  # of the force; friction's fall off as 1/k, so further ones decide nothing
GRID = 1024  # points of the one cycle kept for steady-state simulation
RELATIVE_FLOOR = 1e-6  # of the force: no measurement is better, and weights stay finite
_PHASES = 360  # of a motion that is not measured, tried at even steps
_PIECE = 2**16  # samples


def _motion_at(at: Moments, frequency: float, displacement: Lines) -> Motion:
    """Return the steady-state motion at the samples themselves.

    Terms then pass the very sampling that the force passed, and a jump of friction aliases in
    both alike.
    """
    omega = 2.0 * np.pi * frequency * np.arange(displacement.size)
    harmonics = Harmonics(at, frequency)

    def differentiate(orders: Array) -> Array:
        return harmonics.series(harmonic_factors(orders, omega) * displacement)

    x, v, a = differentiate(np.array([0.0, 1.0, 2.0]))
    return Motion(at.time, x, v, a, differentiate, "weyl")


def velocity_phase(displacement: Lines | None) -> float:
    """Return the phase (rad) of the velocity's fundamental, of the displacement's phasors.

    A motion that is not known (None) has none: 0.
    """
    return 0.0 if displacement is None else float(np.angle(displacement[1])) + 0.5 * np.pi


def _resolved_harmonics(samples: int, cycles: float, file: str) -> int:
    """Return how many harmonics the sampling resolves; refuse too few cycles, and none."""
    if cycles < 1.4:
        raise InputError(
            "usable cycles", expected="at least 1.5", found=f"{cycles:.2g}", where=file
        )
    count = int(min(HARMONICS, 0.4 * samples / cycles, (samples - 4) // 3))
    if count < 1:
        raise InputError(
            "sampling", expected="above 2.5 times the frequency", found="less", where=file
        )
    return count


def observe_sine(
    record: Record,
    usable: slice,
    frequency: float,
    sine: SineFit | LongFit | None,
) -> Observation:
    """Return the observation of a sine test.

    Parameters
    ----------
    record : Record
        With or without a displacement.
    usable : slice
        Samples in the steady state.
    frequency : float
        Hz.
    sine : SineFit, LongFit or None
        Of the displacement, m, with its mean and significant harmonics; None where the record has
        no displacement, and then its labelled amplitude is used.

    Returns
    -------
    Observation
        With one window of up to 31 harmonics, their phases counted from the motion's own, so
        that lines of different records can be compared.

    Raises
    ------
    InputError
        Where fewer than one and a half cycles are usable, or the sampling resolves no harmonic.
    """
    return observed(record, *find_sine(record, usable, frequency, sine))


def find_sine(
    record: Record,
    usable: slice,
    frequency: float,
    sine: SineFit | LongFit | None,
) -> tuple[SineFound, Clear]:
    """Return what the samples of a sine test tell, and those that lie clear of reversals.

    Arguments and errors as of `observe_sine`.
    """
    time, force = record.time[usable], record.force[usable]
    displacement = None if sine is None else sine.coefficients
    duration = _duration(time)
    count = _resolved_harmonics(time.size, duration * frequency, record.file)
    middle = _middle(time, frequency)
    clear = clear_samples(time, frequency, displacement)
    at = clear.at
    fit = harmonic_lines(at, frequency, count, middle=middle)
    residual = np.zeros(time.size)
    time, force = at.time, force[clear.kept]
    (solution,) = fit.solve(force[None])
    residual[clear.kept] = force - fit.fitted(solution)
    (lines,) = lines_of(solution[None], count)
    multiples: Array = frequency * np.arange(count + 1, dtype=np.float64)
    if record.uniform:
        density = density_between_lines(residual, record.step, frequency, multiples)
        spectrum = noise_spectrum(time, force, frequency, record.step)
        noise = float(np.sqrt(spectrum.power))
    else:
        spectrum = None
        freedom = max(time.size - solution.size, 1)
        density = np.full(count + 1, 2.0 * duration / time.size * (residual @ residual) / freedom)
        noise = float(np.sqrt(residual @ residual / freedom))
    power = float(np.sum(np.abs(lines) ** 2))
    variance = np.maximum(density / (2.0 * duration), RELATIVE_FLOOR**2 * power)
    fitted_phase = displacement is None
    if displacement is None:
        displacement = _fit_phase(record, lines, fit.lines, at, frequency, variance)
    found = SineFound(
        usable=usable,
        frequency=frequency,
        displacement=displacement,
        force=lines * _turn(displacement, count),
        variance=variance,
        rest=float(residual @ residual / time.size),
        displacement_noise=0.0 if sine is None else sine.noise_rms,
        motion_error=np.zeros(0) if sine is None else sine.std_errors,
        force_noise=noise,
        noise=spectrum,
        phase_fitted=fitted_phase,
        drift=0.0 if middle is None else float(solution[-1]),
        sums=_sums(time, force, frequency),
    )
    return found, clear


def observed(record: Record, found: SineFound, clear: Clear | None = None) -> Observation:
    """Return the observation of a sine test at the samples that are held of it.

    Those that lie `clear` of reversals may be there from finding it.
    """
    time, force = record.time[found.usable], record.force[found.usable]
    frequency, displacement = found.frequency, found.displacement
    if clear is None:
        clear = clear_samples(time, frequency, None if found.phase_fitted else displacement)
    at = clear.at
    amplitude, count = float(abs(displacement[1])), found.force.size - 1
    window = Window(
        omega=2.0 * np.pi * (frequency * np.arange(count + 1, dtype=np.float64)),
        force=found.force,
        variance=found.variance,
        project=_Projection(
            at, frequency, count, _middle(time, frequency), _turn(displacement, count)
        ),
        frequency=frequency,
        amplitude=amplitude,
        speed=2.0 * np.pi * frequency * amplitude,
        rest=found.rest,
        noise_power=found.force_noise**2,
    )
    return Observation(
        record=record,
        kind="sine",
        motion=_motion_at(at, frequency, displacement),
        cycle=harmonic_motion(displacement, frequency, samples=GRID),
        at=lambda time: _motion_at(moments(time), frequency, displacement),
        windows=(window,),
        time=at.time,
        measured=force[clear.kept],
        at_samples=lambda column: column,
        displacement_noise=found.displacement_noise,
        motion_error=found.motion_error,
        force_noise=found.force_noise,
        noise=found.noise,
        cutoff=None,
        phase_fitted=found.phase_fitted,
        drift=found.drift,
        usable=found.usable,
        sums=found.sums,
    )


def _duration(time: Array) -> float:
    return float(time[-1] - time[0]) * time.size / (time.size - 1)


def _middle(time: Array, frequency: float) -> float | None:
    """Return where a drift beside the harmonics is zero, s; None where too few cycles show it."""
    return float(time.mean()) if _duration(time) * frequency > 2.0 else None


def _turn(displacement: Lines, count: int) -> Lines:
    """Return what counts the phases of the mean and `count` harmonics from the motion's own."""
    return np.asarray(np.exp(-1j * np.arange(count + 1) * velocity_phase(displacement)))


@dataclass(frozen=True)
class _Projection:
    """Maps columns at samples to their lines, with phases counted from the motion's own."""

    at: Moments
    frequency: float
    count: int
    middle: float | None
    turn: Lines

    def __call__(self, columns: Array) -> Lines:
        return np.asarray(self._fit.lines(columns) * self.turn)

    @cached_property
    def _fit(self) -> HarmonicLines:
        return harmonic_lines(self.at, self.frequency, self.count, middle=self.middle)


def _sums(time: Array, force: Array, frequency: float) -> CycleSums | None:
    """Return the sums of a record's samples; None where each may be a cell of its own."""
    if time.size <= PHASES * STRETCHES:
        return None
    first, last = float(time[0]), float(time[-1])
    parts = (slice(i, i + _PIECE) for i in range(0, time.size, _PIECE))
    return cycle_sums(((time[p], force[p]) for p in parts), frequency, first, last)


def _fit_phase(
    record: Record,
    force: Lines,
    project: Callable[[Array], Lines],
    at: Moments,
    frequency: float,
    variance: Array,
) -> Lines:
    """Return the phasors of a pure sine in the phase that explains the force best.

    The fundamental alone can't tell the phase from a mixture of inertance and damping; physical
    signs and the harmonics of friction and quadratic damping can.
    """
    if record.amplitude is None:
        raise InputError(
            "amplitude", expected="given where displacement is absent", where=record.file
        )
    harmonic = np.arange(force.size)
    weight = 1.0 / np.sqrt(variance + 1e-4 * np.sum(np.abs(force) ** 2) / np.maximum(harmonic, 1))
    phases = 2.0 * np.pi * np.arange(_PHASES) / _PHASES
    misfit = np.empty(_PHASES)
    for index, phase in enumerate(phases):
        phasors = [0.0, -1j * record.amplitude * np.exp(1j * phase)]
        motion = _motion_at(at, frequency, np.array(phasors))
        v = motion.velocity
        lines = project(np.stack([motion.acceleration, v, v * np.abs(v), np.sign(v)]))
        lines /= np.linalg.norm(lines, axis=1)[:, None]
        misfit[index] = nnls(real_rows(lines * weight).T, real_rows(force * weight))[1]
    return np.array([0.0, -1j * record.amplitude * np.exp(1j * phases[misfit.argmin()])])

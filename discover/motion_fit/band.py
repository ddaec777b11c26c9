"""Records that do not repeat: band-limited motion, and lines of tapered windows."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.fft import next_fast_len
from scipy.ndimage import median_filter, uniform_filter1d
from scipy.special import gammaincinv

from discover.motion_fit.band_noise import band_noise
from discover.motion_fit.noise import power_density
from discover.motion_fit.noise_spectrum import NoiseSpectrum
from discover.motion_fit.observation import Lines, Observation, Window
from discover.records import Record
from models.checks import Array, InputError
from models.fractional import band_limited, low_pass
from models.fractional.lowest_lines import lowest_lines
from models.motion import Motion

_SIGNAL_TO_NOISE = 1000.0  # of the displacement's power, at the edge of the excited band
_GAP = 2.0  # ratio of frequencies between which no line is, for the band to end
EDGE = 0.9  # of that edge: next to it, derivatives lean on what lies beyond
_NYQUIST_SHARE = 0.95  # of the Nyquist frequency, where the band ends at the latest
_FEWEST_LINES = 8  # of the spectrum, that the band holds at least
RELATIVE_FLOOR = 1e-6  # of the force: no measurement is better, and weights stay finite
_TAPER = 0.1  # of a window, over which it crosses into its neighbour
_EDGE_PERIODS = 4.0  # of the band's end, left out at either end of a record
_LINES_PER_WINDOW = 40  # about, below the end of the band
_MAX_WINDOWS = 16  # of one record


def smooth(density: Array, averaged: int = 1) -> Array:
    """Return a power density's running level: the median over half a percent of the bins.

    A median does not spill over the edge of an excited band, as a mean does. Over the mean it is
    that of a gamma law, whose shape is the number of spectra that were `averaged`.
    """
    level = median_filter(density, size=_bins_around(density), mode="nearest")
    return np.asarray(level * averaged / gammaincinv(averaged, 0.5))


def _bins_around(density: Array) -> int:
    """Return how many bins a level is told from: half a percent of all."""
    return 2 * max(density.size // 400, 4) + 1


def floor_of(frequencies: Array, density: Array, above: float) -> float:
    """Return the level of white noise above a frequency, robust to lines in it."""
    tail = density[frequencies > above]
    return float(np.median(tail) / np.log(2.0)) if tail.size else 0.0


def choose_cutoff(displacement: Array, step: float) -> float:
    """Return the end of the band in which displacement stands clear of its noise floor, Hz.

    The edge is where its level, or a line of it, last stands 30 dB above the floor before nothing
    does for an octave: a drive's lines may be few and far between, mains hum is farther. The band
    ends a tenth below it. A displacement that has no floor to stand above, as it moves at all
    frequencies, ends near the Nyquist frequency; where the force no longer follows it is for the
    force to tell.
    """
    return _cutoff(*power_density(displacement - displacement.mean(), step))


def _cutoff(frequencies: Array, density: Array) -> float:
    """Return the end of the band of a displacement's power density, Hz."""
    nyquist = float(frequencies[-1])
    floor = floor_of(frequencies, density, 0.6 * nyquist)
    around = uniform_filter1d(density, _bins_around(density), mode="nearest")
    least = _SIGNAL_TO_NOISE * floor
    lines = (density > least) & (around > least)
    clear = 1 + np.flatnonzero((lines | (smooth(density) > least))[1:])
    edge = EDGE * _last_line(frequencies[clear], density[clear]) if clear.size else nyquist
    return float(min(max(edge, _FEWEST_LINES * frequencies[1]), _NYQUIST_SHARE * nyquist))


def _last_line(frequencies: Array, density: Array) -> float:
    """Return the last of lines (K,) before a gap, Hz, up from the one of most speed."""
    main = int(np.argmax(density * frequencies**2))
    gaps = np.flatnonzero(frequencies[main + 1 :] > _GAP * frequencies[main:-1])
    return float(frequencies[main + gaps[0] if gaps.size else -1])


def _band_motion(
    record: Record, usable: slice, x: Array, cutoff: float, noise: float
) -> Motion:
    """Return the motion up to a frequency, Hz, of a displacement (N,) at the usable samples.

    The displacement has a white `noise` (m, root mean square).
    """
    edge_noise = float(np.clip(noise / np.std(x), 1e-7, 1e-2))
    differentiate = band_limited(x - x[0], record.step, cutoff=cutoff, edge_noise=edge_noise)
    position, velocity, acceleration = differentiate(np.array([0.0, 1.0, 2.0]))
    motion = Motion(
        record.time[usable], position + x[0], velocity, acceleration, differentiate, "band-limited"
    )
    return _measured(record, usable, motion, cutoff)


def _measured(record: Record, usable: slice, motion: Motion, cutoff: float) -> Motion:
    """Return the motion with measured velocity and acceleration in place of derivatives."""
    step = record.step
    columns = {
        name: low_pass(column[usable], step, cutoff=cutoff)
        for name, column in (("velocity", record.velocity), ("acceleration", record.acceleration))
        if column is not None
    }
    if not columns:
        return motion
    return Motion(
        motion.time,
        motion.displacement,
        columns.get("velocity", motion.velocity),
        columns.get("acceleration", motion.acceleration),
        motion.differentiate,
        motion.operator,
    )


def _white_noise(frequencies: Array, density: Array, cutoff: float) -> float:
    """Return the rms of white noise of the density that a displacement has above its band, m."""
    nyquist = float(frequencies[-1])
    above = max(min(1.3 * cutoff, 0.95 * nyquist), 0.6 * nyquist)
    return float(np.sqrt(floor_of(frequencies, density, above) * nyquist))


def _pieces(size: int, cutoff: float) -> list[tuple[int, Array]]:
    """Return start and taper of windows whose squared tapers add up to one.

    Neighbours cross over within a tenth of their length, so no sample counts more than another.
    The record's ends, where derivatives rest on what is not there, are left out: four periods of
    the band's end, at most a twentieth.
    """
    edge = min(int(np.ceil(_EDGE_PERIODS / cutoff)), size // 20)
    inner = size - 2 * edge
    count = int(np.clip(size * cutoff / _LINES_PER_WINDOW, 1, _MAX_WINDOWS))
    half = _crossing(inner, count)
    step = (inner - 2 * half) // count
    length = step + 2 * half
    fade = max(int(np.ceil(1.0 / cutoff)), 1)
    pieces = []
    for index in range(count):
        taper = np.ones(length)
        rise = fade if index == 0 else 2 * half
        fall = fade if index == count - 1 else 2 * half
        taper[:rise] = np.sin(0.5 * np.pi * (np.arange(rise) + 0.5) / rise)
        taper[length - fall :] *= np.cos(0.5 * np.pi * (np.arange(fall) + 0.5) / fall)
        pieces.append((edge + index * step, taper))
    return pieces


def _crossing(inner: int, count: int) -> int:
    """Return half the samples over which windows of equal length cross, so many in `inner`.

    About a twentieth of a window, so that its length is a product of small primes: its spectrum
    then takes a fraction of the time.
    """
    about = max(int(0.5 * _TAPER * inner / count), 1)
    likely = sorted(range(about - about // 4, about + about // 4 + 1), key=lambda h: abs(h - about))
    lengths = ((inner - 2 * h) // count + 2 * h for h in likely)
    fast = (h for h, n in zip(likely, lengths, strict=True) if next_fast_len(n, real=True) == n)
    return next(fast, about)


def _projection(inside: slice, taper: Array, count: int) -> Callable[[Array], Lines]:
    scale = np.sqrt(2.0 / (taper.size * np.sum(taper**2)))
    wanted = lowest_lines(taper.size, count)

    def project(columns: Array) -> Lines:
        lines = wanted.of(columns[..., inside] * taper) * scale
        lines[..., 0] /= np.sqrt(2.0)
        return np.asarray(lines, dtype=np.complex128)

    return project


def _window(
    piece: tuple[int, Array],
    motion: Motion,
    x: Array,
    force: Array,
    noise: NoiseSpectrum,
    *,
    step: float,
    cutoff: float,
    mass: float,
) -> Window:
    """Return the lines of one piece, its start and taper; `mass` is that of all squared tapers."""
    start, taper = piece
    size = taper.size
    inside = slice(start, start + size)
    count = int(np.floor(cutoff * size * step)) + 1
    project = _projection(inside, taper, count)
    frequencies = np.arange(count, dtype=np.float64) / (size * step)
    density = noise.at(np.maximum(frequencies, 0.25 * frequencies[1]))  # line 0 is up to a half
    mean_power = float(np.mean(force**2))
    variance = np.maximum(density / (2.0 * size * step), RELATIVE_FLOOR**2 * mean_power)
    v_rms, x_rms = float(np.std(motion.velocity[inside])), float(np.std(x[inside]))
    return Window(
        omega=2.0 * np.pi * frequencies,
        force=project(force),
        variance=variance,
        project=project,
        frequency=v_rms / (2.0 * np.pi * x_rms) if x_rms else 0.0,
        amplitude=float(np.sqrt(2.0) * x_rms),
        speed=float(np.sqrt(2.0) * v_rms),
        rest=0.0,
        noise_power=float(2.0 * np.sum(variance[1:])),  # of the mean it is a guess
        share=float(np.sum(taper**2)) / mass,
    )


@dataclass(frozen=True)
class BandFound:
    """What the samples of a record that does not repeat tell of band and noise."""

    cutoff: float
    """Hz, the band's end."""
    displacement_noise: float
    """m, root mean square."""
    noise: NoiseSpectrum
    """Of the force."""


def find_band(record: Record, usable: slice) -> tuple[BandFound, Motion]:
    """Return band and noise of a record, and its motion; arguments as of `observe_band`."""
    step, (time, x, force) = record.step, _columns(record, usable)
    spectrum = power_density(x - x.mean(), step)
    cutoff, follows = np.inf, _cutoff(*spectrum)
    while follows < EDGE * cutoff:  # each time by a tenth at least, and never below a few lines
        cutoff = follows
        displacement_noise = _white_noise(*spectrum, cutoff)
        motion = _band_motion(record, usable, x, cutoff, displacement_noise)
        inner = _inner(_pieces(time.size, cutoff * step))
        found = band_noise(motion, x, force, step, cutoff, inner)
        follows = found.follows
    return BandFound(cutoff, displacement_noise, found.spectrum), motion


def observe_band(
    record: Record,
    usable: slice,
    kind: str,
    found: BandFound | None = None,
    motion: Motion | None = None,
) -> Observation:
    """Return the observation of a sweep, a random record, an earthquake or a trajectory.

    Parameters
    ----------
    record : Record
        With a displacement, uniformly sampled.
    usable : slice
        Samples to use.
    kind : str
        Recorded in the result.
    found : BandFound, optional
        Its band and noise; found here where not given.
    motion : Motion, optional
        In that band, where it is there from finding it.

    Returns
    -------
    Observation
        With up to sixteen windows.
    """
    step, (time, x, force) = record.step, _columns(record, usable)
    if found is None:
        found, motion = find_band(record, usable)
    cutoff, noise = found.cutoff, found.noise
    if motion is None:
        motion = _band_motion(record, usable, x, cutoff, found.displacement_noise)
    pieces = _pieces(time.size, cutoff * step)
    inner = _inner(pieces)
    mass = sum(float(np.sum(taper**2)) for _, taper in pieces)
    windows = [
        _window(piece, motion, x, force, noise, step=step, cutoff=cutoff, mass=mass)
        for piece in pieces
    ]
    fade = max(int(np.ceil(1.0 / (cutoff * step))), 1)  # over which the lines' windows open
    shown = slice(inner.start + fade, inner.stop - fade)

    def at_samples(column: Array) -> Array:
        whole = np.asarray(low_pass(column[inner], step, cutoff=cutoff))
        return whole[fade : whole.size - fade]

    return Observation(
        record=record,
        kind=kind,
        motion=motion,
        windows=tuple(windows),
        time=time[shown],
        measured=at_samples(force),
        at_samples=at_samples,
        displacement_noise=found.displacement_noise,
        force_noise=float(np.sqrt(noise.power)),
        cutoff=cutoff,
        usable=usable,
    )


def _columns(record: Record, usable: slice) -> tuple[Array, Array, Array]:
    """Return time, displacement and force at the usable samples."""
    if record.displacement is None:
        raise InputError("displacement", expected="given", where=record.file)
    return record.time[usable], record.displacement[usable], record.force[usable]


def _inner(pieces: Sequence[tuple[int, Array]]) -> slice:
    """Return the samples that windows, each a start and a taper, cover."""
    return slice(pieces[0][0], pieces[-1][0] + pieces[-1][1].size)

"""Plans: which motions a campaign runs, and how each is sampled."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from tests.calibration.structures.friction import log_uniform
from tests.calibration.structures.motion import GRID, Motion, padded, ramp, sine

Array = np.ndarray
Generator = np.random.Generator

TWISTS = ("plain", "harmonics", "even", "short", "moving")
"""What is special about a campaign: nothing; drives with 2 % of second and third harmonic; forces
with even lines; 2.3 cycles a record; sweeps and random records in place of sines."""

SHORT = 2.3
"""Cycles of a short record."""
BRIEF = 3.6
"""Cycles of a record that is stepped in time."""
HARMONIC = 0.02
"""Second and third harmonic of a drive over its amplitude."""
_STROKE = (0.002, 0.025)
_ACCELERATION = 25.0
_SAMPLING = (200.0, 250.0, 256.0, 400.0, 500.0, 512.0, 800.0, 1000.0, 1024.0, 2000.0, 5000.0)
_MOST = 14000


@dataclass(frozen=True, eq=False)
class Run:
    """One record's motion as it is driven."""

    file: str
    """Name of the record."""
    motion: Motion
    """Exact."""
    sampling: float
    """Hz."""
    frequency: float
    """Hz: of the sine, or in the middle of a sweep or a random band."""
    amplitude: float | None
    """m, of a sine test."""


def draw_plan(twist: str, count: tuple[int, int], rng: Generator) -> list[Run]:
    """Draw a campaign's records: between the two counts, over frequencies and amplitudes."""
    wanted = int(rng.integers(count[0], count[1] + 1))
    if twist == "moving":
        points = draw_points(wanted, rng, lowest=(0.3, 0.5))
        return [moving_run(f, a, i, rng) for i, (f, a) in enumerate(points)]
    points = draw_points(wanted, rng)
    return [sine_run(f, a, i, twist, rng) for i, (f, a) in enumerate(points)]


def draw_points(
    wanted: int, rng: Generator, *, lowest: tuple[float, float] = (0.1, 0.3),
    highest: float = 12.0,
) -> list[tuple[float, float]]:
    """Draw test points (Hz, m): a jittered lattice that speed and force bound, thinned."""
    low, high = log_uniform(rng, *lowest), rng.uniform(0.7, 1.0) * highest
    speed = log_uniform(rng, 0.35, 0.8)
    while True:
        rows, columns = int(rng.integers(9, 15)), int(rng.integers(4, 7))
        frequencies = np.geomspace(low, high, rows) * np.exp(0.04 * rng.standard_normal(rows))
        strokes = np.geomspace(*_STROKE, columns) * np.exp(0.08 * rng.standard_normal(columns))
        points = [
            (float(f"{f:.3g}"), float(f"{a:.3g}"))
            for f in np.clip(frequencies, 0.1, highest)
            for a in np.clip(strokes, *_STROKE)
            if allowed(float(f), float(a), speed)
        ]
        points = sorted(set(points))
        if len(points) >= wanted:
            kept = np.sort(rng.choice(len(points), size=wanted, replace=False))
            return [points[i] for i in kept]


def allowed(frequency: float, amplitude: float, speed: float) -> bool:
    """Tell whether a sine stays below the rig's speed and acceleration."""
    rate = 2.0 * math.pi * frequency
    return rate * amplitude <= speed and rate**2 * amplitude <= _ACCELERATION


def draw_line(wanted: int, rng: Generator) -> list[tuple[float, float]]:
    """Draw test points (Hz, m) at one amplitude."""
    amplitude = float(f"{log_uniform(rng, 0.002, 0.012):.3g}")
    top = min(12.0, math.sqrt(_ACCELERATION / amplitude) / (2.0 * math.pi))
    low, high = log_uniform(rng, 0.15, 0.6), rng.uniform(0.6, 0.98) * top
    spread = np.geomspace(low, high, wanted) * np.exp(0.05 * rng.standard_normal(wanted))
    return [(float(f"{f:.3g}"), amplitude) for f in spread]


def sine_run(frequency: float, amplitude: float, i: int, twist: str, rng: Generator) -> Run:
    """Return a sine test with a random phase and length."""
    cycles = {"short": SHORT, "brief": BRIEF}.get(twist, float(rng.uniform(5.0, 12.0)))
    duration = cycles / frequency
    if twist not in ("short", "brief"):
        duration = max(min(duration, 60.0), 1.5)
    least = 60.0 * frequency if duration * 60.0 * frequency > 400 else 150.0 * frequency
    rates = [r for r in _SAMPLING if r >= least and r * duration <= _MOST]
    sampling = float(rng.choice(rates[:3])) if rates else max(_SAMPLING[0], 20.0 * frequency)
    harmonics: tuple[complex, ...] = ()
    if twist == "harmonics":
        angles = rng.uniform(0.0, 2.0 * math.pi, 2)
        harmonics = tuple(HARMONIC * np.exp(1j * angles))
    time = np.arange(round(duration * sampling)) / sampling
    motion = sine(
        frequency, amplitude, time, phase=float(rng.uniform(0.0, 2.0 * math.pi)),
        harmonics=harmonics, size=GRID,
    )
    name = f"{i:02d}-{frequency:g}hz-{1e3 * amplitude:g}mm.csv"
    return Run(name, motion, sampling, frequency, amplitude)


def moving_run(frequency: float, amplitude: float, i: int, rng: Generator) -> Run:
    """Return a sweep from rest, a random record from rest or one cut from a long random motion.

    Each stays within a narrow band about its frequency, so that it belongs to one band of a device.
    """
    duration = float(np.clip(rng.uniform(9.0, 14.0) / frequency, 8.0, 30.0))
    width = rng.uniform(1.12, 1.3)
    low, high = frequency / width, frequency * width
    sampling = float(rng.choice([r for r in _SAMPLING if r >= max(40.0 * high, 100.0)][:3]))
    kind = int(rng.integers(3))
    over = 8 if sampling < 500.0 else 4
    if kind == 2:
        motion = random_cut(low, high, amplitude, duration, sampling, over, rng)
        name = f"{i:02d}-noise-{frequency:g}hz.csv"
    else:
        size = round(duration * sampling) * over
        time = np.arange(size) / (sampling * over)
        if kind == 0:
            course = sweep_course(time, low, high, amplitude)
            name = f"{i:02d}-sweep-{frequency:g}hz.csv"
        else:
            course = random_course(time, low, high, amplitude, rng)
            name = f"{i:02d}-random-{frequency:g}hz.csv"
        places = np.arange(0, size, over)
        motion = padded(course, sampling, oversampling=over, pad=6.0, places=places)
    return Run(name, motion, sampling, frequency, None)


def envelope(time: Array, low: float) -> Array:
    """Return a window that rises and falls over about two periods of the lowest frequency."""
    duration = float(time[-1])
    rise = min(2.0 / low, 0.3 * duration)
    return ramp(time / rise) * ramp((duration - time) / rise)


def sweep_course(time: Array, low: float, high: float, amplitude: float) -> Array:
    """Return a logarithmic sweep between rests (M,), m."""
    duration = float(time[-1])
    growth = math.log(high / low)
    phase = 2.0 * math.pi * low * duration / growth * np.expm1(growth * time / duration)
    return amplitude * envelope(time, low) * np.sin(phase)


def random_course(
    time: Array, low: float, high: float, amplitude: float, rng: Generator
) -> Array:
    """Return a random motion between rests (M,): sines at random frequencies of a band, m."""
    rates = 2.0 * math.pi * rng.uniform(low, high, 12)
    phases = rng.uniform(0.0, 2.0 * math.pi, 12)
    found = np.zeros(time.size)
    for rate, phase in zip(rates, phases, strict=True):
        found += np.sin(rate * time + phase)
    found *= envelope(time, low)
    return amplitude * found / float(np.max(np.abs(found)))


def random_cut(
    low: float, high: float, amplitude: float, duration: float, sampling: float, over: int,
    rng: Generator,
) -> Motion:
    """Return a record cut from a random motion that has run since ever, with a longer period."""
    samples = round(duration * sampling)
    size = round(samples * rng.uniform(1.4, 2.2)) * over
    period = size / (sampling * over)
    first, last = math.ceil(low * period), math.floor(high * period)
    lines = np.zeros(last + 1, dtype=complex)
    angles = rng.uniform(0.0, 2.0 * math.pi, last - first + 1)
    lines[first:] = np.exp(1j * angles)
    start = int(rng.integers(size // over - samples))
    places = (start + np.arange(samples)) * over
    motion = Motion(period, lines, size, places / (sampling * over), places)
    return Motion(
        period, lines * (amplitude / float(np.max(np.abs(motion.x)))), size, motion.time, places
    )




"""The motion that the actuator really makes: near the command, with distortion."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy import fft

from models.checks import Array
from models.rig.plan import TestPoint

GRID = 4096
"""Points of the fine grid over one period of a sine test."""
LEAD = 0.1
"""Time simulated before a record's first sample, s: for what lags."""
_OVERSAMPLING = 4
_PAD = 1.0


@dataclass(frozen=True)
class Drive:
    """Motion of one record: on a fine periodic grid, and at the sample times.

    A sine test's window is one period. A transient's window is the whole record from rest to rest
    with rest before it, so it's periodic too and every linear operator is a product of spectra.
    """

    point: TestPoint
    """What was commanded."""
    window: float
    """Length of the grid, s."""
    position: Array
    """(G,) displacement on the grid, m."""
    velocity: Array
    """(G,) m/s."""
    acceleration: Array
    """(G,) m/s^2."""
    time: Array
    """(M,) sample times, s; the first `lead` of them are before the record (t < 0)."""
    lead: int
    """Samples before the record begins."""
    phase: float
    """Place in the window at t = 0, s."""

    @property
    def step(self) -> float:
        """Step of the grid, s."""
        return self.window / self.position.size

    @property
    def omega(self) -> Array:
        """(G // 2 + 1,) angular frequencies of the grid's spectrum, rad/s."""
        return 2.0 * math.pi * fft.rfftfreq(self.position.size, self.step)

    @property
    def periodic(self) -> bool:
        """True for the steady state of a sine test."""
        return self.point.kind == "sine"

    @property
    def passes(self) -> int:
        """How often memory runs through the window: until steady, or once from rest."""
        return 2 if self.periodic else 1

    def sample(self, values: Array) -> Array:
        """Return the values (M,) at the sample times of a periodic function on the grid (G,)."""
        place = np.mod((self.time + self.phase) / self.step, values.size)
        left = place.astype(np.int64) % values.size
        fraction = place - np.floor(place)
        return np.asarray(
            values[left] + fraction * (values[(left + 1) % values.size] - values[left])
        )


def make_drive(point: TestPoint, rng: np.random.Generator, *, distortion: float = 0.005) -> Drive:
    """Return the motion of a test point.

    Parameters
    ----------
    point : TestPoint
        The command.
    rng : Generator
        Phases, amplitude error (0.3 % rms) and distortion are drawn from it.
    distortion : float
        Size of the second harmonic of displacement over the fundamental, about; the k-th falls as
        1/k^2 from there, as a position loop's does.
    """
    samples = round(point.duration * point.sampling)
    lead = math.ceil(LEAD * point.sampling)
    time = np.arange(-lead, samples) / point.sampling
    if point.kind == "sine":
        x, window = _sine(point, rng, distortion), 1.0 / point.frequency
        phase = rng.uniform(0.0, window)
    else:
        x, phase = _transient(point, rng)
        window = x.size / (point.sampling * _OVERSAMPLING)
    spectrum = np.asarray(fft.rfft(x))
    rate = 2j * math.pi * fft.rfftfreq(x.size, window / x.size)
    v = np.asarray(fft.irfft(spectrum * rate, n=x.size))
    a = np.asarray(fft.irfft(spectrum * rate**2, n=x.size))
    return Drive(point, window, x, v, a, time, lead, phase)


def _sine(point: TestPoint, rng: np.random.Generator, distortion: float) -> Array:
    """Return one period with harmonics 2 to 5."""
    angle = 2.0 * math.pi * np.arange(GRID) / GRID
    x = np.sin(angle)
    for k in range(2, 6):
        size = distortion * rng.uniform(0.3, 1.0) * (2.0 / k) ** 2
        x = x + size * np.sin(k * angle + rng.uniform(0.0, 2.0 * math.pi))
    return np.asarray(point.amplitude * (1.0 + 0.003 * rng.standard_normal()) * x)


def _transient(point: TestPoint, rng: np.random.Generator) -> tuple[Array, float]:
    """Return displacement on the padded grid and the place where the record starts, s."""
    rate = point.sampling * _OVERSAMPLING
    size = round(point.duration * point.sampling) * _OVERSAMPLING
    before = math.ceil(_PAD * point.sampling) * _OVERSAMPLING
    time = np.arange(size) / rate
    if point.kind == "sweep":
        shape = _sweep(point, time)
    else:
        shape = _random(point, time, rng)
    ramp = min(0.25 * point.duration, 1.0 / point.frequency)
    shape = shape * _ramp(time / ramp) * _ramp((point.duration - time) / ramp)
    shape *= point.amplitude / np.max(np.abs(shape))
    total = int(fft.next_fast_len(size + before, real=True))
    x = np.zeros(total)
    x[before : before + size] = shape
    return x, before / rate


def _sweep(point: TestPoint, time: Array) -> Array:
    """Return a logarithmic sweep; displacement falls as the root of frequency."""
    span = math.log(point.top / point.frequency)
    growth = np.exp(span * time / point.duration)
    cycles = point.frequency * point.duration / span * (growth - 1.0)
    return np.asarray(np.sin(2.0 * math.pi * cycles) / np.sqrt(growth))


def _random(point: TestPoint, time: Array, rng: np.random.Generator) -> Array:
    """Return many sines of random phase; displacement falls as the root of frequency."""
    count = max(math.floor((point.top - point.frequency) * point.duration), 1)
    frequencies = point.frequency + np.arange(count + 1) / point.duration
    phases = rng.uniform(0.0, 2.0 * math.pi, frequencies.size)
    x = np.zeros(time.size)
    for frequency, phase in zip(frequencies, phases, strict=True):
        x += np.cos(2.0 * math.pi * frequency * time + phase) / math.sqrt(frequency)
    return x


def _ramp(s: Array) -> Array:
    """Return the fifth-degree step from 0 at s = 0 to 1 at s = 1, twice differentiable."""
    inside = np.clip(s, 0.0, 1.0)
    return np.asarray(inside**3 * (10.0 - 15.0 * inside + 6.0 * inside**2))

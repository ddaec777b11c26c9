"""Motions of eight kinds of test with exact derivatives, by seed."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

Array = np.ndarray
Generator = np.random.Generator
TURN = 2.0 * np.pi


@dataclass(frozen=True)
class Drive:
    """A motion with its derivatives, each of N samples."""

    rate: float
    """Samples a second."""
    x: Array
    """m."""
    v: Array
    """m/s."""
    a: Array
    """m/s^2."""

    @property
    def time(self) -> Array:
        return np.arange(self.x.size) / self.rate

    def scaled(self, stroke: float) -> Drive:
        by = stroke / np.abs(self.x).max()
        return Drive(self.rate, by * self.x, by * self.v, by * self.a)


def _waves(time: Array, omega: Array, size: Array, rng: Generator) -> tuple[Array, Array, Array]:
    x, v, a = np.zeros((3, time.size))
    for w, s, phase in zip(omega, size, rng.uniform(0.0, TURN, omega.size), strict=True):
        sine, cosine = np.sin(w * time + phase), np.cos(w * time + phase)
        x, v, a = x + s * sine, v + s * w * cosine, a - s * w * w * sine
    return x, v, a


def sine(rate: float, rng: Generator) -> Drive:
    frequency = rng.uniform(0.2, 0.02 * rate)
    size = min(int(rng.uniform(4.0, 30.0) * rate / frequency), 60_000)
    omega = np.array([TURN * frequency])
    return Drive(rate, *_waves(np.arange(size) / rate, omega, np.ones(1), rng))


def multisine(rate: float, rng: Generator) -> Drive:
    period = int(rng.uniform(2.5, 7.0) * rate)
    orders = np.arange(2, max(int(rng.uniform(0.005, 0.02) * period), 12))
    time = np.arange(6 * period) / rate
    return Drive(rate, *_waves(time, TURN * orders * rate / period, 1.0 / orders, rng))


def sweep(rate: float, rng: Generator) -> Drive:
    """The frequency rises evenly."""
    time = _time(rate, rng)
    first, last = TURN * rng.uniform(0.2, 0.5), TURN * rng.uniform(0.01, 0.03) * rate
    speed = first + (last - first) * time / time[-1]
    phase = first * time + 0.5 * (last - first) * time**2 / time[-1]
    return _turning(rate, phase, speed, np.full(time.size, (last - first) / time[-1]))


def chirp(rate: float, rng: Generator) -> Drive:
    """The frequency grows by the same factor in every second."""
    time = _time(rate, rng)
    first, last = TURN * rng.uniform(0.2, 0.5), TURN * rng.uniform(0.01, 0.03) * rate
    growth = np.log(last / first) / time[-1]
    speed = first * np.exp(growth * time)
    return _turning(rate, (speed - first) / growth, speed, growth * speed)


def random(rate: float, rng: Generator) -> Drive:
    omega = TURN * np.sort(rng.uniform(0.2, rng.uniform(0.008, 0.03) * rate, 80))
    return Drive(rate, *_waves(_time(rate, rng), omega, 1.0 / omega, rng))


def few_lines(rate: float, rng: Generator) -> Drive:
    """Lines that are spread over the logarithm of frequency, none a multiple of another."""
    first, last = rng.uniform(0.15, 0.4), rng.uniform(0.01, 0.04) * rate
    size = int(rng.integers(25, 120))
    omega = TURN * np.exp(np.sort(rng.uniform(np.log(first), np.log(last), size)))
    return Drive(rate, *_waves(_time(rate, rng), omega, omega ** -rng.uniform(0.5, 2.0), rng))


def earthquake(rate: float, rng: Generator) -> Drive:
    """Ground with a resonance of its own, that begins and dies away."""
    time = _time(rate, rng)
    omega = TURN * np.sort(rng.uniform(0.1, min(10.0, 0.03 * rate), 150))
    ratio = omega / (TURN * rng.uniform(1.0, 3.0))
    ground = np.sqrt((1.0 + ratio**2) / ((1.0 - ratio**2) ** 2 + ratio**2))
    x, v, a = _waves(time, omega, ground / (omega**2 + (0.3 * TURN) ** 2), rng)
    late = 4.0 * time / time[-1]
    b = 4.0 / time[-1]
    fade = np.exp(2.0 - 2.0 * late)
    e = late**2 * fade  # and its derivatives
    e1 = 2.0 * b * (late - late**2) * fade
    e2 = 2.0 * b**2 * (1.0 - 4.0 * late + 2.0 * late**2) * fade
    return Drive(rate, e * x, e1 * x + e * v, e2 * x + 2.0 * e1 * v + e * a)


def trajectory(rate: float, rng: Generator) -> Drive:
    """Moves from place to place of least jerk, with rests between."""
    size = _time(rate, rng).size
    x, v, a = np.zeros((3, size))
    place, at = 0.0, 0
    while at < size:
        steps = int(rng.uniform(0.6, 2.5) * rate)
        travel, taken = rng.uniform(-1.0, 1.0) - place, steps / rate
        s = np.arange(min(steps, size - at)) / steps
        inside = slice(at, at + s.size)
        x[inside] = place + travel * (10 * s**3 - 15 * s**4 + 6 * s**5)
        v[inside] = travel * (30 * s**2 - 60 * s**3 + 30 * s**4) / taken
        a[inside] = travel * (60 * s - 180 * s**2 + 120 * s**3) / taken**2
        place, at = place + travel, at + steps
        rest = int(rng.uniform(0.1, 0.5) * rate)
        x[at : at + rest] = place
        at += rest
    return Drive(rate, x, v, a)


def _time(rate: float, rng: Generator) -> Array:
    return np.arange(int(rng.uniform(15.0, 40.0) * rate)) / rate


def _turning(rate: float, phase: Array, speed: Array, growth: Array) -> Drive:
    sine_, cosine = np.sin(phase), np.cos(phase)
    return Drive(rate, sine_, speed * cosine, growth * cosine - speed**2 * sine_)


MOTIONS: tuple[Callable[[float, Generator], Drive], ...] = (
    sine, multisine, sweep, chirp, random, earthquake, trajectory, few_lines
)  # fmt: skip

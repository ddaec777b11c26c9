"""Noise floors beside the noise that was added, over kinds of test, devices and colours."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest
from scipy.signal import lfilter

from discover.motion_fit import Observation, observe
from discover.records import Record
from discover.rows import compared_with
from tests.calibration.noise_floors.motions import MOTIONS, Drive

WITHIN = 1.3
ENOUGH = 0.95


@dataclass(frozen=True)
class Noisy:
    """A record whose noise is known."""

    record: Record
    level: float
    """N, root mean square of the noise at all frequencies."""
    memory: float
    """Of the noise from one sample to the next: 0 is white."""

    def below(self, frequency: float | None) -> float:
        """Return the noise's root mean square up to a frequency, Hz; at all for None, N."""
        if frequency is None:
            return self.level
        angle = np.linspace(0.0, 2.0 * np.pi * frequency * self.record.step, 4001)
        density = (1.0 - self.memory**2) / np.abs(1.0 - self.memory * np.exp(1j * angle)) ** 2
        return self.level * float(np.sqrt(np.trapezoid(density, angle) / np.pi))


def _force(drive: Drive, rng: np.random.Generator, *, friction: bool) -> np.ndarray:
    """Return the force of a mass with a damper, and a spring or friction by turns, N."""
    speed, force = drive.v.std(), rng.uniform(50.0, 500.0) * drive.a
    size = float(np.sqrt(np.mean(force**2)))
    force = force + rng.uniform(0.3, 1.5) * size * drive.v / speed
    force = force + rng.choice([0.0, 0.5]) * size * drive.x / drive.x.std()
    if friction:
        force = force + rng.uniform(0.2, 1.0) * size * _friction(drive, rng)
    return force


def _friction(drive: Drive, rng: np.random.Generator) -> np.ndarray:
    """Return friction of size one: over a speed, with long tails, or over a deflection."""
    law = rng.integers(3)
    if law == 0:
        return np.tanh(drive.v / (10.0 ** rng.uniform(-2.3, 0.0) * drive.v.std()))
    if law == 1:
        slow = 10.0 ** rng.uniform(-2.3, -0.3) * drive.v.std()
        return 2.0 / np.pi * np.arctan(drive.v / slow)
    deflection, state = 10.0 ** rng.uniform(-2.5, -0.3) * drive.x.std(), 0.0
    held = np.zeros(drive.x.size)
    for i, step in enumerate(np.diff(drive.x), start=1):
        state = np.sign(step) + (state - np.sign(step)) * np.exp(-abs(step) / deflection)
        held[i] = state
    return held


def noisy(number: int) -> Noisy:
    """Return a record by its number: the kinds in turn, with friction and colour or without."""
    rng = np.random.default_rng(3200 + number)
    around, kind = divmod(number, len(MOTIONS))
    drive = MOTIONS[kind](float(rng.choice([200.0, 500.0, 1000.0])), rng)
    drive = drive.scaled(10.0 ** rng.uniform(-3.0, -1.5))
    force = _force(drive, rng, friction=around % 2 == 1)
    level = 10.0 ** rng.uniform(-2.5, -1.0) * float(np.sqrt(np.mean(force**2)))
    memory = float(rng.uniform(0.5, 0.9)) if around // 2 % 2 else 0.0
    drawn = lfilter([1.0], [1.0, -memory], rng.standard_normal(force.size + 500))[500:]
    force = force + level * np.sqrt(1.0 - memory**2) * drawn
    x = drive.x + 1e-5 * drive.x.std() * rng.standard_normal(force.size)
    return Noisy(Record(f"{number}.csv", drive.time, force, x), level, memory)


def stated(observation: Observation) -> float:
    """Return the noise as every verb states it, N."""
    return float(np.sqrt(compared_with(observation, 0.0 * observation.measured).noise_power))


def ratio(number: int) -> float:
    """Return the stated noise over the known: where the motion repeats at all frequencies, else
    in the band that the record is used in.
    """
    made = noisy(number)
    seen = observe(made.record)
    repeats = seen.kind in ("sine", "periodic")
    return stated(seen) / made.below(None if repeats else seen.cutoff)


def share_within(numbers: range) -> float:
    ratios = np.array([ratio(number) for number in numbers])
    return float(np.mean((ratios < WITHIN) & (ratios > 1.0 / WITHIN)))


@pytest.mark.slow
def test_noise_floors_are_the_noise_that_was_added() -> None:
    assert share_within(range(32)) >= ENOUGH


@pytest.mark.sweep
def test_more_noise_floors() -> None:
    assert share_within(range(32, 240)) >= ENOUGH


@pytest.mark.parametrize("number", [2, 5, 6, 7])
def test_the_motions_are_their_own_derivatives(number: int) -> None:
    drive = MOTIONS[number](1000.0, np.random.default_rng(number))
    for value, rate in ((drive.x, drive.v), (drive.v, drive.a)):
        found = np.gradient(value) * drive.rate
        assert np.max(np.abs(found - rate)[5:-5]) < 0.02 * np.abs(rate).max()

"""Effects that the catalogue has no name for, of other kinds."""

from __future__ import annotations

import math

import numpy as np
from numba import njit
from numpy.typing import NDArray
from scipy import fft

from models.checks import Array
from models.rig.bench import Bench, Scales
from models.rig.effects.effect import Effect, Values

Generator = np.random.Generator


def _cogging(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    # Teeth or magnets along the stroke: periodic in displacement.
    angle = 2.0 * math.pi * bench.x / values["pitch"] + values["phase"]
    return np.asarray(amount * (np.sin(angle) - math.sin(values["phase"])))


def _draw_cogging(rng: Generator, scales: Scales) -> dict[str, float]:
    return {
        "pitch": scales.displacement * rng.uniform(0.12, 0.3),
        "phase": rng.uniform(-1.0, 1.0),
    }


def _squeal(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    # A loose part that rings each time the motion turns.
    drive = bench.drive
    state = _ring(drive.velocity, drive.step, values["frequency"], values["decay"], 2)
    return drive.sample(np.asarray(amount * state))


@njit(cache=True)
def _ring(v: Array, step: float, frequency: float, decay: float, passes: int) -> Array:
    result = np.zeros(v.size)
    since, way = 1e3, 1.0
    for _ in range(passes):
        for i in range(v.size):
            since += step
            if v[i] * v[i - 1] < 0.0:
                since, way = 0.0, 1.0 if v[i] > 0.0 else -1.0
            turns = 2.0 * math.pi * frequency * since
            result[i] = way * math.sin(turns) * math.exp(-decay * since)
    return result


def _draw_squeal(rng: Generator, scales: Scales) -> dict[str, float]:
    frequency = max(2.5 * scales.high_frequency, 16.0) * rng.uniform(0.9, 1.1)
    return {"frequency": frequency, "decay": frequency * rng.uniform(0.3, 0.8)}


def _branch(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    # A mass on a spring that is dragged along and resonates within the tests.
    ratio = bench.drive.omega / values["omega"]
    response: NDArray[np.complex128] = ratio**2 / (1.0 - ratio**2 + 2j * values["loss"] * ratio)
    spectrum = np.asarray(fft.rfft(bench.drive.position)) * response
    return bench.drive.sample(amount * np.asarray(fft.irfft(spectrum, bench.drive.position.size)))


def _draw_branch(rng: Generator, scales: Scales) -> dict[str, float]:
    middle = math.sqrt(scales.low_frequency * scales.high_frequency)
    return {
        "omega": 2.0 * math.pi * middle * rng.uniform(1.0, 2.0),
        "loss": rng.uniform(0.05, 0.15),
    }


def _pressed_film(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    # Oil in a loaded contact thickens with the load.
    return np.asarray(amount * bench.v * np.expm1(values["rise"] * np.abs(force) / values["force"]))


def _draw_film(rng: Generator, scales: Scales) -> dict[str, float]:
    return {"rise": rng.uniform(1.0, 2.5), "force": scales.force}


def _clutch(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    # A flywheel on an overrunning clutch: felt only while it is being sped up.
    power = bench.a * bench.v / (values["speed"] * values["acceleration"])
    return np.asarray(amount * bench.a * 0.5 * (1.0 + np.tanh(power / values["width"])))


def _draw_clutch(rng: Generator, scales: Scales) -> dict[str, float]:
    return {
        "speed": scales.speed,
        "acceleration": scales.acceleration,
        "width": 10.0 ** rng.uniform(-4.0, -3.0),
    }


def _switching(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    # Flow that trips to a rough state at one speed and calms only at a lower one.
    drive = bench.drive
    on = _trip(np.abs(drive.velocity), values["upper"], values["lower"], 2)
    return drive.sample(np.asarray(amount * drive.velocity * on))


@njit(cache=True)
def _trip(speed: Array, upper: float, lower: float, passes: int) -> Array:
    result = np.zeros(speed.size)
    state = 0.0
    for _ in range(passes):
        for i in range(speed.size):
            if speed[i] > upper:
                state = 1.0
            elif speed[i] < lower:
                state = 0.0
            result[i] = state
    return result


def _draw_switching(rng: Generator, scales: Scales) -> dict[str, float]:
    upper = scales.speed * rng.uniform(0.35, 0.6)
    return {"upper": upper, "lower": upper * rng.uniform(0.15, 0.35)}


EFFECTS = (
    Effect("outside:cogging", "teeth", "periodic in displacement", _cogging, _draw_cogging),
    Effect("outside:squeal", "ring", "rings after each reversal", _squeal, _draw_squeal),
    Effect("outside:branch", "tuned", "resonates within the tests", _branch, _draw_branch),
    Effect("outside:pressed-film", "thickening", "thickens with load", _pressed_film, _draw_film),
    Effect("outside:clutch", "overrunning", "mass only when sped up", _clutch, _draw_clutch),
    Effect("outside:switching", "trip", "drag that trips and calms", _switching, _draw_switching),
)
"""Effects of this file."""

"""Effects that the catalogue has no name for, of further kinds."""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from models.checks import Array
from models.rig.bench import Bench, Scales
from models.rig.effects.effect import Effect, Values
from tests.calibration.gap.third_set.turns import way_since_turn

Generator = np.random.Generator


def _shedding(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    # Vortices that leave an edge once in a length of travel, anew after each turn.
    drive = bench.drive
    gone = way_since_turn(drive.position, drive.passes)
    tone = np.sin(2.0 * math.pi * gone / values["pitch"])
    return drive.sample(np.asarray(amount * (drive.velocity / values["speed"]) ** 2 * tone))


def _developing(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    # Flow that is still forming after each turn: more drag over the first of the way.
    drive = bench.drive
    young = np.exp(-((way_since_turn(drive.position, drive.passes) / values["pitch"]) ** 2))
    return drive.sample(np.asarray(amount * drive.velocity * young))


def _gate(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    # A port that the piston covers near one place of its stroke.
    s = (bench.x / values["stroke"] - values["centre"]) / values["width"]
    return np.asarray(amount * bench.v / np.cosh(s))


def _meshing(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    # A wheel that is out of true: the mass behind it is driven by its error.
    wave = 2.0 * math.pi / values["turn"]
    angle = wave * bench.x + values["phase"]
    return np.asarray(
        amount * (np.cos(angle) * bench.a - wave * np.sin(angle) * bench.v**2)
    )


def _gel(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    # Grease that breaks down as it is sheared and builds up again with time.
    drive = bench.drive
    whole = _structure(
        np.abs(drive.velocity), drive.step, values["way"], values["rest"], 30 * drive.passes
    )
    return drive.sample(np.asarray(amount * whole * np.tanh(drive.velocity / values["slow"])))


@njit(cache=True)
def _structure(speed: Array, step: float, way: float, rest: float, passes: int) -> Array:
    result = np.zeros(speed.size)
    state = 1.0
    for _ in range(passes):
        for i in range(speed.size):
            rate = 1.0 / rest + speed[i] / way
            even = 1.0 / rest / rate
            state = even + (state - even) * np.exp(-rate * step)
            result[i] = state
    return result


def _rattle(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    # A loose weight in its cage: thrown from side to side, with padded walls.
    drive = bench.drive
    passes = 12 if drive.periodic else 1
    pull = _cage(
        drive.position, drive.step, values["gap"], 2.0 * math.pi * values["wall"], passes
    )
    return drive.sample(np.asarray(amount * pull))


@njit(cache=True)
def _cage(x: Array, step: float, gap: float, rate: float, passes: int) -> Array:
    """Return the force on the cage per loose mass, m/s^2."""
    result = np.zeros(x.size)
    place, speed = x[0], 0.0
    parts = int(math.ceil(rate * step / 0.1)) + 1
    small = step / parts
    for _ in range(passes):
        for i in range(x.size):
            before = x[i - 1]
            drive = (x[i] - before) / step
            total = 0.0
            for j in range(parts):
                lead = before + drive * small * (j + 1) - place
                pull = 0.0
                if abs(lead) > 0.5 * gap:
                    side = 1.0 if lead > 0.0 else -1.0
                    deep = abs(lead) - 0.5 * gap
                    pull = side * max(
                        rate**2 * deep + 0.6 * rate * side * (drive - speed), 0.0
                    )
                speed += small * pull
                place += small * speed
                total += pull
            result[i] = total / parts
    return result


def _draw_place(rng: Generator, scales: Scales) -> dict[str, float]:
    return {
        "pitch": scales.displacement * rng.uniform(0.1, 0.35),
        "speed": scales.speed,
        "stroke": scales.displacement,
        "centre": rng.uniform(-0.3, 0.3),
        "width": rng.uniform(0.1, 0.3),
        "turn": scales.displacement * rng.uniform(0.5, 1.2),
        "phase": rng.uniform(0.0, 2.0 * math.pi),
    }


def _draw_time(rng: Generator, scales: Scales) -> dict[str, float]:
    return {
        "way": scales.displacement * rng.uniform(0.02, 0.1),
        "rest": rng.uniform(0.05, 0.3) / scales.low_frequency,
        "slow": scales.speed * rng.uniform(0.002, 0.01),
        "gap": scales.displacement * rng.uniform(0.05, 0.3),
        "wall": rng.uniform(20.0, 35.0),
    }


EFFECTS = (
    Effect("outside:shedding", "edge", "vortices off an edge", _shedding, _draw_place),
    Effect("outside:forming", "young", "flow that is still forming", _developing, _draw_place),
    Effect("outside:gate", "port", "a port covered at one place", _gate, _draw_place),
    Effect("outside:runout", "wheel", "a wheel out of true", _meshing, _draw_place),
    Effect("outside:gel", "grease", "grease that breaks down", _gel, _draw_time),
    Effect("outside:rattle", "cage", "a loose weight", _rattle, _draw_time),
)
"""Effects of this file."""

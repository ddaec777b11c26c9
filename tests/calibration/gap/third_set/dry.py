"""Dry friction and hysteresis by further laws."""

from __future__ import annotations

import numpy as np
from numba import njit

from models.checks import Array
from models.rig.bench import Bench, Scales
from models.rig.effects.effect import Effect, Values, seal_direction

Generator = np.random.Generator


def _felt(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    # A felt wiper: its fibres let go one after the other.
    ratio = np.abs(bench.v) / values["reversal"]
    return np.asarray(amount * np.sign(bench.v) * (1.0 - 1.0 / (1.0 + ratio) ** 2))


def _rollers(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    # Rolling guides turn over along a rounded curve of the way since the last turn.
    drive = bench.drive
    return drive.sample(
        np.asarray(amount * _masing(drive.position / values["presliding"], 1, drive.passes))
    )


@njit(cache=True)
def _masing(x: Array, kind: int, passes: int) -> Array:
    """Return a force that follows its first curve, doubled, from each turn."""
    result = np.zeros(x.size)
    turned, level, way = x[0], 0.0, 0.0
    for _ in range(2 * passes):
        for i in range(x.size):
            step = x[i] - x[i - 1]
            if step * way < 0.0:
                turned, level = x[i - 1], result[i - 1]
            if step != 0.0:
                way = 1.0 if step > 0.0 else -1.0
            s = abs(x[i] - turned)
            if kind == 1:
                rise = s**1.5 / (1.0 + s**1.5)
                result[i] = level + (way - level) * rise
            else:
                result[i] = level + way * 2.0 * np.log1p(0.5 * s)
    return result


def _draw_dry(rng: Generator, scales: Scales) -> dict[str, float]:
    return {
        "reversal": scales.speed * 10.0 ** rng.uniform(-3.6, -2.9),
        "presliding": scales.displacement * rng.uniform(0.0008, 0.004),
    }


def _dwell(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    # Contacts that strengthen with their age (Dieterich, Ruina): ln(1 + theta v0/L).
    drive = bench.drive
    age = _aged(np.abs(drive.velocity), drive.step, values["way"], 3 * drive.passes)
    fresh = drive.sample(np.log1p(age * values["stribeck_speed"] / values["way"]))
    return np.asarray(amount * fresh * seal_direction(bench, values))


@njit(cache=True)
def _aged(speed: Array, step: float, way: float, passes: int) -> Array:
    result = np.zeros(speed.size)
    age = 0.0
    for _ in range(passes):
        for i in range(speed.size):
            rate = speed[i] / way
            gone = rate * step
            keep = np.exp(-gone)
            age = age * keep + (step if gone < 1e-9 else (1.0 - keep) / rate)
            result[i] = age
    return result


def _lifting(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    # A film that lifts the lip off: friction ends at a speed.
    left = np.maximum(1.0 - np.abs(bench.v) / (2.0 * values["stribeck_speed"]), 0.0)
    return np.asarray(amount * left**1.5 * seal_direction(bench, values))


def _draw_stribeck(rng: Generator, scales: Scales) -> dict[str, float]:
    return _draw_dry(rng, scales) | {
        "stribeck_speed": scales.speed * 10.0 ** rng.uniform(-1.3, -0.7),
        "way": scales.displacement * rng.uniform(0.0003, 0.0015),
    }


def _weld(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    # A weld that has drawn the tube in at one place.
    s = (bench.x / values["stroke"] - values["centre"]) / values["width"]
    return np.asarray(amount / np.cosh(s) ** 2 * seal_direction(bench, values))


def _ends(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    # A tube that is honed in its middle only: tight toward both ends.
    s = (bench.x / values["stroke"]) ** 4
    return np.asarray(amount * s / (values["width"] + s) * seal_direction(bench, values))


def _draw_bore(rng: Generator, scales: Scales) -> dict[str, float]:
    return _draw_dry(rng, scales) | {
        "stroke": scales.displacement,
        "centre": rng.uniform(-0.35, 0.35),
        "width": rng.uniform(0.15, 0.35),
    }


def _segalman(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    # Joints after Segalman (2005): sliders by a power of their limit, most of them weak.
    drive = bench.drive
    limits = np.linspace(0.04, 1.0, 25)
    weights = limits ** (1.0 + values["chi"])
    weights /= weights.sum()
    state = _sliders(drive.position / values["yield"], limits, weights, drive.passes)
    return drive.sample(np.asarray(amount * state))


@njit(cache=True)
def _sliders(x: Array, limits: Array, weights: Array, passes: int) -> Array:
    result = np.zeros(x.size)
    z = np.zeros(limits.size)
    for _ in range(passes):
        for i in range(x.size):
            step = x[i] - x[i - 1]
            total = 0.0
            for j in range(limits.size):
                z[j] = min(max(z[j] + step, -limits[j]), limits[j])
                total += weights[j] * z[j] / limits[j]
            result[i] = total
    return result


def _winding(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    # A wound cable: its strands keep giving way, logarithmically, never wholly.
    drive = bench.drive
    state = _masing(drive.position / values["yield"], 2, drive.passes)
    return drive.sample(np.asarray(amount * (state - 0.5 * (state.max() + state.min()))))


def _draw_yield(rng: Generator, scales: Scales) -> dict[str, float]:
    return {
        "yield": scales.displacement * rng.uniform(0.04, 0.15),
        "chi": rng.uniform(-0.8, -0.3),
    }


EFFECTS = (
    Effect("coulomb-friction", "felt", "a felt wiper", _felt, _draw_dry, unit="N"),
    Effect("coulomb-friction", "rollers", "rolling guides", _rollers, _draw_dry, unit="N"),
    Effect("stribeck-friction", "dwell", "contacts that age", _dwell, _draw_stribeck,
           unit="N", at_seals=True),
    Effect("stribeck-friction", "lifting", "a lip that lifts off", _lifting, _draw_stribeck,
           unit="N", at_seals=True),
    Effect("position-dependent-friction", "weld", "drawn in at a weld", _weld, _draw_bore,
           unit="N", at_seals=True),
    Effect("position-dependent-friction", "ends", "honed in its middle", _ends, _draw_bore,
           unit="N", at_seals=True),
    Effect("hysteresis", "segalman", "a bolted joint", _segalman, _draw_yield, unit="N"),
    Effect("hysteresis", "winding", "a wound cable", _winding, _draw_yield, unit="N"),
)
"""Effects of this file."""

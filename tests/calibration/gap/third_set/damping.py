"""Fluid damping by further laws of films, bends, valves and weather."""

from __future__ import annotations

import numpy as np

from models.checks import Array
from models.rig.bench import Bench, Scales
from models.rig.effects.effect import Effect, Values
from tests.calibration.gap.third_set.turns import way_since_turn

Generator = np.random.Generator


def _journal(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    # A bearing's film that heats and thins a little as it is sheared faster.
    ratio = (bench.v / values["speed"]) ** 2
    return np.asarray(amount * bench.v / (1.0 + values["thin"] * ratio / (1.0 + ratio)))


def _draw_journal(rng: Generator, scales: Scales) -> dict[str, float]:
    return {"speed": scales.speed * rng.uniform(0.2, 0.6), "thin": rng.uniform(0.04, 0.12)}


def _leaves(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    # Leaves before a port that the jet bends open: less than quadratic at high flow.
    ratio = bench.v / values["speed"]
    return np.asarray(amount * bench.v * np.abs(bench.v) / (1.0 + ratio**2) ** values["carry"])


def _elbow(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    # A bend whose inner wall separates above a speed: its loss rises there.
    speed = np.abs(bench.v)
    torn = speed**3 / (speed**3 + values["speed"] ** 3)
    return np.asarray(amount * bench.v * speed * (1.0 + values["tilt"] * torn))


def _draw_quadratic(rng: Generator, scales: Scales) -> dict[str, float]:
    return {
        "speed": scales.speed * rng.uniform(0.25, 0.6),
        "carry": rng.uniform(0.12, 0.25),
        "tilt": rng.uniform(0.2, 0.5),
    }


def _dispersion(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    # A thinning dispersion with its solvent's own viscosity (Sisko), rounded at rest.
    ratio = np.hypot(bench.v / values["speed"], 0.2)
    viscosity = ratio ** (values["index"] - 1.0) + values["solvent"]
    return np.asarray(amount * bench.v / values["speed"] * viscosity)


def _grains(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    # A bed of grains between creeping and jets: the exponent grows from 1.4.
    ratio = np.abs(bench.v) / values["speed"]
    return np.asarray(amount * np.sign(bench.v) * ratio**1.4 * (1.0 + ratio) ** values["creep"])


def _draw_power(rng: Generator, scales: Scales) -> dict[str, float]:
    return {
        "speed": scales.speed * rng.uniform(0.003, 0.012),
        "index": rng.uniform(0.3, 0.6),
        "solvent": rng.uniform(0.01, 0.04),
        "creep": rng.uniform(0.03, 0.1),
    }


def _bleed(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    # A bleed that a flap shuts on one side: a power of speed between film and jet.
    pushed = np.maximum(values["side"] * bench.v, 0.0) / values["speed"]
    return np.asarray(values["side"] * amount * pushed ** values["power"])


def _late(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    # A plate valve that seats only once some oil has gone back through it.
    drive = bench.drive
    gone = way_since_turn(drive.position, drive.passes)
    shut = -np.expm1(-gone / values["way"]) * (values["side"] * drive.velocity > 0.0)
    return bench.drive.sample(np.asarray(amount * drive.velocity * shut))


def _draw_side(rng: Generator, scales: Scales) -> dict[str, float]:
    return {
        "side": float(rng.choice([-1.0, 1.0])),
        "speed": scales.speed,
        "power": rng.uniform(1.15, 1.7),
        "way": scales.displacement * rng.uniform(0.01, 0.05),
    }


def _sunny(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    # A bench in the sun: each record of the day meets warmer, thinner oil.
    return np.asarray(amount * bench.v * np.exp(-values["rate"] * bench.index))


def _stirred(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    # Layers of cold oil that are mixed away by the way that the piston goes.
    step = bench.t[1] - bench.t[0]
    way = np.cumsum(np.where(bench.t >= 0.0, np.abs(bench.v), 0.0)) * step
    return np.asarray(amount * bench.v / (1.0 + (way / values["mixed"]) ** 2))


def _draw_weather(rng: Generator, scales: Scales) -> dict[str, float]:
    return {
        "rate": rng.uniform(0.1, 0.3),
        "mixed": scales.displacement * rng.uniform(4.0, 15.0),
    }


EFFECTS = (
    Effect("viscous-damping", "journal", "a bearing's film", _journal, _draw_journal),
    Effect("quadratic-damping", "leaves", "leaves before a port", _leaves, _draw_quadratic),
    Effect("quadratic-damping", "elbow", "a bend", _elbow, _draw_quadratic),
    Effect("power-law-damping", "dispersion", "a dispersion", _dispersion, _draw_power),
    Effect("power-law-damping", "grains", "a bed of grains", _grains, _draw_power),
    Effect("asymmetric-damping", "bleed", "a bleed with a flap", _bleed, _draw_side),
    Effect("asymmetric-damping", "late", "a valve that seats late", _late, _draw_side),
    Effect("thermal-drift", "sunny", "warmer by the record", _sunny, _draw_weather),
    Effect("thermal-drift", "stirred", "cold layers mixed away", _stirred, _draw_weather),
)
"""Effects of this file."""

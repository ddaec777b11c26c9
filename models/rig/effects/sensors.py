"""Faults of the measuring chain."""

from __future__ import annotations

import numpy as np
from scipy.interpolate import CubicSpline

from models.checks import Array
from models.rig.bench import Bench, Scales
from models.rig.effects.effect import Effect, Values

Generator = np.random.Generator


def _offset(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    return np.full(force.shape, amount * values["sign"])


def _draw_sign(rng: Generator, scales: Scales) -> dict[str, float]:
    return {"sign": float(rng.choice([-1.0, 1.0]))}


def _delay(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    return np.asarray(CubicSpline(bench.t, force)(bench.t - amount) - force)


def _start_delay(scales: Scales) -> float:
    return 0.01 / scales.high_frequency


def _gain(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    return np.asarray(amount * values["sign"] * force)


def _range_gain(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    # The amplifier's upper range, switched in for the large records, is out of calibration.
    large = float(np.max(np.abs(force))) > values["threshold"]
    return np.asarray(amount * values["sign"] * (1.0 if large else 0.0) * force)


def _draw_range(rng: Generator, scales: Scales) -> dict[str, float]:
    return _draw_sign(rng, scales) | {"threshold": scales.force * rng.uniform(0.05, 0.2)}


def _elapsed(bench: Bench) -> Array:
    return np.maximum(bench.t, 0.0)


def _warm_up(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    return np.asarray(amount * values["sign"] * -np.expm1(-_elapsed(bench) / values["time"]))


def _creep(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    return np.asarray(amount * values["sign"] * np.log1p(_elapsed(bench) / values["time"]))


def _draw_drift(rng: Generator, scales: Scales) -> dict[str, float]:
    return _draw_sign(rng, scales) | {"time": scales.duration * rng.uniform(0.3, 1.0)}


def _start_rail(scales: Scales) -> float:
    return 1.3 / scales.force


def _soft_rail(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    # An amplifier that runs into its supply: rounded, from force/limit = 0.8 or so.
    n = values["sharpness"]
    level = n * np.log(np.maximum(np.abs(force) * amount, 1e-30))
    return np.asarray(force * np.expm1(-np.logaddexp(0.0, level) / n))


def _draw_soft_rail(rng: Generator, scales: Scales) -> dict[str, float]:
    return {"sharpness": rng.uniform(12.0, 25.0)}


def _uneven_rails(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    # A converter whose rails lie unevenly and that comes free of them with a few samples' lag.
    upper, lower = 1.0 / amount, values["ratio"] / amount
    clipped = np.clip(force, -lower, upper)
    stuck = (force >= upper) | (force <= -lower)
    just = np.zeros(stuck.shape, dtype=bool)
    for lag in (1, 2):
        just[lag:] |= stuck[:-lag] & ~stuck[lag:]
    held = np.where(clipped >= 0.0, upper, -lower)
    return np.asarray(np.where(just, 0.5 * (clipped + held), clipped) - force)


def _draw_rails(rng: Generator, scales: Scales) -> dict[str, float]:
    return {"ratio": rng.uniform(0.9, 1.1)}


EFFECTS = (
    Effect("force-offset", "zero", "a load cell that isn't zeroed", _offset, _draw_sign, unit="N"),
    Effect(
        "time-delay",
        "skew",
        "force sampled later than displacement: F(t - tau)",
        _delay,
        linear=False,
        acts="output",
        start=_start_delay,
        unit="s",
    ),
    Effect(
        "sensor-gain",
        "calibration",
        "a load cell out of calibration in all records",
        _gain,
        _draw_sign,
        acts="output",
        unit="1",
    ),
    Effect(
        "sensor-gain",
        "range",
        "the amplifier's upper range, used for the large records, out of calibration",
        _range_gain,
        _draw_range,
        acts="output",
        unit="1",
    ),
    Effect(
        "sensor-drift",
        "warm-up",
        "a zero that warms up within each record: 1 - exp(-t/T)",
        _warm_up,
        _draw_drift,
        acts="output",
        unit="N",
    ),
    Effect(
        "sensor-drift",
        "creep",
        "a zero that creeps within each record: ln(1 + t/T)",
        _creep,
        _draw_drift,
        acts="output",
        unit="N",
    ),
    Effect(
        "sensor-clipping",
        "amplifier",
        "an amplifier that rounds off into its supply: F/(1 + |F/L|^n)^(1/n), n = 12 to 25",
        _soft_rail,
        _draw_soft_rail,
        linear=False,
        acts="output",
        start=_start_rail,
        unit="1/N",
    ),
    Effect(
        "sensor-clipping",
        "rails",
        "a converter with uneven rails that it leaves with a lag",
        _uneven_rails,
        _draw_rails,
        linear=False,
        acts="output",
        start=_start_rail,
        unit="1/N",
    ),
)
"""Effects of this file."""

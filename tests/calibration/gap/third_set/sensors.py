"""Faults of the measuring chain of further kinds."""

from __future__ import annotations

import numpy as np
from scipy.interpolate import CubicSpline

from models.checks import Array
from models.rig.bench import Bench, Scales
from models.rig.effects.effect import Effect, Values

Generator = np.random.Generator


def _rezeroed(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    # Zeroed anew before each record, always a little to the same side.
    own = 1.0 + values["scatter"] * np.sin(values["turn"] * (bench.index + 1.0))
    return np.full(force.shape, amount * values["sign"] * own)


def _averaged(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    # A converter that reports the mean over a window that ends with the sample.
    whole = CubicSpline(bench.t, force).antiderivative()
    return np.asarray((whole(bench.t) - whole(bench.t - amount)) / amount - force)


def _start_window(scales: Scales) -> float:
    return 0.02 / scales.high_frequency


def _ageing(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    # A bridge whose supply runs down over the session.
    return np.asarray(amount * values["sign"] * (values["early"] + bench.index) * force)


def _two_amplifiers(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    # Two amplifiers in turns, one of them off.
    other = 1.0 if (bench.index + int(values["first"])) % 2 else 0.0
    return np.asarray(amount * values["sign"] * other * force)


def _draw_gain(rng: Generator, scales: Scales) -> dict[str, float]:
    return {
        "sign": float(rng.choice([-1.0, 1.0])),
        "early": rng.uniform(2.0, 8.0),
        "first": float(rng.integers(2)),
        "scatter": rng.uniform(0.1, 0.3),
        "turn": rng.uniform(1.0, 5.0),
    }


def _battery(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    # A battery that falls slowly, then faster.
    t = np.maximum(bench.t, 0.0) / values["time"]
    return np.asarray(amount * values["sign"] * t * (1.0 + 0.5 * t))


def _slipping(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    # A clamp that settles once in each record, within some of its length.
    t = np.maximum(bench.t, 0.0) / values["time"]
    step = np.tanh((t - values["when"]) / 0.1) + np.tanh(values["when"] / 0.1)
    return np.asarray(amount * values["sign"] * step)


def _draw_drift(rng: Generator, scales: Scales) -> dict[str, float]:
    return {
        "sign": float(rng.choice([-1.0, 1.0])),
        "time": scales.duration * rng.uniform(0.6, 1.0),
        "when": rng.uniform(0.15, 0.4),
    }


def _compressor(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    # An amplifier that leaves a tenth or so of what is above its limit, in a rounded knee.
    over = np.abs(force) * amount - 1.0
    taken = np.logaddexp(0.0, values["sharp"] * over) / values["sharp"]
    return np.asarray(-values["taken"] * np.sign(force) * taken / amount)


def _drooping(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    # A supply that sags at one rail: the limit lies lower on that side.
    limit = np.where(values["side"] * force > 0.0, 1.0, values["ratio"]) / amount
    return np.asarray(-np.sign(force) * np.maximum(np.abs(force) - limit, 0.0))


def _draw_limit(rng: Generator, scales: Scales) -> dict[str, float]:
    return {
        "sharp": rng.uniform(8.0, 16.0),
        "taken": rng.uniform(0.8, 0.95),
        "side": float(rng.choice([-1.0, 1.0])),
        "ratio": rng.uniform(1.1, 1.3),
    }


def _start_limit(scales: Scales) -> float:
    return 1.3 / scales.force


EFFECTS = (
    Effect("force-offset", "rezeroed", "zeroed to one side", _rezeroed, _draw_gain, unit="N"),
    Effect("time-delay", "averaged", "a mean over a window", _averaged,
           linear=False, acts="output", start=_start_window, unit="s"),
    Effect("sensor-gain", "ageing", "a supply that runs down", _ageing, _draw_gain,
           acts="output", unit="1"),
    Effect("sensor-gain", "two-amplifiers", "one of two is off", _two_amplifiers, _draw_gain,
           acts="output", unit="1"),
    Effect("sensor-drift", "battery", "a battery that falls", _battery, _draw_drift,
           acts="output", unit="N"),
    Effect("sensor-drift", "slipping", "a clamp that settles", _slipping, _draw_drift,
           acts="output", unit="N"),
    Effect("sensor-clipping", "compressor", "a rounded knee", _compressor, _draw_limit,
           linear=False, acts="output", start=_start_limit, unit="1/N"),
    Effect("sensor-clipping", "drooping", "a rail that sags", _drooping, _draw_limit,
           linear=False, acts="output", start=_start_limit, unit="1/N"),
)
"""Effects of this file."""

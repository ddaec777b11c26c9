"""Faults of the measuring chain of other kinds."""

from __future__ import annotations

import math

import numpy as np
from scipy.interpolate import CubicSpline

from models.checks import Array
from models.rig.bench import Bench, Scales
from models.rig.effects.effect import Effect, Values

Generator = np.random.Generator


def _session(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    # The bridge was set up anew after some of the records.
    later = 1.0 if bench.index >= values["first"] else 0.0
    return np.asarray(amount * values["sign"] * later * force)


def _draw_session(rng: Generator, scales: Scales) -> dict[str, float]:
    return {"first": float(rng.integers(3, 7)), "sign": float(rng.choice([-1.0, 1.0]))}


def _sagging(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    # A load cell whose gain is out, in a chain slow enough to show it late.
    slow = CubicSpline(bench.t, force)(bench.t - values["lag"])
    return np.asarray(amount * values["sign"] * slow)


def _draw_sagging(rng: Generator, scales: Scales) -> dict[str, float]:
    return {
        "lag": rng.uniform(0.004, 0.008) / scales.high_frequency,
        "sign": float(rng.choice([-1.0, 1.0])),
    }


def _diffusion(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    # Heat that reaches the gauges by conduction: with the root of time, then levelling.
    t = np.maximum(bench.t, 0.0) / values["time"]
    return np.asarray(amount * values["sign"] * np.sqrt(t / (1.0 + 0.5 * t)))


def _room(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    # A room whose temperature swings slowly: part of a period in the longest record.
    angle = 2.0 * math.pi * np.maximum(bench.t, 0.0) / values["time"]
    start = values["phase"]
    return np.asarray(amount * (np.sin(0.35 * angle + start) - math.sin(start)))


def _draw_drift(rng: Generator, scales: Scales) -> dict[str, float]:
    return {
        "time": scales.duration * rng.uniform(0.5, 1.5),
        "sign": float(rng.choice([-1.0, 1.0])),
        "phase": rng.uniform(-0.8, 0.8) + math.pi * float(rng.integers(2)),
    }


def _one_rail(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    limit = values["side"] / amount
    side = values["side"]
    return np.asarray(-side * np.maximum(side * force - side * limit, 0.0))


def _mechanical_stop(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    # The cell's overload stop takes most of what is above its limit.
    over = np.maximum(np.abs(force) - 1.0 / amount, 0.0)
    return np.asarray(-values["taken"] * np.sign(force) * over)


def _draw_limit(rng: Generator, scales: Scales) -> dict[str, float]:
    return {"side": float(rng.choice([-1.0, 1.0])), "taken": rng.uniform(0.85, 0.97)}


def _start_limit(scales: Scales) -> float:
    return 1.3 / scales.force


EFFECTS = (
    Effect("sensor-gain", "session", "set up anew", _session, _draw_session,
           acts="output", unit="1"),
    Effect("sensor-gain", "sagging", "gain with lag", _sagging, _draw_sagging,
           acts="output", unit="1"),
    Effect("sensor-drift", "diffusion", "root of time", _diffusion, _draw_drift,
           acts="output", unit="N"),
    Effect("sensor-drift", "room", "a slow swing", _room, _draw_drift, acts="output", unit="N"),
    Effect("sensor-clipping", "one-rail", "one side only", _one_rail, _draw_limit,
           linear=False, acts="output", start=_start_limit, unit="1/N"),
    Effect("sensor-clipping", "overload-stop", "a stop takes the rest", _mechanical_stop,
           _draw_limit, linear=False, acts="output", start=_start_limit, unit="1/N"),
)
"""Effects of this file."""

"""Fluid damping by other laws of orifices, valves, films and warming."""

from __future__ import annotations

import math

import numpy as np
from scipy import signal

from models.checks import Array
from models.rig.bench import Bench, Scales
from models.rig.effects.effect import Effect, Values

Generator = np.random.Generator


def _spool(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    # Wu, Burton and Schoenau, Mech. Mach. Theory 37 (2002): the discharge coefficient rises from
    # zero with the root of Reynolds number and overshoots its end value a little.
    root = np.sqrt(np.abs(bench.v) / values["speed"]) + 1e-9
    discharge = 1.0 + values["over"] * np.exp(-0.3 * root)
    discharge = discharge - (1.0 + values["over"]) * np.exp(-1.5 * root)
    return np.asarray(amount * bench.v * np.abs(bench.v) / discharge**2)


def _gauze(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    # Wire gauze: its loss coefficient falls as Re^(-1/3) to a constant (Idelchik).
    speed = np.hypot(bench.v, 1e-3 * values["speed"])
    loss = 1.0 + values["share"] * (values["speed"] / speed) ** (1.0 / 3.0)
    return np.asarray(amount * bench.v * speed * loss)


def _draw_quadratic(rng: Generator, scales: Scales) -> dict[str, float]:
    return {
        "speed": scales.speed * 10.0 ** rng.uniform(-2.2, -1.5),
        "over": rng.uniform(0.1, 0.25),
        "share": rng.uniform(0.7, 1.2),
    }


def _ellis(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    # Ellis' law gives the rate as a function of stress: r = s (1 + s^(alpha - 1)).
    alpha = 1.0 / values["index"]
    stress = np.concatenate([[0.0], np.geomspace(1e-7, 1e4, 4000)])
    rate = stress * (1.0 + stress ** (alpha - 1.0))
    ratio = np.abs(bench.v) / values["speed"]
    return np.asarray(amount * np.sign(bench.v) * np.interp(ratio, rate, stress))


def _draw_ellis(rng: Generator, scales: Scales) -> dict[str, float]:
    return {"speed": scales.speed * rng.uniform(0.003, 0.015), "index": rng.uniform(0.35, 0.7)}


def _smooth_pipe(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    # Laminar below a speed, Blasius' 1.75 above, blended after Churchill.
    ratio = np.abs(bench.v) / values["speed"]
    return np.asarray(amount * np.sign(bench.v) * (ratio**12 + ratio**21) ** (1.0 / 12.0))


def _draw_pipe(rng: Generator, scales: Scales) -> dict[str, float]:
    return {"speed": scales.speed * rng.uniform(0.01, 0.05)}


def _two_ports(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    # An orifice with a rounded and a sharp side: unequal losses, linear when slow.
    speed = np.hypot(bench.v, values["opening"]) - values["opening"]
    return np.asarray(amount * bench.v * speed * np.where(bench.v > 0.0, 1.0, -values["back"]))


def _relief(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    # A valve on one side only, that blows off: steep, then flat.
    ratio = np.maximum(bench.v * values["side"], 0.0) / values["blow"]
    sharp = 5.0
    excess = np.logaddexp(0.0, sharp * (ratio - 1.0)) - math.log1p(math.exp(-sharp))
    return np.asarray(values["side"] * amount * (ratio - values["flat"] * excess / sharp))


def _draw_sides(rng: Generator, scales: Scales) -> dict[str, float]:
    return {
        "opening": scales.speed * rng.uniform(0.01, 0.06),
        "back": rng.uniform(0.0, 0.5),
        "side": float(rng.choice([-1.0, 1.0])),
        "blow": scales.speed * rng.uniform(0.3, 0.6),
        "flat": rng.uniform(0.4, 0.7),
    }


def _two_bodies(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    # Oil warms fast and its housing slowly; viscosity after Vogel, B/(T - C).
    t = np.maximum(bench.t, 0.0) / values["time"]
    warm = 1.0 - 0.6 * np.exp(-4.0 * t) - 0.4 * np.exp(-0.7 * t)
    thick = np.exp(values["vogel"] * (1.0 / (1.0 + 0.4 * warm) - 1.0))
    end = math.exp(values["vogel"] * (1.0 / 1.4 - 1.0))
    return np.asarray(amount * bench.v * (thick - end) / (1.0 - end))


def _balanced(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    # Warmed by its own work and cooled by the room: every record settles at its own temperature.
    step = bench.t[1] - bench.t[0]
    power = np.where(bench.t >= 0.0, (bench.v / values["speed"]) ** 2, 0.0)
    keep = math.exp(-step / values["cooling"])
    rise = signal.lfilter([step], [1.0, -keep], power) / values["cooling"] * values["gain"]
    return np.asarray(amount * bench.v * np.exp(-rise))


def _draw_thermal(rng: Generator, scales: Scales) -> dict[str, float]:
    return {
        "time": scales.duration * rng.uniform(0.1, 0.4),
        "vogel": rng.uniform(2.0, 5.0),
        "cooling": scales.duration * rng.uniform(0.1, 0.3),
        "speed": scales.speed,
        "gain": rng.uniform(3.0, 8.0),
    }


EFFECTS = (
    Effect("quadratic-damping", "spool", "a spool's orifice", _spool, _draw_quadratic),
    Effect("quadratic-damping", "gauze", "a wire gauze", _gauze, _draw_quadratic),
    Effect("power-law-damping", "ellis", "shear thinning after Ellis", _ellis, _draw_ellis),
    Effect("power-law-damping", "smooth-pipe", "Blasius flow", _smooth_pipe, _draw_pipe),
    Effect("asymmetric-damping", "two-ports", "unequal losses", _two_ports, _draw_sides),
    Effect("asymmetric-damping", "relief", "a valve on one side", _relief, _draw_sides),
    Effect("thermal-drift", "two-bodies", "oil and housing warm", _two_bodies, _draw_thermal),
    Effect("thermal-drift", "balanced", "warmed by work, cooled", _balanced, _draw_thermal),
)
"""Effects of this file."""

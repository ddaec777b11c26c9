"""Fluid damping that the baseline lacks."""

from __future__ import annotations

import math

import numpy as np

from models.checks import Array
from models.rig.bench import Bench, Scales
from models.rig.effects.effect import Effect, Values

Generator = np.random.Generator


def _film(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    return amount * bench.v


def _orifice(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    # Sudden contraction that is laminar under v0: linear there, quadratic above.
    return np.asarray(amount * bench.v * (np.hypot(bench.v, values["speed"]) - values["speed"]))


def _draw_orifice(rng: Generator, scales: Scales) -> dict[str, float]:
    return {"speed": scales.speed * rng.uniform(0.01, 0.05)}


def _ports(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    # Discharge coefficient that rises with Reynolds number to its turbulent value.
    speed = np.abs(bench.v)
    discharge = 1.0 - 0.25 * np.exp(-speed / values["speed"])
    return np.asarray(amount * bench.v * speed / discharge**2)


def _draw_ports(rng: Generator, scales: Scales) -> dict[str, float]:
    return {"speed": scales.speed * rng.uniform(0.05, 0.15)}


def _carreau(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    ratio = bench.v / values["speed"]
    return np.asarray(amount * ratio * (1.0 + ratio**2) ** (0.5 * (values["index"] - 1.0)))


def _cross(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    ratio = bench.v / values["speed"]
    return np.asarray(amount * ratio / (1.0 + np.abs(ratio) ** (1.0 - values["index"])))


def _draw_thinning(rng: Generator, scales: Scales) -> dict[str, float]:
    return {"speed": scales.speed * rng.uniform(0.002, 0.01), "index": rng.uniform(0.3, 0.6)}


def _check_valve(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    return np.asarray(amount * bench.v * np.tanh(bench.v / values["opening"]))


def _draw_opening(rng: Generator, scales: Scales) -> dict[str, float]:
    return {"opening": scales.speed * rng.uniform(0.005, 0.02)}


def _shims(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    # A stack of shims that bends open on one side: pressure grows more slowly at high flow.
    speed = np.hypot(bench.v, values["opening"]) - values["opening"]
    return np.asarray(amount * speed / (1.0 + speed / values["bend"]) ** 0.25)


def _draw_shims(rng: Generator, scales: Scales) -> dict[str, float]:
    return _draw_opening(rng, scales) | {"bend": scales.speed * rng.uniform(0.3, 1.0)}


def _warming(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    # Each record starts with cold, thick oil that warms toward its nominal viscosity.
    cold = np.exp(-np.maximum(bench.t, 0.0) / values["time"])
    return np.asarray(amount * _viscous(bench) * _thicker(cold, values))


def _dissipating(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    # Cold oil that is warmed by the work done on it, without cooling within a record.
    power = np.maximum(_viscous(bench) * bench.v, 0.0)
    power[: bench.lead] = 0.0
    heat = np.cumsum(power) * (bench.t[1] - bench.t[0])
    cold = 1.0 / (1.0 + heat / values["heat"])
    return np.asarray(amount * _viscous(bench) * _thicker(cold, values))


def _thicker(cold: Array, values: Values) -> Array:
    """Return the excess viscosity, 1 where coldest: exponential in temperature."""
    return np.asarray(np.expm1(values["beta"] * cold) / math.expm1(values["beta"]))


def _draw_warming(rng: Generator, scales: Scales) -> dict[str, float]:
    return {
        "time": scales.duration * rng.uniform(0.05, 0.2),
        "heat": scales.force_rms * scales.speed * rng.uniform(0.05, 0.3),
        "beta": rng.uniform(0.5, 1.5),
    }


def _viscous(bench: Bench) -> Array:
    return np.asarray(bench.device.laminar_coefficients.c2 * bench.v)


EFFECTS = (
    Effect("viscous-damping", "film", "a further oil film: c v", _film, unit="N s/m"),
    Effect(
        "quadratic-damping",
        "orifice",
        "an orifice, laminar under v0: v (sqrt(v^2 + v0^2) - v0)",
        _orifice,
        _draw_orifice,
        unit="N s^2/m^2",
    ),
    Effect(
        "quadratic-damping",
        "ports",
        "ports whose discharge coefficient rises with flow: v|v|/(1 - 0.25 exp(-|v|/v0))^2",
        _ports,
        _draw_ports,
        unit="N s^2/m^2",
    ),
    Effect(
        "power-law-damping",
        "carreau",
        "shear-thinning film after Carreau, index 0.3 to 0.6: r (1 + r^2)^((n-1)/2), r = v/v0",
        _carreau,
        _draw_thinning,
        unit="N",
    ),
    Effect(
        "power-law-damping",
        "cross",
        "shear-thinning film after Cross, index 0.3 to 0.6: r/(1 + |r|^(1-n)), r = v/v0",
        _cross,
        _draw_thinning,
        unit="N",
    ),
    Effect(
        "asymmetric-damping",
        "check-valve",
        "a check valve that opens over a finite speed: c v tanh(v/v0)",
        _check_valve,
        _draw_opening,
        unit="N s/m",
    ),
    Effect(
        "asymmetric-damping",
        "shims",
        "a shim stack on one side: s/(1 + s/v1)^0.25, s = sqrt(v^2 + v0^2) - v0",
        _shims,
        _draw_shims,
        unit="N s/m",
    ),
    Effect(
        "thermal-drift",
        "warming",
        "oil that starts each record cold: viscous drag times exp(beta exp(-t/T)) - 1",
        _warming,
        _draw_warming,
        unit="1",
    ),
    Effect(
        "thermal-drift",
        "dissipation",
        "oil that starts each record cold and is warmed by the work done on it",
        _dissipating,
        _draw_warming,
        unit="1",
    ),
)
"""Effects of this file."""

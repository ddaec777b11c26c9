"""Dry friction and hysteresis as measured on other parts."""

from __future__ import annotations

import numpy as np
from numba import njit
from scipy.interpolate import CubicSpline

from models.checks import Array
from models.rig.bench import Bench, Scales
from models.rig.effects.effect import Effect, Values, seal_direction

Generator = np.random.Generator


def _reversal(rng: Generator, scales: Scales) -> dict[str, float]:
    return {"reversal": scales.speed * 10.0 ** rng.uniform(-3.7, -2.9)}


def _ptfe(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    # Constantinou, Mokha and Reinhorn, J. Struct. Eng. 116 (1990) 455-474.
    risen = 1.0 - values["fall"] * np.exp(-np.abs(bench.v) / values["speed"])
    return np.asarray(amount * risen * np.tanh(bench.v / values["reversal"]))


def _draw_ptfe(rng: Generator, scales: Scales) -> dict[str, float]:
    return _reversal(rng, scales) | {
        "fall": rng.uniform(0.2, 0.5),
        "speed": scales.speed * rng.uniform(0.003, 0.015),
    }


def _dupont(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    # Purely elastic up to breakaway, then purely plastic (Dupont et al., IEEE TAC 47, 2002).
    drive = bench.drive
    state = _slide(drive.position / values["presliding"], drive.passes)
    return bench.drive.sample(np.asarray(amount * state))


@njit(cache=True)
def _slide(x: Array, passes: int) -> Array:
    result = np.empty(x.size)
    z = 0.0
    for _ in range(passes):
        for i in range(x.size):
            z = min(max(z + x[i] - x[i - 1], -1.0), 1.0)
            result[i] = z
    return result


def _draw_dupont(rng: Generator, scales: Scales) -> dict[str, float]:
    return {"presliding": scales.displacement * rng.uniform(0.0005, 0.003)}


def _lagging(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    # Bo and Pavelescu's exponent near 2, with the film's lag (Armstrong-Helouvry 1991).
    before = CubicSpline(bench.t, bench.v)(bench.t - values["lag"])
    fall = np.exp(-((np.abs(before) / values["stribeck_speed"]) ** values["exponent"]))
    return np.asarray(amount * fall * seal_direction(bench, values))


def _popp(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    # Popp and Stelter, Phil. Trans. R. Soc. A 332 (1990) 89-105: hyperbolic fall.
    fall = 1.0 / (1.0 + np.abs(bench.v) / values["stribeck_speed"]) ** 2
    return np.asarray(amount * fall * seal_direction(bench, values))


def _draw_stribeck(rng: Generator, scales: Scales) -> dict[str, float]:
    return _reversal(rng, scales) | {
        "stribeck_speed": scales.speed * 10.0 ** rng.uniform(-1.2, -0.6),
        "exponent": rng.uniform(1.6, 2.4),
        "lag": rng.uniform(0.0005, 0.002),
    }


def _scored(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    s = (bench.x / values["stroke"] - values["centre"]) / values["width"]
    return np.asarray(amount / (1.0 + np.exp(-s)) * seal_direction(bench, values))


def _bulge(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    s = (bench.x / values["stroke"] - 0.3 * values["centre"]) / (3.0 * values["width"])
    return np.asarray(amount * -np.expm1(-(s**2)) * seal_direction(bench, values))


def _draw_bore(rng: Generator, scales: Scales) -> dict[str, float]:
    return _reversal(rng, scales) | {
        "stroke": scales.displacement,
        "centre": rng.uniform(-0.2, 0.4),
        "width": rng.uniform(0.12, 0.25),
    }


def _berg(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    # M. Berg, Vehicle System Dynamics 30 (1998) 197-212: friction of filled rubber.
    drive = bench.drive
    state = _turning(drive.position / values["half"], 2 * drive.passes)
    return bench.drive.sample(np.asarray(amount * state))


@njit(cache=True)
def _turning(x: Array, passes: int) -> Array:
    result = np.empty(x.size)
    start, level, force, way = x[0], 0.0, 0.0, 0.0
    for _ in range(passes):
        for i in range(x.size):
            step = x[i] - x[i - 1]
            if step * way < 0.0:
                start, level = x[i - 1], force
            if step != 0.0:
                way = 1.0 if step > 0.0 else -1.0
            gone = abs(x[i] - start)
            bend = 1.0 - way * level
            if bend + gone > 0.0:
                force = level + way * gone * bend / (bend + gone)
            result[i] = force
    return result


def _leaves(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    # Fancher et al., SAE 800905: leaf springs approach an envelope that opens with deflection.
    drive = bench.drive
    s = drive.position / values["stroke"]
    state = _approach(s, values["beta"], values["opening"], 2 * drive.passes)
    return bench.drive.sample(np.asarray(amount * state))


@njit(cache=True)
def _approach(s: Array, beta: float, opening: float, passes: int) -> Array:
    result = np.empty(s.size)
    force = 0.0
    for _ in range(passes):
        for i in range(s.size):
            step = s[i] - s[i - 1]
            side = (1.0 if step >= 0.0 else -1.0) * (1.0 + opening * s[i])
            force = side + (force - side) * np.exp(-abs(step) / beta)
            result[i] = force
    return result


def _draw_yield(rng: Generator, scales: Scales) -> dict[str, float]:
    return {
        "half": scales.displacement * rng.uniform(0.03, 0.12),
        "stroke": scales.displacement,
        "beta": rng.uniform(0.04, 0.12),
        "opening": rng.uniform(0.0, 0.15),
    }


EFFECTS = (
    Effect("coulomb-friction", "ptfe", "rises to sliding friction", _ptfe, _draw_ptfe, unit="N"),
    Effect("coulomb-friction", "dupont", "elastic, then plastic", _dupont, _draw_dupont, unit="N"),
    Effect("stribeck-friction", "lagging", "Gaussian, lagging", _lagging, _draw_stribeck,
           unit="N", at_seals=True),
    Effect("stribeck-friction", "popp", "hyperbolic fall", _popp, _draw_stribeck, unit="N",
           at_seals=True),
    Effect("position-dependent-friction", "scored", "tight at an end", _scored, _draw_bore,
           unit="N", at_seals=True),
    Effect("position-dependent-friction", "bulge", "wide in the middle", _bulge, _draw_bore,
           unit="N", at_seals=True),
    Effect("hysteresis", "berg", "friction of filled rubber", _berg, _draw_yield, unit="N"),
    Effect("hysteresis", "leaves", "friction of leaf springs", _leaves, _draw_yield, unit="N"),
)
"""Effects of this file."""

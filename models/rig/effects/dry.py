"""Dry friction that the baseline lacks: seals, guides, presliding."""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from models.checks import Array
from models.rig.bench import Bench, Scales
from models.rig.effects.effect import Effect, Values, seal_direction
from models.rig.seal import Seal, presliding_friction

Generator = np.random.Generator


def _arctan(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    return np.asarray(amount * 2.0 / math.pi * np.arctan(bench.v / values["reversal"]))


def _bristles(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    return amount * _along(bench, values, breakaway=1.0)


def _along(bench: Bench, values: Values, *, breakaway: float) -> Array:
    seal = Seal(
        sliding=1.0,
        breakaway=breakaway,
        stribeck_speed=values.get("stribeck_speed", 1.0),
        presliding=values["presliding"],
    )
    drive = bench.drive
    return drive.sample(
        presliding_friction(drive.position, drive.velocity, seal=seal, passes=drive.passes)
    )


def _draw_reversal(rng: Generator, scales: Scales) -> dict[str, float]:
    return {"reversal": scales.speed * 10.0 ** rng.uniform(-3.5, -3.0)}


def _draw_presliding(rng: Generator, scales: Scales) -> dict[str, float]:
    return {"presliding": scales.displacement * rng.uniform(0.001, 0.004)}


def _tustin(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    fall = np.exp(-np.abs(bench.v) / values["stribeck_speed"])
    return np.asarray(amount * fall * seal_direction(bench, values))


def _hess_soom(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    fall = 1.0 / (1.0 + (bench.v / values["stribeck_speed"]) ** 2)
    return np.asarray(amount * fall * seal_direction(bench, values))


def _lugre(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    fallen = _along(bench, values, breakaway=3.0) - _along(bench, values, breakaway=1.0)
    return np.asarray(amount * fallen)


def _draw_stribeck(rng: Generator, scales: Scales) -> dict[str, float]:
    speed = scales.speed * 10.0 ** rng.uniform(-1.4, -0.8)
    return (
        {"stribeck_speed": speed}
        | _draw_reversal(rng, scales)
        | {"presliding": scales.displacement * rng.uniform(0.0005, 0.002)}
    )


def _taper(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    # A bore that narrows to one side: the seal's squeeze follows its stiffening rubber.
    squeeze = np.expm1(values["bend"] * bench.x / values["stroke"]) / values["bend"]
    return np.asarray(amount * squeeze * seal_direction(bench, values))


def _waist(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    # A worn bore: tight away from a point near the middle.
    s = (bench.x - values["centre"]) / values["stroke"]
    return np.asarray(amount * s**2 / (0.5 + s**2) * seal_direction(bench, values))


def _draw_bore(rng: Generator, scales: Scales) -> dict[str, float]:
    return _draw_reversal(rng, scales) | {
        "stroke": scales.displacement,
        "bend": rng.uniform(0.2, 0.6),
        "centre": scales.displacement * rng.uniform(-0.1, 0.1),
    }


def _iwan(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    position = bench.drive.position
    limits = values["yield"] * np.linspace(0.3, 1.7, 12)
    return bench.drive.sample(
        np.asarray(amount / values["yield"] * _slip(position, limits, bench.drive.passes))
    )


@njit(cache=True)  # type: ignore[untyped-decorator]
def _slip(x: Array, limits: Array, passes: int) -> Array:
    """Return the mean deflection of elastic sliders that slip at their limits."""
    result = np.empty(x.size)
    z = np.zeros(limits.size)
    for _ in range(passes):
        for i in range(x.size):
            step = x[i] - x[i - 1]
            total = 0.0
            for j in range(limits.size):
                z[j] = min(max(z[j] + step, -limits[j]), limits[j])
                total += z[j]
            result[i] = total / limits.size
    return result


def _bouc_wen(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    steps = np.diff(bench.drive.position, prepend=bench.drive.position[-1]) / values["yield"]
    state = _wen(steps, values["sharpness"], values["pinch"], bench.drive.passes)
    return bench.drive.sample(np.asarray(amount * state))


@njit(cache=True)  # type: ignore[untyped-decorator]
def _wen(steps: Array, sharpness: float, share: float, passes: int) -> Array:
    """Return Bouc and Wen's state for steps in units of the yield displacement."""
    result = np.empty(steps.size)
    z = 0.0
    for _ in range(passes):
        for i in range(steps.size):
            parts = int(math.ceil(abs(steps[i]) / 0.05)) + 1
            h = steps[i] / parts
            for _ in range(parts):
                way = share + (1.0 - share) * (1.0 if z * h >= 0.0 else -1.0)
                middle = z + 0.5 * h * (1.0 - way * abs(z) ** sharpness)
                way = share + (1.0 - share) * (1.0 if middle * h >= 0.0 else -1.0)
                z += h * (1.0 - way * abs(middle) ** sharpness)
            result[i] = z
    return result


def _draw_yield(rng: Generator, scales: Scales) -> dict[str, float]:
    return {
        "yield": scales.displacement * 10.0 ** rng.uniform(-1.5, -1.0),
        "sharpness": rng.uniform(1.2, 2.5),
        "pinch": rng.uniform(0.4, 0.7),
    }


EFFECTS = (
    Effect(
        "coulomb-friction",
        "guide",
        "a dry guide that reverses over a finite speed: (2/pi) arctan(v/v_t)",
        _arctan,
        _draw_reversal,
        unit="N",
    ),
    Effect(
        "coulomb-friction",
        "bristles",
        "a seal that deflects before it slides (Dahl)",
        _bristles,
        _draw_presliding,
        unit="N",
    ),
    Effect(
        "stribeck-friction",
        "tustin",
        "exp(-|v|/v_s) times the seals' direction",
        _tustin,
        _draw_stribeck,
        unit="N",
        at_seals=True,
    ),
    Effect(
        "stribeck-friction",
        "hess-soom",
        "the seals' direction over 1 + (v/v_s)^2",
        _hess_soom,
        _draw_stribeck,
        unit="N",
        at_seals=True,
    ),
    Effect(
        "stribeck-friction",
        "lugre",
        "what breakaway at three times sliding friction adds to a seal with presliding (LuGre)",
        _lugre,
        _draw_stribeck,
        unit="N",
    ),
    Effect(
        "position-dependent-friction",
        "taper",
        "a bore that narrows to one side: (exp(k x/X) - 1)/k times the seals' direction",
        _taper,
        _draw_bore,
        unit="N",
        at_seals=True,
    ),
    Effect(
        "position-dependent-friction",
        "waist",
        "a bore worn near its middle: s^2/(0.5 + s^2) times the seals' direction, s = (x - x0)/X",
        _waist,
        _draw_bore,
        unit="N",
        at_seals=True,
    ),
    Effect(
        "hysteresis",
        "iwan",
        "twelve elastic sliders with limits spread about the yield displacement (Iwan)",
        _iwan,
        _draw_yield,
        unit="N",
    ),
    Effect(
        "hysteresis",
        "bouc-wen",
        "Bouc and Wen's law with unequal loading and unloading",
        _bouc_wen,
        _draw_yield,
        unit="N",
    ),
)
"""Effects of this file."""

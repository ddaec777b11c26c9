"""Masses, springs, stops and viscoelastic parts by further laws."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray
from scipy import fft

from models.checks import Array
from models.rig.bench import Bench, Scales
from models.rig.effects.effect import Effect, Values

Generator = np.random.Generator


def _arm(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    # A mass on an arm that the rod swings: its leverage grows a little toward the ends.
    s = bench.x / values["arm"]
    share = 1.0 / (1.0 - s**2)
    return np.asarray(amount * share * (bench.a + share * s / values["arm"] * bench.v**2))


def _coils(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    # A coil spring whose end coils close: a little stiffer away from its middle.
    s = bench.x / values["stroke"]
    return np.asarray(amount * bench.x * (1.0 + values["rise"] * s**2 / (1.0 + s**2)))


def _draw_linear(rng: Generator, scales: Scales) -> dict[str, float]:
    return {
        "arm": scales.displacement * rng.uniform(9.0, 14.0),
        "stroke": scales.displacement,
        "rise": rng.uniform(0.03, 0.12),
    }


def _membrane(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    # A membrane that is drawn tight and then follows: cubic, then linear.
    s = values["bend"] * bench.x / values["stroke"]
    return np.asarray(amount * s**3 / (1.0 + s**2))


def _toggle(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    # A toggle that eases off toward its dead point, less the linear part.
    s = values["ease"] * bench.x / values["stroke"]
    return np.asarray(amount * (np.sin(s) - s))


def _draw_curved(rng: Generator, scales: Scales) -> dict[str, float]:
    return {
        "stroke": scales.displacement,
        "bend": rng.uniform(0.8, 1.4),
        "ease": rng.uniform(2.2, 2.9),
    }


def _strut(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    # A rubber strut at both ends that can be pressed to a tenth of its length.
    deep = np.maximum(np.abs(bench.x) - values["gap"], 0.0) / values["length"]
    pressed = np.minimum(0.9 * deep, 0.97)
    return np.asarray(amount * np.sign(bench.x) * (-np.log1p(-pressed)))


def _washers(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    # Disc springs at one end sooner than at the other: steep, then easing.
    upper = np.maximum(bench.x - values["gap"], 0.0) / values["length"]
    lower = np.maximum(-bench.x - values["other"], 0.0) / values["length"]
    return np.asarray(amount * (_disc(upper) - _disc(lower)))


def _disc(deep: Array) -> Array:
    return np.asarray(deep * (1.0 - 0.45 * deep + 0.1 * deep**2))


def _draw_stop(rng: Generator, scales: Scales) -> dict[str, float]:
    gap = scales.displacement * rng.uniform(0.62, 0.85)
    return {
        "gap": gap,
        "other": min(gap * rng.uniform(0.92, 1.08), 0.92 * scales.displacement),
        "length": scales.displacement - gap,
    }


def _filtered(bench: Bench, response: NDArray[np.complex128]) -> Array:
    spectrum = np.asarray(fft.rfft(bench.drive.position)) * response
    return bench.drive.sample(np.asarray(fft.irfft(spectrum, n=bench.drive.position.size)))


def _skewed(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    # Davidson and Cole's skewed relaxation, above its corner.
    rate = 1.0 + 1j * bench.drive.omega * values["time"]
    return _filtered(bench, amount * (rate ** values["order"] - 1.0))


def _soaking(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    # Pressure that soaks into a porous wall, finite but thick: sqrt(z) tanh(sqrt(z)).
    root = np.sqrt(1j * bench.drive.omega * values["time"])
    return _filtered(bench, amount * root * np.tanh(root))


def _draw_memory(rng: Generator, scales: Scales) -> dict[str, float]:
    lowest = 2.0 * math.pi * scales.low_frequency
    return {"order": rng.uniform(0.3, 0.7), "time": rng.uniform(8.0, 20.0) / lowest}


EFFECTS = (
    Effect("inertia", "arm", "a mass on an arm", _arm, _draw_linear, unit="kg"),
    Effect("stiffness", "coils", "a coil spring that closes", _coils, _draw_linear, unit="N/m"),
    Effect("cubic-stiffness", "membrane", "drawn tight", _membrane, _draw_curved, unit="N"),
    Effect("cubic-stiffness", "toggle", "a toggle that eases off", _toggle, _draw_curved, unit="N"),
    Effect("end-stop", "strut", "rubber struts", _strut, _draw_stop, unit="N"),
    Effect("end-stop", "washers", "disc springs", _washers, _draw_stop, unit="N"),
    Effect("fractional-derivative", "skewed", "skewed relaxation", _skewed, _draw_memory),
    Effect("fractional-derivative", "soaking", "a porous wall", _soaking, _draw_memory),
)
"""Effects of this file."""

"""Springs, stops and viscoelastic parts by other laws."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray
from scipy import fft

from models.checks import Array
from models.rig.bench import Bench, Scales
from models.rig.effects.effect import Effect, Values

Generator = np.random.Generator


def _cushion(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    # Tangent elasticity of packing foam (Mindlin 1945), less its linear part.
    s = 0.5 * math.pi * bench.x / values["length"]
    return np.asarray(amount * (np.tan(s) - s))


def _magnets(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    # The pull of two magnets past each other, less its linear part: softens, then saturates.
    s = 1.1 * bench.x / values["length"]
    return np.asarray(amount * s * ((1.0 + s**2) ** -1.5 - 1.0))


def _draw_length(rng: Generator, scales: Scales) -> dict[str, float]:
    return {"length": scales.displacement * rng.uniform(1.12, 1.3)}


def _foam(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    # Cellular polyurethane bumpers: exponential in their compression.
    upper = np.maximum(bench.x - values["upper"], 0.0) / values["length"]
    lower = np.maximum(-bench.x - values["lower"], 0.0) / values["length"]
    return np.asarray(amount * (np.expm1(2.0 * upper) - np.expm1(2.0 * lower)))


def _contact(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    # Hunt and Crossley: damping in proportion to compression, never pulling.
    deep = np.maximum(np.abs(bench.x) - values["upper"], 0.0) / values["length"]
    rate = np.sign(bench.x) * bench.v / values["speed"]
    push = deep ** values["power"] * np.maximum(1.0 + values["loss"] * rate, 0.0)
    return np.asarray(amount * np.sign(bench.x) * push)


def _draw_stop(rng: Generator, scales: Scales) -> dict[str, float]:
    upper = scales.displacement * rng.uniform(0.6, 0.85)
    return {
        "upper": upper,
        "lower": min(upper * rng.uniform(0.95, 1.05), 0.9 * scales.displacement),
        "length": scales.displacement - upper,
        "speed": scales.speed,
        "power": rng.uniform(1.0, 2.0),
        "loss": rng.uniform(0.1, 0.6),
    }


def _filtered(bench: Bench, response: NDArray[np.complex128]) -> Array:
    spectrum = np.asarray(fft.rfft(bench.drive.position)) * response
    return bench.drive.sample(np.asarray(fft.irfft(spectrum, n=bench.drive.position.size)))


def _polymer(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    # Cole and Cole's relaxation: a power of frequency that levels off above the band.
    rate = (1j * bench.drive.omega * values["time"]) ** values["order"]
    return _filtered(bench, amount * rate / (1.0 + rate))


def _draw_polymer(rng: Generator, scales: Scales) -> dict[str, float]:
    corner = 2.0 * math.pi * scales.high_frequency * rng.uniform(100.0, 1000.0)
    return {"order": rng.uniform(0.3, 0.7), "time": 1.0 / corner}


def _slot(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    # Wall friction of oil swinging in a wide flat slot, above the plug: near omega^1.5.
    omega = np.maximum(bench.drive.omega, 1e-9)
    z = np.sqrt(1j * omega / values["corner"])
    tanh = np.tanh(z) / z
    return _filtered(bench, amount * (1j * omega) ** 2 * tanh / (1.0 - tanh))


def _draw_slot(rng: Generator, scales: Scales) -> dict[str, float]:
    return {"corner": 2.0 * math.pi * scales.low_frequency * 10.0 ** rng.uniform(-3.0, -2.3)}


EFFECTS = (
    Effect("cubic-stiffness", "cushion", "packing foam", _cushion, _draw_length, unit="N"),
    Effect("cubic-stiffness", "magnets", "passing magnets", _magnets, _draw_length),
    Effect("end-stop", "foam", "cellular bumpers", _foam, _draw_stop, unit="N"),
    Effect("end-stop", "contact", "contact after Hunt and Crossley", _contact, _draw_stop),
    Effect("fractional-derivative", "polymer", "Cole-Cole relaxation", _polymer, _draw_polymer),
    Effect("fractional-derivative", "slot", "oil swinging in a slot", _slot, _draw_slot),
)
"""Effects of this file."""

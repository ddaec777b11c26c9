"""Springs, stops, masses and viscoelastic parts beside the device."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray
from scipy import fft

from models.checks import Array
from models.flow import normalised_impedance
from models.rig.bench import Bench, Scales
from models.rig.effects.effect import Effect, Values

Generator = np.random.Generator


def _mass(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    return amount * bench.a


def _spring(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    return amount * bench.x


def _slack_wire(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    span = values["span"]
    return np.asarray(amount * bench.x * (1.0 - span / np.hypot(span, bench.x)))


def _draw_span(rng: Generator, scales: Scales) -> dict[str, float]:
    return {"span": scales.displacement * rng.uniform(1.2, 3.0)}


def _gas(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    s = bench.x / values["column"]
    n = values["polytropic"]
    return np.asarray(amount * ((1.0 - s) ** -n - (1.0 + s) ** -n - 2.0 * n * s))


def _draw_gas(rng: Generator, scales: Scales) -> dict[str, float]:
    column = scales.displacement * rng.uniform(1.6, 3.0)
    return {"column": column, "polytropic": rng.uniform(1.1, 1.4)}


def _rubber_stop(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    deep = np.maximum(np.abs(bench.x) - values["gap"], 0.0)
    return np.asarray(amount * np.sign(bench.x) * deep**1.5)


def _cushion_stop(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    # A closing oil cushion with its buffer spring: resists approach, lets go on return.
    deep = np.maximum(np.abs(bench.x) - values["gap"], 0.0) / values["length"]
    approach = np.maximum(np.sign(bench.x) * bench.v, 0.0) / values["speed"]
    return np.asarray(amount * np.sign(bench.x) * deep * (1.0 + 0.5 * approach))


def _draw_stop(rng: Generator, scales: Scales) -> dict[str, float]:
    gap = scales.displacement * rng.uniform(0.7, 0.88)
    return {"gap": gap, "length": scales.displacement - gap, "speed": scales.speed}


def _filtered(bench: Bench, response: NDArray[np.complex128]) -> Array:
    spectrum = np.asarray(fft.rfft(bench.drive.position)) * response
    return bench.drive.sample(np.asarray(fft.irfft(spectrum, n=bench.drive.position.size)))


def _rubber(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    # Maxwell elements with relaxation times four a decade, moduli along a power law.
    omega = bench.drive.omega
    times = np.geomspace(values["fastest"], values["slowest"], round(values["elements"]))
    response = np.zeros(omega.size, dtype=np.complex128)
    for tau in times:
        lag = 1j * omega * tau
        response += tau ** -values["order"] * lag / (1.0 + lag)
    size = abs(np.interp(values["centre"], omega, np.abs(response)))
    return _filtered(bench, amount * response / size)


def _draw_rubber(rng: Generator, scales: Scales) -> dict[str, float]:
    slowest = 3.0 / scales.low_frequency
    fastest = 1.0 / (2.0 * math.pi * 20.0 * scales.high_frequency)
    return {
        "order": rng.uniform(0.3, 0.6),
        "slowest": slowest,
        "fastest": fastest,
        "elements": float(math.ceil(4.0 * math.log10(slowest / fastest))),
        "centre": 2.0 * math.pi * scales.high_frequency,
    }


def _side_line(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    # Wall friction of thin oil swinging in a wide side line: near omega^1.5.
    omega = bench.drive.omega
    womersley = values["radius"] * np.sqrt(omega / values["viscosity"])
    response = 1j * omega * normalised_impedance(womersley, part="wall")
    return _filtered(bench, amount * response)


def _draw_side_line(rng: Generator, scales: Scales) -> dict[str, float]:
    viscosity = 10.0 ** rng.uniform(-5.5, -5.0)
    lowest = 2.0 * math.pi * scales.low_frequency
    return {
        "viscosity": viscosity,
        "radius": rng.uniform(20.0, 40.0) * math.sqrt(viscosity / lowest),
    }


EFFECTS = (
    Effect("inertia", "fixture", "mass that moves with the piston: m a", _mass, unit="kg"),
    Effect("stiffness", "spring", "a linear spring beside the device: k x", _spring, unit="N/m"),
    Effect(
        "cubic-stiffness",
        "wire",
        "unstretched wires of span L across the motion: k x (1 - L/sqrt(L^2 + x^2))",
        _slack_wire,
        _draw_span,
        unit="N/m",
    ),
    Effect(
        "cubic-stiffness",
        "gas",
        "two opposed gas columns less their linear part: (1 - s)^-n - (1 + s)^-n - 2 n s, s = x/L",
        _gas,
        _draw_gas,
        unit="N",
    ),
    Effect(
        "end-stop",
        "rubber",
        "rubber buffers at both ends: (|x| - gap)^1.5",
        _rubber_stop,
        _draw_stop,
        unit="N/m^1.5",
    ),
    Effect(
        "end-stop",
        "cushion",
        "buffer springs with oil cushions that resist approach only",
        _cushion_stop,
        _draw_stop,
        unit="N",
    ),
    Effect(
        "fractional-derivative",
        "rubber",
        "a rubber part: Maxwell elements, four a decade, moduli as tau^-order (order 0.3 to 0.6)",
        _rubber,
        _draw_rubber,
        unit="N/m",
    ),
    Effect(
        "fractional-derivative",
        "side-line",
        "wall layer of oil swinging in a side line: 2 z I3(z)/I2(z), near order 1.5",
        _side_line,
        _draw_side_line,
        unit="N s/m",
    ),
)
"""Effects of this file."""

"""Effects that the catalogue has no name for: the right answer on them is "unknown"."""

from __future__ import annotations

import math

import numpy as np
from scipy.interpolate import CubicSpline

from models.checks import Array
from models.rig.bench import Bench, Scales
from models.rig.effects.effect import Effect, Values

Generator = np.random.Generator


def _pulsation(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    # Not synchronous with the motion: another phase in each record.
    angle = 2.0 * math.pi * values["frequency"] * bench.t + values["phase"] * (bench.index + 1.0)
    return np.asarray(amount * (np.sin(angle) + 0.4 * np.sin(2.0 * angle + 1.0)))


def _draw_pulsation(rng: Generator, scales: Scales) -> dict[str, float]:
    return {"frequency": rng.uniform(23.0, 24.8), "phase": rng.uniform(1.0, 5.0)}


def _centrifugal(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    return np.asarray(amount * bench.x * bench.v**2)


def _echo(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    later = CubicSpline(bench.t, force)(bench.t - values["delay"])
    return np.asarray(amount * later * np.tanh(later / values["force"]))


def _draw_echo(rng: Generator, scales: Scales) -> dict[str, float]:
    return {"delay": rng.uniform(0.03, 0.08), "force": 0.3 * scales.force}


def _subharmonic(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    # Every second cycle differs: a part that turns half round per stroke.
    point = bench.drive.point
    angle = math.pi * point.frequency * bench.t + values["phase"]
    return np.asarray(amount * point.amplitude / values["stroke"] * np.sin(angle))


def _draw_subharmonic(rng: Generator, scales: Scales) -> dict[str, float]:
    return {"phase": rng.uniform(0.0, 2.0 * math.pi), "stroke": scales.displacement}


def _side_load(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    return np.asarray(amount * np.abs(bench.a) * np.tanh(bench.v / values["reversal"]))


def _draw_side_load(rng: Generator, scales: Scales) -> dict[str, float]:
    return {"reversal": scales.speed * 10.0 ** rng.uniform(-3.5, -3.0)}


def _draining(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    # The length of the filled line, and with it its mass, follows the piston.
    s = bench.x / values["stroke"]
    return np.asarray(amount * bench.a * (s + 0.5 * s**2))


def _draw_stroke(rng: Generator, scales: Scales) -> dict[str, float]:
    return {"stroke": scales.displacement}


EFFECTS = (
    Effect(
        "outside:pump-pulsation",
        "tone",
        "a pump's pulsation and its octave near 24 Hz, not synchronous with the motion",
        _pulsation,
        _draw_pulsation,
        unit="N",
    ),
    Effect(
        "outside:velocity-squared-displacement",
        "product",
        "x v^2: mass whose leverage changes along the stroke",
        _centrifugal,
        unit="N s^2/m^3",
    ),
    Effect(
        "outside:echo",
        "rectified",
        "a pressure wave that returns after 30 to 80 ms, growing with its strength, one-sided",
        _echo,
        _draw_echo,
        unit="1",
    ),
    Effect(
        "outside:subharmonic",
        "half",
        "force at half the test's frequency, proportional to the stroke",
        _subharmonic,
        _draw_subharmonic,
        unit="N",
    ),
    Effect(
        "outside:load-dependent-friction",
        "side-load",
        "friction that grows with acceleration: |a| tanh(v/v_t)",
        _side_load,
        _draw_side_load,
        unit="N s^2/m",
    ),
    Effect(
        "outside:position-dependent-inertance",
        "draining",
        "inertance that follows the piston: a (s + s^2/2), s = x/X",
        _draining,
        _draw_stroke,
        unit="kg",
    ),
)
"""Effects of this file."""

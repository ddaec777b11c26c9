"""Parts in the load path by further laws."""

from __future__ import annotations

import math

import numpy as np

from models.checks import Array
from models.rig.bench import Bench, Scales
from models.rig.effects.effect import Effect, Values
from models.rig.stepping import Element
from tests.calibration.gap.load_path import change, start_joint, stiff

Generator = np.random.Generator


def _eye(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    # A rod eye bushed with rubber: yields less the more it is pressed, as a cube.
    full = values["force"]
    s = np.linspace(-2.0, 2.0, 241)
    given = amount * full * s
    load = full * (s + values["bend"] * s**3)
    damping = values["loss"] / amount / values["omega"]
    return change(bench, Element(np.asarray(given), np.asarray(load), damping), seals=True)


def _gasket(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    # A flange on its gasket: softer when pulled, where the bolts yield, than when pressed.
    full = values["force"]
    loads = full * np.linspace(-3.0, 3.0, 301)
    s = loads / full
    given = s + values["bend"] * 0.1 * np.logaddexp(0.0, 10.0 * s)
    damping = values["loss"] / amount / values["omega"]
    shifted = amount * full * (given - np.interp(0.0, s, given))
    return change(bench, Element(np.asarray(shifted), loads, damping), seals=False)


def _draw_joint(rng: Generator, scales: Scales) -> dict[str, float]:
    return {
        "force": scales.force,
        "bend": rng.uniform(0.2, 0.6),
        "loss": rng.uniform(0.03, 0.12),
        "omega": 2.0 * math.pi * scales.high_frequency,
    }


def _thread(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    # A worn thread: one flank bears on more turns than the other, and the play lies off centre.
    stiffness, damping = stiff(bench, values)
    upper, lower = amount * values["share"], amount * (1.0 - values["share"])
    line = np.array([-lower - 1.0, -lower, upper, upper + 1.0])
    load = stiffness * np.array([-values["flank"], 0.0, 0.0, 1.0])
    return change(bench, Element(line, load, damping), seals=True)


def _clevis(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    # A clevis that rocks before it bears: a first, softer contact over some of its play.
    stiffness, damping = stiff(bench, values)
    half, rock = 0.5 * amount, 0.3 * amount
    soft = values["rocking"] * stiffness * rock
    line = np.array([-half - rock - 1.0, -half - rock, -half, half, half + rock, half + rock + 1.0])
    load = np.array([-soft - stiffness, -soft, 0.0, 0.0, soft, soft + stiffness])
    return change(bench, Element(line, load, damping), seals=True)


def _draw_contact(rng: Generator, scales: Scales) -> dict[str, float]:
    return {
        "contact_frequency": scales.high_frequency * rng.uniform(20.0, 30.0),
        "contact_damping": rng.uniform(0.4, 0.7),
        "share": rng.uniform(0.3, 0.7),
        "flank": rng.uniform(0.4, 0.7),
        "rocking": rng.uniform(0.05, 0.2),
        "refill_time": rng.uniform(0.006, 0.02) / scales.high_frequency,
        "knee": rng.uniform(3.0, 6.0),
    }


def _start_play(scales: Scales) -> float:
    return 0.01 * scales.displacement


def _vapour(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    # Vapour fills a chamber: the pull nears its limit as an exponential of the void.
    limit = 1.0 / amount
    if float(np.min(bench.stiff_fluid)) > -0.5 * limit:
        return np.zeros(force.size)
    stiffness, damping = stiff(bench, values)
    pull = np.concatenate([[-100.0], np.linspace(-4.0, 0.0, 300), [100.0]])
    drawn = np.abs(np.minimum(pull, 0.0)) ** values["knee"]
    load = np.maximum(pull, 0.0) - (-np.expm1(-drawn)) ** (1.0 / values["knee"]) - 1e-4 * np.abs(
        np.minimum(pull, 0.0)
    )
    edge = -limit / stiffness
    element = Element(
        -edge * pull, limit * np.asarray(load), damping, values["refill_time"], edge
    )
    return change(bench, element, seals=False)


def _start_limit(scales: Scales) -> float:
    return 1.5 / scales.force


EFFECTS = (
    Effect("series-compliance", "eye", "a rod eye bushed with rubber", _eye, _draw_joint,
           linear=False, acts="input", start=start_joint, unit="m/N"),
    Effect("series-compliance", "gasket", "a flange on its gasket", _gasket, _draw_joint,
           linear=False, acts="input", start=start_joint, unit="m/N"),
    Effect("backlash", "thread", "a worn thread", _thread, _draw_contact,
           linear=False, acts="input", start=_start_play, unit="m"),
    Effect("backlash", "clevis", "a clevis that rocks", _clevis, _draw_contact,
           linear=False, acts="input", start=_start_play, unit="m"),
    Effect("cavitation", "vapour", "vapour in a chamber", _vapour, _draw_contact,
           linear=False, acts="input", start=_start_limit, unit="1/N"),
)
"""Effects of this file."""

"""Parts in the load path by other laws."""

from __future__ import annotations

import math

import numpy as np

from models.checks import Array
from models.rig.bench import Bench, Scales
from models.rig.effects.effect import Effect, Values
from models.rig.stepping import Element
from tests.calibration.gap.load_path import change, start_joint, stiff

Generator = np.random.Generator


def _bolted(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    # Rough joint faces: they stiffen as they are pressed, with a rounded start.
    return change(bench, _joint(amount, values, values["bend"]), seals=True)


def _hose(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    # A hose or gasket that yields more at high load.
    return change(bench, _joint(amount, values, -values["bend"]), seals=False)


def _joint(amount: float, values: Values, bend: float) -> Element:
    """Return an element whose compliance falls (bend > 0) or grows with load."""
    full = values["force"]
    loads = full * np.linspace(-3.0, 3.0, 241)
    s = np.abs(loads) / full
    yielding = s - bend * s**2 / (1.0 + 2.0 * s)
    line = amount * full * np.sign(loads) * yielding
    return Element(np.asarray(line), loads, values["loss"] / amount / values["omega"])


def _draw_joint(rng: Generator, scales: Scales) -> dict[str, float]:
    return {
        "force": scales.force,
        "bend": rng.uniform(0.4, 0.8),
        "loss": rng.uniform(0.05, 0.15),
        "omega": 2.0 * math.pi * scales.high_frequency,
    }


def _sealed_joint(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    # Play that a soft ring fills: a little stiffness inside the gap.
    stiffness, damping = stiff(bench, values)
    half, ring = 0.5 * amount, values["ring"]
    line = np.array([-half - 1.0, -half, half, half + 1.0])
    inside = ring * stiffness * half
    load = np.array([-inside - stiffness, -inside, inside, inside + stiffness])
    return change(bench, Element(line, load, damping), seals=True)


def _pin(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    # A pin in its hole: the contact grows as it is pressed, from soft to stiff.
    stiffness, damping = stiff(bench, values)
    reach = values["force"] / stiffness
    deep = reach * np.linspace(0.0, 4.0, 160)[1:]
    press = stiffness * deep**2 / (deep + 0.5 * reach)
    half = 0.5 * amount
    line = np.concatenate([-half - deep[::-1], [-half, half], half + deep])
    load = np.concatenate([-press[::-1], [0.0, 0.0], press])
    return change(bench, Element(line, load, damping), seals=True)


def _draw_contact(rng: Generator, scales: Scales) -> dict[str, float]:
    return {
        "contact_frequency": scales.high_frequency * rng.uniform(22.0, 30.0),
        "contact_damping": rng.uniform(0.4, 0.7),
        "ring": rng.uniform(0.001, 0.004),
        "force": scales.force,
        "knee": rng.uniform(6.0, 12.0),
        "refill_time": rng.uniform(0.008, 0.02) / scales.high_frequency,
    }


def _start_play(scales: Scales) -> float:
    return 0.01 * scales.displacement


def _foaming(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    # Pull levels off along an arc as bubbles grow, then creeps up slightly with them.
    limit = 1.0 / amount
    if float(np.min(bench.stiff_fluid)) > -0.4 * limit:
        return np.zeros(force.size)
    stiffness, damping = stiff(bench, values)
    pull = np.concatenate([[-100.0], np.linspace(-3.0, 0.0, 240), [100.0]])
    n = 0.5 * values["knee"]
    drawn = np.abs(np.minimum(pull, 0.0))
    load = np.maximum(pull, 0.0) - drawn / (1.0 + drawn**n) ** (1.0 / n) - 0.003 * drawn
    edge = -limit / stiffness
    element = Element(
        -edge * pull, limit * np.asarray(load), damping, values["refill_time"], edge
    )
    return change(bench, element, seals=False)


def _start_limit(scales: Scales) -> float:
    return 1.5 / scales.force


EFFECTS = (
    Effect("series-compliance", "bolted", "rough joint faces", _bolted, _draw_joint,
           linear=False, acts="input", start=start_joint, unit="m/N"),
    Effect("series-compliance", "hose", "softens with load", _hose, _draw_joint,
           linear=False, acts="input", start=start_joint, unit="m/N"),
    Effect("backlash", "sealed-joint", "a soft ring in the gap", _sealed_joint, _draw_contact,
           linear=False, acts="input", start=_start_play, unit="m"),
    Effect("backlash", "pin", "contact that stiffens", _pin, _draw_contact,
           linear=False, acts="input", start=_start_play, unit="m"),
    Effect("cavitation", "foaming", "bubbles grow, pull levels off", _foaming, _draw_contact,
           linear=False, acts="input", start=_start_limit, unit="1/N"),
)
"""Effects of this file."""

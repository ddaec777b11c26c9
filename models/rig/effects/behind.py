"""Parts in the load path whose dynamics have to be simulated: mounts, play, tearing oil.

Each changes the force by what it changes for a device whose oil is stiff: the oil's own yield, of a
few per cent, and the part's are superposed.
"""

from __future__ import annotations

import math

import numpy as np

from models.checks import Array
from models.rig.bench import Bench, Scales
from models.rig.effects.effect import Effect, Values
from models.rig.stepping import Element, transmitted_force

Generator = np.random.Generator
_WIDE = 1.0


def _through(bench: Bench, element: Element) -> Array:
    """Return the change where the whole device, seals included, is behind the element."""
    force = transmitted_force(bench.stiff, bench.drive, element)
    return bench.drive.sample(np.asarray(force - bench.stiff_fluid - bench.seals))


def _inside(bench: Bench, element: Element) -> Array:
    """Return the change where only the fluid's force goes through the element."""
    force = transmitted_force(bench.stiff, bench.drive, element, seal_behind=False)
    return bench.drive.sample(np.asarray(force - bench.stiff_fluid))


def _contact(bench: Bench, values: Values) -> tuple[float, float]:
    """Return stiffness and damping of a contact that resonates well above the tests."""
    omega = 2.0 * math.pi * values["contact_frequency"]
    inertance = bench.device.inertance
    return inertance * omega**2, 2.0 * values["contact_damping"] * inertance * omega


def _mount(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    stiffness = 1.0 / amount
    damping = values["loss"] * stiffness / values["omega"]
    line = np.array([-_WIDE, _WIDE])
    return _through(bench, Element(line, stiffness * line, damping))


def _draw_mount(rng: Generator, scales: Scales) -> dict[str, float]:
    return {"loss": rng.uniform(0.02, 0.08), "omega": 2.0 * math.pi * scales.high_frequency}


def _aired(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    # Oil with entrained air: soft at low pressure, stiff under load.
    full = values["force"]
    loads = full * np.linspace(-3.0, 3.0, 241)
    soft = values["air"] * full * np.arctan(loads / full * 4.0) / 4.0
    line = amount * (loads + soft) / (1.0 + values["air"])
    damping = values["loss"] / amount / values["omega"]
    return _inside(bench, Element(np.asarray(line), loads, damping))


def _draw_aired(rng: Generator, scales: Scales) -> dict[str, float]:
    return _draw_mount(rng, scales) | {"force": scales.force, "air": rng.uniform(0.2, 0.5)}


def _start_compliance(scales: Scales) -> float:
    # Yields a hundredth of the stroke that the greatest force belongs to.
    return 0.05 * scales.speed**2 / scales.acceleration / scales.force


def _play(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    stiffness, damping = _contact(bench, values)
    half = 0.5 * amount
    line = np.array([-half - _WIDE, -half, half, half + _WIDE])
    load = stiffness * _WIDE * np.array([-1.0, 0.0, 0.0, 1.0])
    return _through(bench, Element(line, load, damping))


def _bushing(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    # A worn elastic bushing: a soft middle that stiffens without a corner.
    stiffness, damping = _contact(bench, values)
    half = 0.5 * amount
    line = half * np.concatenate([-np.geomspace(400.0, 0.05, 160), np.geomspace(0.05, 400.0, 160)])
    sharp = 6.0
    play = (
        half
        * (
            np.logaddexp(0.0, sharp * (line / half - 1.0))
            - np.logaddexp(0.0, sharp * (-line / half - 1.0))
        )
        / sharp
    )
    load = stiffness * (0.99 * play + 0.01 * line)
    return _through(bench, Element(np.asarray(line), np.asarray(load), damping))


def _draw_contact(rng: Generator, scales: Scales) -> dict[str, float]:
    return {
        "contact_frequency": scales.high_frequency * rng.uniform(25.0, 30.0),
        "contact_damping": rng.uniform(0.5, 0.7),
    }


def _start_play(scales: Scales) -> float:
    return 0.01 * scales.displacement


def _start_limit(scales: Scales) -> float:
    return 1.5 / scales.force


def _make_up(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    # One chamber tears at its vapour pressure: the void opens at constant force while a make-up
    # valve lets oil in, and what is left of it must close before the force returns.
    limit = 1.0 / amount
    if float(np.min(bench.stiff_fluid)) > -0.95 * limit:
        return np.zeros(force.size)
    stiffness, damping = _contact(bench, values)
    edge = -limit / stiffness
    line = np.array([edge - _WIDE, edge, _WIDE])
    load = stiffness * np.array([edge - 1e-9 * _WIDE, edge, _WIDE])
    return _inside(bench, Element(line, load, damping, values["refill_time"], edge))


def _draw_make_up(rng: Generator, scales: Scales) -> dict[str, float]:
    refill = rng.uniform(0.004, 0.01) / scales.high_frequency
    return _draw_contact(rng, scales) | {"refill_time": refill}


def _degassing(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    # Air comes out of solution in one chamber: the pull levels off without a corner, and oil
    # flows in slowly.
    limit, sharp = 1.0 / amount, values["sharpness"]
    if float(np.min(bench.stiff_fluid)) > -0.6 * limit:
        return np.zeros(force.size)
    stiffness, damping = _contact(bench, values)
    pull = np.concatenate([[-100.0], np.linspace(-2.5, 0.5, 241), [100.0]])
    load = np.logaddexp(0.0, sharp * (pull + 1.0)) / sharp - 1.0 + 1e-6 * pull
    element = Element(
        pull * limit / stiffness, limit * load, damping, values["refill_time"], -limit / stiffness
    )
    return _inside(bench, element)


def _draw_degassing(rng: Generator, scales: Scales) -> dict[str, float]:
    refill = rng.uniform(0.015, 0.03) / scales.high_frequency
    drawn = {"sharpness": rng.uniform(8.0, 15.0), "refill_time": refill}
    return _draw_contact(rng, scales) | drawn


EFFECTS = (
    Effect(
        "series-compliance",
        "mount",
        "a mount that yields in series, with a little loss; the device behind it in time",
        _mount,
        _draw_mount,
        linear=False,
        acts="input",
        start=_start_compliance,
        unit="m/N",
    ),
    Effect(
        "series-compliance",
        "aired-oil",
        "oil with entrained air: softer at low load; the device behind it in time",
        _aired,
        _draw_aired,
        linear=False,
        acts="input",
        start=_start_compliance,
        unit="m/N",
    ),
    Effect(
        "backlash",
        "play",
        "a joint with play and stiff damped contact; the device behind it in time",
        _play,
        _draw_contact,
        linear=False,
        acts="input",
        start=_start_play,
        unit="m",
    ),
    Effect(
        "backlash",
        "bushing",
        "a worn bushing, soft in the middle without corners; the device behind it in time",
        _bushing,
        _draw_contact,
        linear=False,
        acts="input",
        start=_start_play,
        unit="m",
    ),
    Effect(
        "cavitation",
        "make-up",
        "one chamber tears at a limit while a make-up valve fills its void; in time",
        _make_up,
        _draw_make_up,
        linear=False,
        acts="input",
        start=_start_limit,
        unit="1/N",
    ),
    Effect(
        "cavitation",
        "degassing",
        "pull levels off without a corner as air leaves solution, oil flows in slowly; in time",
        _degassing,
        _draw_degassing,
        linear=False,
        acts="input",
        start=_start_limit,
        unit="1/N",
    ),
)
"""Effects of this file."""

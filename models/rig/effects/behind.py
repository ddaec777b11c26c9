"""Parts in the load path whose dynamics have to be simulated: mounts, play, tearing oil."""

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
    force = transmitted_force(bench.law, bench.drive, element)
    return bench.drive.sample(np.asarray(force - bench.stepped_force))


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
    return _through(bench, Element(np.asarray(line), loads, damping))


def _draw_aired(rng: Generator, scales: Scales) -> dict[str, float]:
    return _draw_mount(rng, scales) | {"force": scales.force, "air": rng.uniform(0.2, 0.5)}


def _start_compliance(scales: Scales) -> float:
    # Yields a hundredth of the stroke that the greatest force belongs to.
    return 0.01 * scales.speed**2 / scales.acceleration / scales.force


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
    load = stiffness * (0.98 * play + 0.02 * line)
    return _through(bench, Element(np.asarray(line), np.asarray(load), damping))


def _draw_contact(rng: Generator, scales: Scales) -> dict[str, float]:
    return {
        "contact_frequency": scales.high_frequency * rng.uniform(15.0, 20.0),
        "contact_damping": rng.uniform(0.25, 0.4),
    }


def _start_play(scales: Scales) -> float:
    return 0.01 * scales.displacement


def _vapour(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    # One chamber tears at its vapour pressure: the void opens at constant force and must be
    # closed again before the force returns.
    stiffness, damping = _contact(bench, values)
    limit = 1.0 / amount
    line = np.array([-limit / stiffness - _WIDE, -limit / stiffness, _WIDE])
    load = np.array([-limit - 1e-9 * stiffness * _WIDE, -limit, stiffness * _WIDE])
    return _through(bench, Element(line, load, damping))


def _degassing(bench: Bench, force: Array, amount: float, values: Values) -> Array:
    # Air comes out of solution on one side: the force levels off without a corner.
    limit = 1.0 / amount
    sharp = values["sharpness"]
    return np.asarray(
        limit / sharp * np.logaddexp(0.0, -sharp * (force / limit + 1.0))
        - limit / sharp * math.log1p(math.exp(-sharp))
    )


def _draw_degassing(rng: Generator, scales: Scales) -> dict[str, float]:
    return {"sharpness": rng.uniform(8.0, 15.0)}


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
        "vapour",
        "one chamber tears at a limit, its void must close before force returns; in time",
        _vapour,
        _draw_contact,
        linear=False,
        acts="input",
        start=lambda scales: 1.5 / scales.force,
        unit="1/N",
    ),
    Effect(
        "cavitation",
        "degassing",
        "pull levels off at a limit without a corner as air leaves solution",
        _degassing,
        _draw_degassing,
        linear=False,
        acts="input",
        start=lambda scales: 1.5 / scales.force,
        unit="1/N",
    ),
)
"""Effects of this file."""

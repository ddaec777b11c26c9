"""Records made by the rig or by a model, and the files of their campaign."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from discover.named_model import named_model
from discover.readers.toml_text import quoted
from models.checks import Array
from models.device import PRESETS, Device
from models.flow import dean
from models.motion import sine_motion
from models.rig import Chain, Hidden, Limits, Plan, TestPoint, measure, run

_MODEL_NOISE = 3  # its own stream, apart from the rig's
_RIG_DIGITS = 7  # a hundred times finer than 16 bits
_MODEL_DIGITS = 12


@dataclass(frozen=True)
class MadeRecord:
    """One record of a campaign that is written."""

    file: str
    """File name."""
    time: Array
    """(N,) s."""
    displacement: Array
    """(N,) m."""
    force: Array
    """(N,) N."""
    frequency: float
    """Hz."""
    amplitude: float
    """m."""
    held_out: bool
    """Never fitted, only predicted."""
    digits: int
    """Significant digits that its numbers are written with: more than its chain resolves."""


def rig_records(
    device: Device, plan: Plan, *, noise: float, hidden: Mapping[str, float], seed: int
) -> tuple[list[MadeRecord], tuple[str, ...]]:
    """Return the records that the virtual test rig measures, and what is hidden in them in words.

    Parameters
    ----------
    device : Device
        What is tested.
    plan : Plan
        Which sine tests.
    noise : float
        rms noise of the force over its rms.
    hidden : mapping
        Sizes of hidden effects by name.
    seed : int
        Makes them repeatable.
    """
    measured = run(device, plan, seed=seed, chain=Chain(noise=noise), hidden=hidden)
    made = [
        MadeRecord(
            r.file,
            r.time,
            r.displacement,
            r.force,
            p.frequency,
            p.amplitude,
            r.held_out,
            _RIG_DIGITS,
        )
        for r, p in zip(measured, plan, strict=True)
    ]
    return made, tuple(_truth(h) for h in measured[0].hidden)


def _truth(hidden: Hidden) -> str:
    effect = hidden.effect
    said = f"{effect.id}:{effect.form}, {hidden.amount:.4g} {effect.unit}".rstrip()
    rest = ", ".join(f"{name} {value:.4g}" for name, value in hidden.values.items())
    seals = f", seals that reverse by: {hidden.law}" if hidden.law else ""
    return said + (f" ({rest}; SI)" if rest else "") + seals


def model_records(
    model: str, device: Device, plan: Plan, *, noise: float, seed: int
) -> list[MadeRecord]:
    """Return exact steady-state records of a model, with noise and nothing else.

    Parameters
    ----------
    model : str
        As `named_model` takes it.
    device : Device
        What it is a model of.
    plan : Plan
        Which sine tests.
    noise : float
        rms noise of the force over its rms, white.
    seed : int
        Makes them repeatable.
    """
    law = named_model(model, device)
    chain = Chain(noise=noise, low_frequency=0.0, hum=0.0, displacement_noise=0.0, bits=0)
    made = []
    for index, point in enumerate(plan):
        samples = max(64, round(point.sampling / point.frequency))
        cycles = math.ceil(point.cycles)
        motion = sine_motion(point.amplitude, point.frequency, samples=samples, cycles=cycles)
        band = law.at(_coordinate(law.coordinate, point, device, law.convention))
        force = band.force(replace(motion, test=index + 1))
        generator = np.random.default_rng([seed, _MODEL_NOISE, index])
        x, f = measure(motion.time, motion.displacement, force, chain, generator)
        made.append(
            MadeRecord(
                point.file,
                motion.time,
                x,
                f,
                point.frequency,
                point.amplitude,
                point.held_out,
                _MODEL_DIGITS,
            )
        )
    return made


def _coordinate(name: str, point: TestPoint, device: Device, convention: str) -> float:
    if name == "frequency":
        return point.frequency
    speed = 2.0 * math.pi * point.frequency * point.amplitude
    return speed if name == "speed" else float(dean(device, speed, convention=convention))


def campaign_files(
    records: Sequence[MadeRecord], device: Device, limits: Limits, *, title: str, command: str,
    hidden: Sequence[str] = (),
) -> dict[str, str]:
    """Return the campaign's files by name: ``campaign.toml`` and one CSV a record.

    Parameters
    ----------
    records : sequence of MadeRecord
        In order.
    device : Device
        Stated in the campaign.
    limits : Limits
        Of the rig, stated too.
    title, command : str
        What the campaign is called, and the line that makes it again.
    hidden : sequence of str
        What the rig hid in the records.
    """
    lines = [f"# Simulated, by: {command}", *(f"# Hidden: {h}" for h in hidden)]
    lines += [f"title = {quoted(title)}", "", "[device]"]
    lines += _device_lines(device)
    lines += [
        "",
        "[rig]",
        f'max_stroke = "{1e3 * limits.stroke:g} mm"',
        f'max_speed = "{limits.speed:g} m/s"',
        f'max_acceleration = "{limits.acceleration:.6g} m/s^2"',
        f'max_force = "{1e-3 * limits.force:g} kN"',
    ]
    files = {}
    for record in records:
        lines += [
            "",
            "[[records]]",
            f"file = {quoted(record.file)}",
            f'frequency = "{record.frequency:.10g} Hz"',
            f'amplitude = "{1e3 * record.amplitude:.10g} mm"',
        ]
        if record.held_out:
            lines.append("held_out = true")
        files[record.file] = _csv(record)
    return {"campaign.toml": "\n".join(lines) + "\n", **files}


def _device_lines(device: Device) -> list[str]:
    if PRESETS.get(device.name) == device:
        return [f'preset = "{device.name}"']
    table = device.to_dict()
    units = {"turns": "", "inertance": " kg", "coulomb_friction": " N"}
    lines = []
    for key, value in table.items():
        if key in ("fluid", "name") or value is None:
            continue
        suffix = units.get(key, " m")
        lines.append(f"{key} = {value!r}" if not suffix else f'{key} = "{value!r}{suffix}"')
    return [
        *lines,
        "[device.fluid]",
        f'density = "{device.fluid.density!r} kg/m^3"',
        f'viscosity = "{device.fluid.viscosity!r} Pa*s"',
    ]


def _csv(record: MadeRecord) -> str:
    columns = (record.time, 1e3 * record.displacement, 1e-3 * record.force)
    rows = (
        f"{t:.{record.digits}g},{x:.{record.digits}g},{f:.{record.digits}g}"
        for t, x, f in zip(*columns, strict=True)
    )
    return "time [s],displacement [mm],force [kN]\n" + "\n".join(rows) + "\n"

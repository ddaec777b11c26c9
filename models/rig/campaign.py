"""A whole campaign on the virtual test rig."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace

import numpy as np

from models.checks import Array, InputError, number
from models.device import Device
from models.rig.bench import find_scales, make_bench
from models.rig.chain import Chain, measure
from models.rig.drive import LEAD, Drive, make_drive
from models.rig.effects import Sizes, parse_sizes
from models.rig.hiding import Hidden, hide
from models.rig.physics import RigPhysics, flow_law
from models.rig.plan import Plan

_ORDER = {"input": 0, "force": 1, "output": 2}
_MOTION, _EFFECT, _NOISE = 0, 1, 2


@dataclass(frozen=True)
class RigRecord:
    """One record of a campaign, with the truth behind it."""

    file: str
    """A file name that says what the record is."""
    time: Array
    """(N,) s, from 0."""
    displacement: Array
    """(N,) as measured, m."""
    force: Array
    """(N,) as measured, N."""
    true_displacement: Array
    """(N,) exact, m."""
    true_force: Array
    """(N,) exact, hidden effects included, before noise, delay and resolution, N."""
    frequency: float | None
    """Hz; None where the record isn't a sine test."""
    amplitude: float | None
    """m, as commanded; likewise."""
    held_out: bool
    """Never fitted, only predicted."""
    hidden: tuple[Hidden, ...] = field(default=())
    """What was hidden: the same in all records of a campaign."""


def run(
    device: Device,
    plan: Plan,
    *,
    seed: int,
    chain: Chain | None = None,
    hidden: Sizes | None = None,
    physics: RigPhysics | None = None,
) -> tuple[RigRecord, ...]:
    """Test a device on the rig.

    Parameters
    ----------
    device : Device
        What is tested.
    plan : Plan
        Which tests.
    seed : int
        The same seed gives the same records; motion, hidden parameters and noise have streams of
        their own, so a campaign with an effect hidden moves exactly as the one without.
    chain : Chain, optional
        The measuring chain.
    hidden : mapping, optional
        Effects as "id", "id:form" or an `Effect` of one's own, with their sizes: rms change in
        force over the rms force of the device without them, pooled over all samples. With several,
        each has its size alone.
    physics : RigPhysics, optional
        Which parts of the physics are simulated; all of them where not given.

    Returns
    -------
    tuple of RigRecord
        In the plan's order.

    Raises
    ------
    InputError
        For an unknown effect, or a size that it can't have.

    Examples
    --------
    >>> from models.rig.plan import sine_point
    >>> plan = Plan((sine_point(1.0, 0.005), sine_point(2.0, 0.005)))
    >>> records = run(Device.preset("device-12"), plan, seed=1)
    >>> [record.file for record in records]
    ['1hz-5mm.csv', '2hz-5mm.csv']
    """
    number("seed", seed, at_least=0)
    used = Chain() if chain is None else chain
    if used.delay > LEAD:
        raise InputError("delay", expected=f"at most {LEAD} s", found=f"{used.delay} s")
    parts = RigPhysics() if physics is None else physics
    wanted = parse_sizes(hidden or {})
    drives = [
        make_drive(point, np.random.default_rng([seed, _MOTION, i]), distortion=parts.distortion)
        for i, point in enumerate(plan)
    ]
    top = 1.5 * max(float(np.max(np.abs(drive.velocity))) for drive in drives)
    law = flow_law(device, parts, top=top)
    benches = [make_bench(law, drive, index=i) for i, drive in enumerate(drives)]
    scales = find_scales(benches)
    found = tuple(
        hide(effect, size, benches, scales, np.random.default_rng([seed, _EFFECT, i]))
        for i, (effect, size) in enumerate(wanted.items())
    )
    ordered = sorted(found, key=lambda item: _ORDER[item.effect.acts])
    forces = []
    for bench in benches:
        force = bench.force
        for item in ordered:
            force = force + item.change(bench, force)
        forces.append(force)
    everything = np.concatenate([f[b.lead :] for b, f in zip(benches, forces, strict=True)])
    pooled = math.sqrt(float(np.mean(everything**2)))
    peak = float(np.max(np.abs(everything)))
    return tuple(
        replace(
            _record(drive, force, used, pooled, peak, np.random.default_rng([seed, _NOISE, i])),
            hidden=found,
        )
        for i, (drive, force) in enumerate(zip(drives, forces, strict=True))
    )


def _record(
    drive: Drive, force: Array, chain: Chain, pooled: float, peak: float, rng: np.random.Generator
) -> RigRecord:
    """Return one record as measured."""
    lead, point = drive.lead, drive.point
    position = drive.sample(drive.position)
    reference = pooled
    if chain.reference == "record":
        reference = math.sqrt(float(np.mean(force[lead:] ** 2)))
    x, f = measure(
        drive.time,
        position,
        force,
        chain,
        rng,
        frequency=point.frequency if drive.periodic else None,
        reference=reference,
        peak=peak,
    )
    return RigRecord(
        file=point.file,
        time=np.arange(x.size - lead) / point.sampling,
        displacement=x[lead:],
        force=f[lead:],
        true_displacement=position[lead:],
        true_force=force[lead:],
        frequency=point.frequency if drive.periodic else None,
        amplitude=point.amplitude if drive.periodic else None,
        held_out=point.held_out,
    )

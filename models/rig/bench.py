"""One record on the rig before it is measured, and the campaign's scales."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from models.checks import Array
from models.device import Device
from models.rig.drive import Drive
from models.rig.physics import FlowLaw, fluid_force, seal_force


@dataclass(frozen=True)
class Scales:
    """Greatest values over a campaign: what physical parameters are drawn in proportion to."""

    displacement: float
    """m."""
    speed: float
    """m/s."""
    acceleration: float
    """m/s^2."""
    force: float
    """Peak, N."""
    force_rms: float
    """Pooled over all samples, N."""
    low_frequency: float
    """Lowest of the test points, Hz."""
    high_frequency: float
    """Highest, Hz."""
    duration: float
    """Longest record, s."""


@dataclass(frozen=True, eq=False)
class Bench:
    """One record: the drive, and the unchanged device's exact force."""

    law: FlowLaw
    """The device's physics."""
    drive: Drive
    """The motion."""
    grid_force: Array
    """(G,) force on the drive's grid, N."""
    index: int
    """Place in the plan."""

    @property
    def device(self) -> Device:
        """The device under test."""
        return self.law.device

    @property
    def lead(self) -> int:
        """Samples before the record begins."""
        return self.drive.lead

    @property
    def t(self) -> Array:
        """(M,) sample times, s, lead included (negative)."""
        return self.drive.time

    @cached_property
    def x(self) -> Array:
        """(M,) displacement, m."""
        return self.drive.sample(self.drive.position)

    @cached_property
    def v(self) -> Array:
        """(M,) velocity, m/s."""
        return self.drive.sample(self.drive.velocity)

    @cached_property
    def a(self) -> Array:
        """(M,) acceleration, m/s^2."""
        return self.drive.sample(self.drive.acceleration)

    @cached_property
    def force(self) -> Array:
        """(M,) force, N."""
        return self.drive.sample(self.grid_force)

    @cached_property
    def stiff(self) -> FlowLaw:
        """The device with stiff oil: what parts in the load path are simulated with."""
        return replace(self.law, physics=replace(self.law.physics, compressibility=False))

    @cached_property
    def stiff_fluid(self) -> Array:
        """(G,) the fluid's force with stiff oil, N."""
        return fluid_force(self.stiff, self.drive)

    @cached_property
    def seals(self) -> Array:
        """(G,) the seals' friction, N."""
        return seal_force(self.law, self.drive)


def make_bench(law: FlowLaw, drive: Drive, *, index: int) -> Bench:
    """Return a record with the force of the device as `law` has it."""
    return Bench(law, drive, fluid_force(law, drive) + seal_force(law, drive), index)


def find_scales(benches: Sequence[Bench]) -> Scales:
    """Return the scales of a campaign."""
    squares = [bench.force[bench.lead :] ** 2 for bench in benches]
    points = [bench.drive.point for bench in benches]
    return Scales(
        displacement=max(float(np.max(np.abs(b.drive.position))) for b in benches),
        speed=max(float(np.max(np.abs(b.drive.velocity))) for b in benches),
        acceleration=max(float(np.max(np.abs(b.drive.acceleration))) for b in benches),
        force=max(float(np.max(np.abs(b.grid_force))) for b in benches),
        force_rms=math.sqrt(float(np.mean(np.concatenate(squares)))),
        low_frequency=min(p.frequency for p in points),
        high_frequency=max(p.top for p in points),
        duration=max(p.duration for p in points),
    )

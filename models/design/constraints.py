"""The design problem as numbers: objective and constraints of log dimensions, many at once.

A point is y = ln (r1, r2, r3, r4, h, b); the number of turns follows from the inertance b. Each
constraint is a ratio that must not exceed one, with the transitions' part moved to the bound's
side, so every ratio stays positive and smooth wherever the annulus is open. Apart from that part
all ratios are sums of products of powers (posynomials), convex in y: the problem is close to a
geometric program, where a local optimum is the global one.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from models.checks import Array, InputError
from models.design.problem import DesignBounds, Duty
from models.device import Device, Fluid
from models.flow import critical_frequency

VARIABLES = (
    "rod_radius", "cylinder_radius", "channel_radius", "helix_radius", "helix_pitch", "inertance"
)
"""Names of a point's six coordinates, in order."""


@dataclass(frozen=True)
class Bound:
    """One constraint by name."""

    name: str
    """What it bounds."""
    limit: float
    """Its value, SI."""
    unit: str
    """Its unit."""
    kind: str
    """"at most", "at least" or "geometry" (a body in another's way, no limit to move)."""
    field: str | None = None
    """The field of `DesignBounds` that holds it; None for geometry."""


@dataclass(frozen=True)
class Problem:
    """A duty, bounds and one fluid: what the search works on."""

    duty: Duty
    """The motion."""
    bounds: DesignBounds
    """What may not be exceeded."""
    fluid: Fluid
    """The fluid, fixed."""
    max_inertance_ratio: float = 4.0
    """Under "at-least": how far above the wanted inertance is searched."""

    @property
    def listed(self) -> tuple[Bound, ...]:
        """The constraints in the order of `ratios`."""
        b = self.bounds
        rows = [
            Bound("package radius", b.package_radius, "m", "at most", "package_radius"),
            Bound("package length", b.package_length, "m", "at most", "package_length"),
            Bound("turns", b.turns, "", "at least", "turns"),
            Bound("rod radius", b.rod_radius, "m", "at least", "rod_radius"),
            Bound("channel radius", b.channel_radius, "m", "at least", "channel_radius"),
            Bound("turns side by side", b.wall, "m", "geometry"),
            Bound("room for a piston", b.wall, "m", "geometry"),
        ]
        if b.cylinder_inside_helix:
            rows.append(Bound("cylinder inside helix", b.wall, "m", "geometry"))
        if b.damping is not None:
            rows.append(Bound("parasitic damping", b.damping, "N s/m", "at most", "damping"))
        if b.pressure is not None:
            rows.append(Bound("pressure", b.pressure, "Pa", "at most", "pressure"))
        return tuple(rows)

    def box(self) -> list[tuple[float, float]]:
        """Return the search box of y: no feasible point lies outside."""
        b = self.bounds
        top = b.inertance * (self.max_inertance_ratio if b.inertance_rule == "at-least" else 1.0)
        # A helix is wider than its channel, a turn higher than the channel is wide.
        lowest = (b.rod_radius, b.rod_radius, b.channel_radius, b.channel_radius,
                  2.0 * b.channel_radius, b.inertance)
        highest = (b.package_radius,) * 4 + (max(b.package_length, 2.0 * b.package_radius), top)
        pairs = zip(lowest, highest, strict=True)
        return [(math.log(low), math.log(max(low, high))) for low, high in pairs]

    def objective(self, y: Array) -> Array:
        """Return ln f_low (Eq. 16, the paper's convention) at points y of shape (6,) or (6, S)."""
        r1, r2, r3, r4 = np.exp(y[:4])
        annulus = np.maximum(r2**2 - r1**2, 1e-12 * r2**2)
        prefactor = 100.0 / (8.0 * math.sqrt(2.0) * math.pi * self.duty.amplitude)
        return np.asarray(
            np.log(prefactor * self.fluid.kinematic_viscosity * np.sqrt(r3 * r4) / annulus)
        )

    def ratios(self, y: Array) -> Array:
        """Return the constraints' ratios, each <= 1 where met, shape (C,) or (C, S)."""
        bounds, duty, fluid = self.bounds, self.duty, self.fluid
        r1, r2, r3, r4, h, b = np.exp(y)
        s1 = math.pi * np.maximum(r2**2 - r1**2, 1e-12 * r2**2)
        s2 = math.pi * r3**2
        slope = h / (2.0 * math.pi * r4)
        turn = np.hypot(h, 2.0 * math.pi * r4)
        ends = 2.0 * bounds.transition_length
        total = b * (1.0 + slope**2) * s2 / (fluid.density * s1**2)
        rows = [
            (r4 + r3 + bounds.wall) / bounds.package_radius,
            (total * h / turn + 2.0 * r3) / (bounds.package_length + ends * h / turn),
            (bounds.turns * turn + ends) / total,
            bounds.rod_radius / r1,
            bounds.channel_radius / r3,
            (2.0 * r3 + bounds.wall) / h,
            (r1 + bounds.wall) / r2,
        ]
        if bounds.cylinder_inside_helix:
            rows.append((r2 + r3 + bounds.wall) / r4)
        c1 = 0.75 * fluid.density * s1**3 / s2**2
        per_length = 8.0 * fluid.viscosity * s1**2 / (r3**2 * s2)
        if bounds.damping is not None:
            lost = per_length * total + 8.0 / (3.0 * math.pi) * c1 * duty.speed
            rows.append(lost / (bounds.damping + per_length * ends))
        if bounds.pressure is not None:
            force = b * duty.acceleration + per_length * total * duty.speed + c1 * duty.speed**2
            allowed = bounds.pressure * s1 + per_length * ends * duty.speed
            rows.append(force / allowed)
        stacked: Array = np.stack(np.broadcast_arrays(*rows))
        return stacked

    def moved(self, bound: Bound, factor: float) -> Problem:
        """Return the problem with one bound's limit multiplied by `factor`."""
        if bound.field is None:
            raise InputError(bound.name, expected="a bound with a limit", found="geometry")
        change: dict[str, Any] = {bound.field: bound.limit * factor}
        return replace(self, bounds=replace(self.bounds, **change))

    def device(self, y: Array, *, name: str = "designed") -> Device:
        """Return the device at a point (6,)."""
        r1, r2, r3, r4, h, b = (float(v) for v in np.exp(y))
        s1, s2 = math.pi * (r2**2 - r1**2), math.pi * r3**2
        slope = h / (2.0 * math.pi * r4)
        total = b * (1.0 + slope**2) * s2 / (self.fluid.density * s1**2)
        helix = total - 2.0 * self.bounds.transition_length
        return Device(
            rod_radius=r1,
            cylinder_radius=r2,
            channel_radius=r3,
            helix_radius=r4,
            # A pitch at its lower bound lies below it by round-off.
            helix_pitch=max(h, 2.0 * r3),
            turns=helix / math.hypot(h, 2.0 * math.pi * r4),
            fluid=self.fluid,
            transition_length=self.bounds.transition_length,
            name=name,
        )

    def point(self, device: Device) -> Array:
        """Return the coordinates y of a device, (6,)."""
        d = device
        values = (d.rod_radius, d.cylinder_radius, d.channel_radius, d.helix_radius,
                  d.helix_pitch, d.computed_inertance)
        return np.asarray(np.log(np.array(values)))

    def frequency(self, device: Device) -> float:
        """Return the critical frequency of a device at the duty's amplitude, Hz."""
        return float(critical_frequency(device, self.duty.amplitude))

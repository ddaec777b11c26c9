"""What a rough design found, as a frozen value with its document."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from models.design.prices import ActiveBound
from models.design.problem import DesignBounds, Duty, parasitic_damping, peak_pressure
from models.device import Device
from models.flow import critical_frequency, reynolds, transition_reynolds


@dataclass(frozen=True)
class DesignPoint:
    """A device with what the design judges it by.

    Examples
    --------
    >>> point = DesignPoint(Device.preset("device-12"), "own", Duty())
    >>> round(point.critical_frequency("paper"), 3), round(point.critical_frequency("standard"), 3)
    (0.664, 1.877)
    """

    device: Device
    """Geometry and fluid."""
    fluid_name: str
    """Which fluid of those offered."""
    duty: Duty
    """The motion it is judged at."""

    def critical_frequency(self, convention: str) -> float:
        """Return f at De = 100 and the duty's amplitude, Hz."""
        return float(critical_frequency(self.device, self.duty.amplitude, convention=convention))

    @property
    def damping(self) -> float:
        """Parasitic damping at the duty's peak speed, N s/m."""
        return parasitic_damping(self.device, self.duty)

    @property
    def inertial_corner(self) -> float:
        """Frequency above which inertia exceeds viscous damping, c2/(2 pi b), Hz.

        About 4 nu/(pi r3^2): it depends on fluid and channel alone, not on the piston that Eq. 16
        enlarges.
        """
        damping = self.device.laminar_coefficients.c2
        return damping / (2.0 * math.pi * self.device.inertance)

    @property
    def turbulent_at_duty(self) -> bool:
        """Whether the channel's peak Reynolds number passes the coil's transition (Schmidt)."""
        peak = float(reynolds(self.device, self.duty.speed, convention="standard"))
        return peak > transition_reynolds(self.device.curvature_ratio)

    def to_dict(self) -> dict[str, Any]:
        """Return geometry, fluid and judgements, SI."""
        d = self.device
        return {
            "geometry": {
                "rod_radius": d.rod_radius,
                "cylinder_radius": d.cylinder_radius,
                "channel_radius": d.channel_radius,
                "helix_radius": d.helix_radius,
                "helix_pitch": d.helix_pitch,
                "turns": d.turns,
                "transition_length": d.transition_length,
            },
            "fluid": {
                "name": self.fluid_name,
                "density": d.fluid.density,
                "viscosity": d.fluid.viscosity,
            },
            "critical_frequency_hz": {
                "paper": self.critical_frequency("paper"),
                "standard": self.critical_frequency("standard"),
            },
            "inertance": d.inertance,
            "inertance_source": d.inertance_source,
            "parasitic_damping": self.damping,
            "viscous_damping": d.laminar_coefficients.c2,
            "quadratic_damping": d.laminar_coefficients.c1,
            "inertial_corner_hz": self.inertial_corner,
            "peak_pressure": peak_pressure(d, self.duty),
            "channel_length": d.channel_length,
            "turbulent_at_duty": self.turbulent_at_duty,
        }


@dataclass(frozen=True)
class Conflict:
    """A bound that keeps every design out, and what would let one in."""

    name: str
    """What it bounds."""
    limit: float
    """Its value, SI."""
    unit: str
    """Its unit."""
    kind: str
    """"at most", "at least" or "geometry"."""
    needed: float | None
    """The value that admits a design with all other bounds kept; None where none does."""

    def to_dict(self) -> dict[str, Any]:
        """Return the entry of `conflicts` in ``design.json``."""
        return {
            "name": self.name,
            "limit": self.limit,
            "unit": self.unit,
            "kind": self.kind,
            "needed": self.needed,
        }


@dataclass(frozen=True)
class DesignResult:
    """The rough design: best point, trade-off front, prices; or why nothing fits."""

    baseline: DesignPoint
    """The device to improve on."""
    best: DesignPoint | None
    """The lowest critical frequency within the bounds; None where nothing fits."""
    duty: Duty
    """The motion."""
    bounds: DesignBounds
    """The bounds."""
    front: tuple[DesignPoint, ...]
    """Designs of which none is beaten in critical frequency, inertance and damping at once."""
    active: tuple[ActiveBound, ...]
    """Bounds that hold the best design, dearest first."""
    elasticities: dict[str, float]
    """d ln f_low / d ln dimension at the best design (at the baseline where nothing fits)."""
    conflicts: tuple[Conflict, ...]
    """Why nothing fits; empty where something does."""
    evaluations: int
    """Points at which the problem was evaluated."""
    agreeing: int
    """Independent local searches that ended at the best design."""
    starts: int
    """Independent local searches run."""
    global_gap: float | None
    """Relative excess of differential evolution's own best frequency; None where it had none."""

    @property
    def feasible(self) -> bool:
        """Whether any design meets the bounds."""
        return self.best is not None

    @property
    def improvement(self) -> float | None:
        """Baseline's critical frequency over the best design's; the same in both conventions."""
        if self.best is None:
            return None
        return self.baseline.critical_frequency("paper") / self.best.critical_frequency("paper")

    def to_dict(self) -> dict[str, Any]:
        """Return the document ``design.json`` without its header."""
        best = None if self.best is None else self.best.to_dict()
        empty = dict.fromkeys(self.baseline.to_dict())
        return {
            **(empty if best is None else best),
            "feasible": self.feasible,
            "improvement": self.improvement,
            "baseline": self.baseline.to_dict(),
            "front": [point.to_dict() for point in self.front],
            "active_bounds": [bound.to_dict() for bound in self.active],
            "conflicts": [conflict.to_dict() for conflict in self.conflicts],
            "elasticities": dict(self.elasticities),
            "duty": {"amplitude": self.duty.amplitude, "frequency_hz": self.duty.frequency},
            "bounds": {
                key: getattr(self.bounds, key) for key in DesignBounds.__dataclass_fields__
            },
            "search": {
                "evaluations": self.evaluations,
                "local_searches": self.starts,
                "agreeing": self.agreeing,
                "global_gap": self.global_gap,
            },
        }

"""The rough design's question: what may be chosen, within which bounds, for which duty."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

from models.checks import InputError, number, one_of
from models.device import Device, Fluid

# ISO 3448 fixes the kinematic viscosity of a grade at 40 degC (its midpoint); 860 kg/m^3 is usual.
_OIL = 860.0

FLUIDS: Mapping[str, Fluid] = MappingProxyType(
    {
        "water": Fluid(density=998.2, viscosity=1.002e-3),
        "oil-vg-2": Fluid(density=_OIL, viscosity=2.2e-6 * _OIL),
        "oil-vg-10": Fluid(density=_OIL, viscosity=10e-6 * _OIL),
        "oil-vg-22": Fluid(density=_OIL, viscosity=22e-6 * _OIL),
        "oil-vg-32": Fluid(density=_OIL, viscosity=32e-6 * _OIL),
        "oil-vg-46": Fluid(density=_OIL, viscosity=46e-6 * _OIL),
    }
)
"""Fluids to choose from by name: water at 20 degC, ISO viscosity grades (ISO 3448) at 40 degC."""


@dataclass(frozen=True)
class Duty:
    """The motion that the design is for: sets the critical frequency's amplitude and the loads.

    Examples
    --------
    >>> round(Duty(amplitude=0.005, frequency=12.0).speed, 3)
    0.377
    """

    amplitude: float = 0.005
    """Displacement amplitude [A0], m."""
    frequency: float = 10.0
    """Highest working frequency, Hz: damping and pressure are judged there."""

    def __post_init__(self) -> None:
        """Refuse a motion that isn't one."""
        number("amplitude", self.amplitude, above=0.0, where="duty")
        number("frequency", self.frequency, above=0.0, where="duty")

    @property
    def speed(self) -> float:
        """Peak piston speed, m/s."""
        return 2.0 * math.pi * self.frequency * self.amplitude

    @property
    def acceleration(self) -> float:
        """Peak piston acceleration, m/s^2."""
        return (2.0 * math.pi * self.frequency) ** 2 * self.amplitude


@dataclass(frozen=True)
class DesignBounds:
    """What a design may not exceed, SI; None where there is no such bound.

    Examples
    --------
    >>> bounds = DesignBounds.around(Device.preset("device-12"))
    >>> round(bounds.package_radius, 3), round(bounds.package_length, 3)
    (0.107, 0.178)
    """

    package_radius: float
    """Outer radius of the helix with its wall, m."""
    package_length: float
    """Height of the helix from the first turn's edge to the last one's, m."""
    inertance: float
    """Inertance wanted, kg."""
    rod_radius: float
    """Thinnest rod that carries the load, m."""
    inertance_rule: str = "equal"
    """"equal" or "at-least"."""
    damping: float | None = None
    """Largest parasitic damping at the duty's peak speed, N s/m: c2 + 8/(3 pi) c1 V (Eq. 5)."""
    pressure: float | None = None
    """Largest pressure difference over the piston at the duty, Pa."""
    channel_radius: float = 0.002
    """Narrowest channel that can be made and kept clean, m."""
    turns: float = 1.0
    """Fewest turns."""
    wall: float = 0.002
    """Thickness of a wall: between turns, around the helix, around the cylinder, m."""
    transition_length: float = 0.0
    """Length of each straight transition section [l0], not designed, m."""
    cylinder_inside_helix: bool = True
    """The cylinder stands inside the helix, as in both tested devices."""

    def __post_init__(self) -> None:
        """Refuse bounds that aren't numbers above zero."""
        where = "bounds"
        one_of("inertance_rule", self.inertance_rule, ("equal", "at-least"), where=where)
        for key in (
            "package_radius", "package_length", "inertance", "rod_radius", "channel_radius", "turns"
        ):
            number(key, getattr(self, key), above=0.0, where=where)
        for key in ("wall", "transition_length"):
            number(key, getattr(self, key), at_least=0.0, where=where)
        for key in ("damping", "pressure"):
            if getattr(self, key) is not None:
                number(key, getattr(self, key), above=0.0, where=where)
        room = self.package_radius - self.rod_radius
        if room <= 0.0:
            raise InputError(
                "rod_radius",
                expected=f"below the package_radius ({self.package_radius} m)",
                found=f"{self.rod_radius} m",
                where=where,
            )

    @classmethod
    def around(
        cls,
        device: Device,
        *,
        duty: Duty | None = None,
        damping_ratio: float | None = 2.0,
        inertance_rule: str = "equal",
        pressure: float | None = None,
    ) -> DesignBounds:
        """Return the bounds that keep a device's package, inertance, rod and walls.

        Parameters
        ----------
        device : Device
            The device to improve on.
        duty : Duty, optional
            Where damping is compared.
        damping_ratio : float or None
            Largest parasitic damping over the device's own; None for no bound.
        inertance_rule : str
            "equal" or "at-least" the device's inertance.
        pressure : float, optional
            Largest pressure difference, Pa.
        """
        damping = None
        if damping_ratio is not None:
            number("damping_ratio", damping_ratio, above=0.0, where="bounds")
            damping = damping_ratio * parasitic_damping(device, duty or Duty())
        wall = device.helix_pitch - 2.0 * device.channel_radius
        return cls(
            package_radius=device.helix_radius + device.channel_radius + wall,
            package_length=device.turns * device.helix_pitch + 2.0 * device.channel_radius,
            inertance=device.inertance,
            inertance_rule=inertance_rule,
            damping=damping,
            pressure=pressure,
            rod_radius=device.rod_radius,
            channel_radius=min(0.002, device.channel_radius),
            turns=min(1.0, device.turns),
            wall=wall,
            transition_length=device.transition_length,
            cylinder_inside_helix=(
                device.cylinder_radius + device.channel_radius + wall <= device.helix_radius
            ),
        )


def parasitic_damping(device: Device, duty: Duty) -> float:
    """Return c2 + 8/(3 pi) c1 V of Eq. 5, N s/m: equal energy lost in a cycle at peak speed V.

    Parameters
    ----------
    device : Device
        Geometry and fluid.
    duty : Duty
        The motion.

    Returns
    -------
    float
        N s/m.

    Examples
    --------
    >>> round(parasitic_damping(Device.preset("device-12"), Duty(frequency=12.0)))
    4166
    """
    c1, c2 = device.laminar_coefficients
    return c2 + 8.0 / (3.0 * math.pi) * c1 * duty.speed


def peak_pressure(device: Device, duty: Duty) -> float:
    """Return the pressure difference over the piston, Pa, at most (inertia and loss added).

    Parameters
    ----------
    device : Device
        Geometry and fluid.
    duty : Duty
        The motion.

    Returns
    -------
    float
        Pa.

    Examples
    --------
    >>> round(peak_pressure(Device.preset("device-12"), Duty(frequency=12.0)) / 1e5, 1)
    60.3
    """
    c1, c2 = device.laminar_coefficients
    speed = duty.speed
    force = device.inertance * duty.acceleration + c2 * speed + c1 * speed**2
    return force / device.annulus_area

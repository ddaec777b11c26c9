"""The fluid inerter: a piston that drives oil through a helical channel.

Symbols in brackets are those of Chen & Chen, *Materials* 2025, 18(11), 2556 (equation numbers too).
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field, replace
from typing import Any, NamedTuple

from models.checks import InputError, number, one_of, shown, stored_number


@dataclass(frozen=True)
class Fluid:
    """A Newtonian fluid.

    Examples
    --------
    >>> Fluid(density=800.0, viscosity=0.027).kinematic_viscosity
    3.375e-05
    """

    density: float
    """Density [rho], kg/m^3."""
    viscosity: float
    """Dynamic viscosity [mu], Pa s."""

    def __post_init__(self) -> None:
        """Refuse what no fluid can be."""
        number("density", self.density, above=0.0, where="fluid")
        number("viscosity", self.viscosity, above=0.0, where="fluid")

    @property
    def kinematic_viscosity(self) -> float:
        """Viscosity over density, m^2/s."""
        return self.viscosity / self.density


class LaminarCoefficients(NamedTuple):
    """Damping of the laminar integer-order model (Eq. 5)."""

    c1: float
    """Of v|v|, N s^2/m^2: entrance and exit losses."""
    c2: float
    """Of v, N s/m: Poiseuille flow in the channel."""


class TurbulentCoefficients(NamedTuple):
    """Damping of the turbulent integer-order model (Eq. 6)."""

    c1: float
    """Of |v|^1.75 sign(v), N (s/m)^1.75: Blasius friction in the channel."""
    c2: float
    """Of v|v|, N s^2/m^2: entrance and exit losses."""
    c3: float | None
    """Of v, N s/m: the film between piston and cylinder; None where no clearance is known."""


@dataclass(frozen=True)
class Device:
    """Geometry and fluid of a helical-channel fluid inerter, all SI.

    Raises
    ------
    InputError
        Where the geometry can't be built: a rod wider than its cylinder, a pitch under the
        channel's diameter, a channel wider than its helix, a clearance wider than the annulus.

    Examples
    --------
    >>> device = Device.preset("device-12")
    >>> round(device.inertance, 2), device.inertance_source
    (370.38, 'computed')
    """

    rod_radius: float
    """Radius of the piston rod [r1], m."""
    cylinder_radius: float
    """Inner radius [r2], m."""
    channel_radius: float
    """Inner radius of the helical channel [r3], m."""
    helix_radius: float
    """Radius of the helix's centre line [r4], m."""
    helix_pitch: float
    """Advance of the helix in one turn [h], m."""
    turns: float
    """Number of turns [n_t]."""
    fluid: Fluid
    """The fluid in it."""
    transition_length: float = field(default=0.0, kw_only=True)
    """Length of the straight transition section [l0], one at each end, m."""
    piston_clearance: float | None = field(default=None, kw_only=True)
    """Radial gap between piston and cylinder [delta r], m; None where not known."""
    measured_inertance: float | None = field(default=None, kw_only=True)
    """Inertance from a test [b], kg: replaces the computed one; None where there is none."""
    coulomb_friction: float | None = field(default=None, kw_only=True)
    """Measured dry friction [f0], N; None where not known."""
    name: str = field(default="", kw_only=True)
    """What the device is called in reports."""

    def __post_init__(self) -> None:
        """Refuse geometry that can't be built."""
        where = self.name or "device"
        for key in ("rod_radius", "cylinder_radius", "channel_radius", "helix_radius", "turns"):
            number(key, getattr(self, key), above=0.0, where=where)
        number("helix_pitch", self.helix_pitch, above=0.0, where=where)
        number("transition_length", self.transition_length, at_least=0.0, where=where)
        for inner, outer in (("rod_radius", "cylinder_radius"), ("channel_radius", "helix_radius")):
            radius, limit = getattr(self, inner), getattr(self, outer)
            if not radius < limit:
                raise InputError(
                    inner,
                    expected=f"below the {outer} ({limit} m)",
                    found=f"{radius} m",
                    where=where,
                )
        # Relative tolerance: a pitch of exactly one diameter (turns touching) survives conversion.
        if self.turns > 1.0 and self.helix_pitch < 2.0 * self.channel_radius * (1.0 - 1e-9):
            raise InputError(
                "helix_pitch",
                expected=f"at least the channel's diameter ({2.0 * self.channel_radius} m)",
                found=f"{self.helix_pitch} m",
                where=where,
            )
        if self.piston_clearance is not None:
            number("piston_clearance", self.piston_clearance, above=0.0, where=where)
            annulus = self.cylinder_radius - self.rod_radius
            if not self.piston_clearance < annulus:
                raise InputError(
                    "piston_clearance",
                    expected=f"below the gap between rod and cylinder ({annulus:.6g} m)",
                    found=f"{self.piston_clearance} m",
                    where=where,
                )
        if self.measured_inertance is not None:
            number("inertance", self.measured_inertance, above=0.0, where=where)
        if self.coulomb_friction is not None:
            number("coulomb_friction", self.coulomb_friction, at_least=0.0, where=where)

    @staticmethod
    def preset(name: str) -> Device:
        """Return one of the paper's two tested devices (Table 1).

        Parameters
        ----------
        name : str
            "device-12" or "device-10": the paper's reference numbers.

        Notes
        -----
        Device 10: the clearance is printed as 0.1 m, of which only 0.1 mm is possible; the quoted
        inertance 73.82 kg doesn't follow from the geometry (67.93 kg) and stands as measured.

        Examples
        --------
        >>> round(Device.preset("device-10").computed_inertance, 2)
        67.93
        """
        return PRESETS[one_of("preset", name, PRESETS, where="device")]

    @property
    def annulus_area(self) -> float:
        """Effective piston area [S1 = pi (r2^2 - r1^2)], m^2."""
        return math.pi * (self.cylinder_radius**2 - self.rod_radius**2)

    @property
    def channel_area(self) -> float:
        """Cross-section of the channel [S2 = pi r3^2], m^2."""
        return math.pi * self.channel_radius**2

    @property
    def area_ratio(self) -> float:
        """Mean speed in the channel over the piston's speed [S1/S2]."""
        return self.annulus_area / self.channel_area

    @property
    def channel_length(self) -> float:
        """Length of the helix [l = n_t sqrt(h^2 + (2 pi r4)^2)], without transitions, m."""
        return self.turns * math.hypot(self.helix_pitch, 2.0 * math.pi * self.helix_radius)

    @property
    def total_length(self) -> float:
        """Length of the channel with both transition sections [l + 2 l0], m."""
        return self.channel_length + 2.0 * self.transition_length

    @property
    def piston_film_length(self) -> float:
        """Length of the film between piston and cylinder [L = 2 n_t r3], m."""
        return 2.0 * self.turns * self.channel_radius

    @property
    def curvature_ratio(self) -> float:
        """Channel radius over helix radius [r3/r4]."""
        return self.channel_radius / self.helix_radius

    @property
    def fluid_mass(self) -> float:
        """Mass of the fluid in channel and transitions [m = rho (l + 2 l0) S2], kg."""
        return self.fluid.density * self.total_length * self.channel_area

    @property
    def computed_inertance(self) -> float:
        """Inertance from geometry [b = m/(1 + (h/2 pi r4)^2) (S1/S2)^2], kg."""
        slope = self.helix_pitch / (2.0 * math.pi * self.helix_radius)
        return self.fluid_mass / (1.0 + slope**2) * self.area_ratio**2

    @property
    def inertance(self) -> float:
        """The measured inertance where there is one, else the computed one [b], kg."""
        return (
            self.computed_inertance if self.measured_inertance is None else self.measured_inertance
        )

    @property
    def inertance_source(self) -> str:
        """Where `inertance` comes from: "measured" or "computed"."""
        return "computed" if self.measured_inertance is None else "measured"

    @property
    def laminar_coefficients(self) -> LaminarCoefficients:
        """Damping of Eq. 5: c1 = 3 rho S1^3/(4 S2^2), c2 = 8 mu l S1^2/(r3^2 S2).

        The length in c2 is the helix alone, without transition sections: the paper's Table 3 fits
        only so.
        """
        s1, s2 = self.annulus_area, self.channel_area
        c2 = 8.0 * self.fluid.viscosity * self.channel_length * s1**2
        c2 /= self.channel_radius**2 * s2
        return LaminarCoefficients(c1=0.75 * self.fluid.density * s1**3 / s2**2, c2=c2)

    @property
    def turbulent_coefficients(self) -> TurbulentCoefficients:
        """Damping of Eq. 6.

        c1 = 0.0664 mu^0.25 rho^0.75 l S1 r3^-1.25 (S1/S2)^1.75, c2 = 3 rho S1^3/(4 S2^2),
        c3 = 2 pi mu r2 L/delta r (None without a clearance).
        """
        rho, mu = self.fluid.density, self.fluid.viscosity
        s1, s2 = self.annulus_area, self.channel_area
        c1 = 0.0664 * mu**0.25 * rho**0.75 * self.channel_length * s1
        c1 *= self.channel_radius**-1.25 * (s1 / s2) ** 1.75
        film = None
        if self.piston_clearance is not None:
            film = 2.0 * math.pi * mu * self.cylinder_radius * self.piston_film_length
            film /= self.piston_clearance
        return TurbulentCoefficients(c1=c1, c2=0.75 * rho * s1**3 / s2**2, c3=film)

    def to_dict(self) -> dict[str, Any]:
        """Return the `[device]` table of a campaign, numbers in SI; `from_dict` reads it back."""
        table = asdict(self)
        table["inertance"] = table.pop("measured_inertance")
        return table

    @classmethod
    def from_dict(cls, table: Mapping[str, Any], *, where: str = "device") -> Device:
        """Build a device from a `[device]` table whose values are numbers in SI.

        Parameters
        ----------
        table : mapping
            The fields by name, `inertance` for a measured one, `fluid` a table of its own; or
            `preset`, with any fields beside it replacing the preset's.
        where : str
            What an error names as the place.

        Raises
        ------
        InputError
            Where a key is unknown or missing, or a value impossible.

        Examples
        --------
        >>> Device.from_dict({"preset": "device-12", "inertance": 380.0}).inertance_source
        'measured'
        """
        if not isinstance(table, Mapping):
            raise InputError("device", expected="a table", found=shown(table), where=where)
        values = {key: value for key, value in table.items() if key != "preset"}
        if "inertance" in values:
            values["measured_inertance"] = values.pop("inertance")
        known = set(cls.__dataclass_fields__)
        for key in values:
            if key not in known:
                listed = ", ".join(sorted(known - {"measured_inertance"} | {"inertance", "preset"}))
                raise InputError(key, expected=f"one of {listed}", found="unknown key", where=where)
        preset = table.get("preset")
        for key, text in (("preset", preset), ("name", values.get("name", ""))):
            if text is not None and not isinstance(text, str):
                raise InputError(key, expected="text", found=shown(text), where=where)
        base = cls.preset(preset) if preset is not None else None
        if "fluid" in values and not isinstance(values["fluid"], Fluid):
            values["fluid"] = _fluid(values["fluid"], base, where=where)
        for key, value in values.items():
            if key not in ("fluid", "name") and value is not None:
                values[key] = stored_number(key, value, where=where)
        if base is not None:
            return replace(base, **values)
        required = ("rod_radius", "cylinder_radius", "channel_radius", "helix_radius")
        for key in (*required, "helix_pitch", "turns", "fluid"):
            if values.get(key) is None:
                raise InputError(key, expected="given", found="nothing", where=where)
        return cls(**values)


def _fluid(table: object, base: Device | None, *, where: str) -> Fluid:
    """Return the fluid of a `[device.fluid]` table, gaps filled from the preset's."""
    if not isinstance(table, Mapping):
        raise InputError("fluid", expected="a table", found=shown(table), where=where)
    merged = {} if base is None else asdict(base.fluid)
    for key, value in table.items():
        one_of("key", key, ("density", "viscosity"), where=f"{where}.fluid")
        place = f"{where}.fluid"
        merged[key] = number(key, stored_number(key, value, where=place), above=0.0, where=place)
    for key in ("density", "viscosity"):
        if key not in merged:
            raise InputError(key, expected="given", found="nothing", where=f"{where}.fluid")
    return Fluid(**merged)


PRESETS: Mapping[str, Device] = {
    "device-12": Device(
        rod_radius=0.012,
        cylinder_radius=0.028,
        channel_radius=0.005,
        helix_radius=0.1,
        helix_pitch=0.012,
        turns=14,
        fluid=Fluid(density=800.0, viscosity=0.027),
        transition_length=0.1,
        coulomb_friction=400.0,
        name="device-12",
    ),
    "device-10": Device(
        rod_radius=0.014,
        cylinder_radius=0.025,
        channel_radius=0.006,
        helix_radius=0.12,
        helix_pitch=0.03,
        turns=7,
        fluid=Fluid(density=802.0, viscosity=0.00168),
        piston_clearance=1e-4,
        measured_inertance=73.82,
        coulomb_friction=550.0,
        name="device-10",
    ),
}

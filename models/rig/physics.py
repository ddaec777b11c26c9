"""The device's force from its flow: what is simulated, and how each part can be switched."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy import fft

from models.checks import Array, number, one_of
from models.device import Device
from models.flow import channel_force, channel_impedance, reynolds
from models.rig.drive import Drive
from models.rig.seal import Seal, draw_seal, presliding_friction, smooth_friction

# Entrance (sharp) and exit loss of the channel, and the growth of the entrance's at low Re
# (W. B. Hooper, Chem. Eng., 24 August 1981, 96-100).
_ENTRANCE, _EXIT, _CREEP_LOSS = 0.57, 1.0, 160.0
_TEXTBOOK_LOSS = 1.5
_TABLE = 4097


@dataclass(frozen=True)
class RigPhysics:
    """Which parts of the physics the rig simulates.

    Examples
    --------
    >>> RigPhysics.simple().wall
    False
    """

    friction: str = "correlations"
    """Channel friction: "correlations" (coil, laminar to turbulent) or "laminar" (Poiseuille)."""
    losses: str = "two-k"
    """Entrance and exit: "two-k" (grow at low Re), "textbook" (1.5 velocity heads) or "none"."""
    wall: bool = True
    """The wall layer of oscillating flow: the Bessel impedance above steady flow and plug."""
    seal: str = "dynamic"
    """Dry friction: "dynamic" (presliding, Stribeck), "coulomb-smooth" or "none"."""
    compressibility: bool = True
    """Oil that yields under pressure."""
    distortion: float = 0.005
    """Second harmonic of the actuator's displacement, about."""
    dry_friction: float | None = None
    """Sliding friction, N; None takes the device's, or none where it has no value."""
    seal_values: Seal | None = None
    """The seals' other properties, their `sliding` replaced; None draws them for the device."""
    bulk_modulus: float = 1.4e9
    """Of the oil, Pa."""
    chamber_length: float = 0.05
    """Length of the oil column on each side of the piston in the middle, m."""

    def __post_init__(self) -> None:
        """Refuse unknown parts."""
        one_of("friction", self.friction, ("correlations", "laminar"), where="rig physics")
        one_of("losses", self.losses, ("two-k", "textbook", "none"), where="rig physics")
        one_of("seal", self.seal, ("dynamic", "coulomb-smooth", "none"), where="rig physics")
        number("distortion", self.distortion, at_least=0.0, below=0.5, where="rig physics")
        number("bulk_modulus", self.bulk_modulus, above=0.0, where="rig physics")
        number("chamber_length", self.chamber_length, above=0.0, where="rig physics")
        if self.dry_friction is not None:
            number("dry_friction", self.dry_friction, at_least=0.0, where="rig physics")

    @classmethod
    def simple(cls, *, seal: str = "coulomb-smooth", distortion: float = 0.005) -> RigPhysics:
        """Return the physics in which Eq. 5 of the paper is near exact: laminar, no memory."""
        return cls(
            friction="laminar",
            losses="textbook",
            wall=False,
            seal=seal,
            compressibility=False,
            distortion=distortion,
        )


@dataclass(frozen=True)
class FlowLaw:
    """Everything that the force of a device needs, tabulated once for a campaign."""

    device: Device
    """Geometry and fluid."""
    physics: RigPhysics
    """What is simulated."""
    top: float
    """Highest speed of the table, m/s."""
    table: Array
    """(T,) steady drag at speeds from 0 to `top`, N."""

    @cached_property
    def seal(self) -> Seal:
        """The seals with the friction that holds for this device."""
        known = self.device.coulomb_friction or 0.0
        given = self.physics.dry_friction
        sliding = 0.0 if self.physics.seal == "none" else known if given is None else given
        values = self.physics.seal_values
        return replace(draw_seal(self.device) if values is None else values, sliding=sliding)

    @property
    def oil_stiffness(self) -> float:
        """Stiffness of the oil columns under the piston, 2 K S1/L, N/m."""
        physics = self.physics
        return 2.0 * physics.bulk_modulus * self.device.annulus_area / physics.chamber_length

    def drag(self, velocity: Array) -> Array:
        """Return the steady drag of channel and ports at velocities (G,), N."""
        speeds = np.linspace(0.0, self.top, self.table.size)
        return np.asarray(np.copysign(np.interp(np.abs(velocity), speeds, self.table), velocity))

    def slopes(self) -> tuple[float, float]:
        """Return the least and greatest slope of the drag, N s/m."""
        slopes = np.diff(self.table) / (self.top / (self.table.size - 1))
        return float(slopes.min()), float(slopes.max())

    def wall(self, omega: Array) -> NDArray[np.complex128]:
        """Return the wall layer's impedance at angular frequencies, N s/m; zero where off."""
        if not self.physics.wall:
            return np.zeros(omega.shape, dtype=np.complex128)
        return channel_impedance(self.device, omega, part="wall")


def flow_law(device: Device, physics: RigPhysics, *, top: float) -> FlowLaw:
    """Tabulate the steady drag of a device up to the speed `top`, m/s."""
    speed = np.linspace(0.0, number("top", top, above=0.0), _TABLE)
    if physics.friction == "laminar":
        mean = speed * device.area_ratio
        gradient = 32.0 * device.fluid.viscosity * mean / (2.0 * device.channel_radius) ** 2
        drag = device.annulus_area * device.channel_length * gradient
    else:
        drag = channel_force(device, speed)
        film = device.turbulent_coefficients.c3
        drag = drag + (0.0 if film is None else film) * speed
    head = 0.5 * device.fluid.density * device.area_ratio**2 * device.annulus_area
    if physics.losses == "textbook":
        drag = drag + _TEXTBOOK_LOSS * head * speed**2
    elif physics.losses == "two-k":
        # K1/Re times the head is linear in speed: finite at rest.
        per_speed = float(reynolds(device, 1.0, convention="standard"))
        drag = drag + head * speed * (_CREEP_LOSS / per_speed + (_ENTRANCE + _EXIT) * speed)
    return FlowLaw(device, physics, float(top), np.asarray(drag))


def fluid_force(law: FlowLaw, drive: Drive) -> Array:
    """Return the force (G,) of inertia, drag, wall layer and oil on the drive's grid, N."""
    velocity = drive.velocity
    if law.physics.compressibility:
        velocity = flow_velocity(law, drive)
    spectrum = np.asarray(fft.rfft(velocity))
    omega = drive.omega
    linear = spectrum * (1j * omega * law.device.inertance + law.wall(omega))
    return np.asarray(fft.irfft(linear, n=velocity.size)) + law.drag(velocity)


def seal_force(law: FlowLaw, drive: Drive) -> Array:
    """Return the seals' friction (G,) on the drive's grid, N."""
    if law.physics.seal == "dynamic":
        return presliding_friction(
            drive.position, drive.velocity, seal=law.seal, passes=drive.passes
        )
    return smooth_friction(law.seal, drive.velocity)


def flow_velocity(
    law: FlowLaw, drive: Drive, *, tolerance: float = 1e-9, iterations: int = 500
) -> Array:
    """Return the piston's velocity less what the oil yields (G,), m/s, by harmonic balance.

    Solves (i w b + W + k/(i w)) V_q + FFT(R(v_q)) = k/(i w) V for v_q. The drag R is split into the
    mean of its extreme slopes and a rest, so each sweep shrinks the error at least by the rest's
    slope over |i w b + W + k/(i w) + mean|, which is below one as Re W >= 0.
    """
    low, high = law.slopes()
    mean = 0.5 * (low + high)
    omega = drive.omega
    rate = np.where(omega > 0.0, 1j * omega, 1.0)
    yielding = law.oil_stiffness / rate
    left = rate * law.device.inertance + law.wall(omega) + yielding + mean
    command = np.asarray(fft.rfft(drive.velocity))
    size = drive.velocity.size
    velocity = drive.velocity
    scale = tolerance * math.sqrt(float(np.mean(velocity**2)))
    for _ in range(iterations):
        rest = np.asarray(fft.rfft(law.drag(velocity) - mean * velocity))
        spectrum = (yielding * command - rest) / left
        spectrum[0] = 0.0
        update = np.asarray(fft.irfft(spectrum, n=size))
        change = math.sqrt(float(np.mean((update - velocity) ** 2)))
        velocity = update
        if change <= scale:
            break
    return velocity

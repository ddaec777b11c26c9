"""Devices as harmonic balance sees them: a linear part, forces of the moment, and friction."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from models.checks import Array, InputError
from models.constitutive import WHOLE_ORDERS, FittedTerm, ForceModel
from models.motion import Motion
from models.structure import Structure

_OF_THE_MOMENT = frozenset(
    {
        "quadratic-damping",
        "power-law-damping",
        "asymmetric-damping",
        "cubic-stiffness",
        "end-stop",
        "force-offset",
    }
)
_MEASURING_CHAIN = frozenset({"time-delay", "sensor-gain", "sensor-drift", "sensor-clipping"})
_RELATIVE_STEP = 1e-6  # of central differences: their error is its square


@dataclass(frozen=True)
class DeviceForces:
    """One device's force law, sorted by how it is treated."""

    linear: tuple[tuple[float, float], ...]
    """(order, coefficient) of the terms exact per harmonic."""
    bent: tuple[FittedTerm, ...]
    """Terms that depend on displacement and velocity of the moment."""
    friction: float
    """N, Coulomb friction that jumps with the sign of the velocity."""
    stribeck: tuple[tuple[float, float], ...]
    """(N, m/s) of friction that falls with speed."""

    @property
    def rubs(self) -> bool:
        """True where the device can stick."""
        return self.friction > 0.0 or bool(self.stribeck)

    def scaled_friction(self, factor: float) -> DeviceForces:
        """Return the law with its friction multiplied by `factor`."""
        stribeck = tuple((factor * force, speed) for force, speed in self.stribeck)
        return replace(self, friction=factor * self.friction, stribeck=stribeck)

    def limit(self, speed: Array) -> tuple[Array, Array]:
        """Return sliding friction at `speed` (N,) and its slope by speed, N and N s/m."""
        level, slope = np.full_like(speed, self.friction), np.zeros_like(speed)
        for force, scale in self.stribeck:
            part = force * np.exp(-((speed / scale) ** 2))
            level += part
            slope -= 2.0 * part * speed / scale**2
        return level, slope

    def force(self, displacement: Array, velocity: Array) -> Array:
        """Return the force of the bent terms, (N,) N."""
        motion = _moment(displacement, velocity)
        total = np.zeros_like(displacement)
        for fitted in self.bent:
            if fitted.term.column is not None:
                total += fitted.coefficient * fitted.term.column(motion, fitted.shape)
        return total

    def slopes(self, displacement: Array, velocity: Array) -> tuple[Array, Array]:
        """Return the force's derivatives by displacement and velocity, (N,) each."""
        if not self.bent:
            return np.zeros_like(displacement), np.zeros_like(displacement)
        dx = _RELATIVE_STEP * float(np.abs(displacement).max()) or _RELATIVE_STEP
        dv = _RELATIVE_STEP * float(np.abs(velocity).max()) or _RELATIVE_STEP
        by_x = self.force(displacement + dx, velocity) - self.force(displacement - dx, velocity)
        by_v = self.force(displacement, velocity + dv) - self.force(displacement, velocity - dv)
        return by_x / (2.0 * dx), by_v / (2.0 * dv)


def _moment(displacement: Array, velocity: Array) -> Motion:
    """Return samples as a motion, of which terms of the moment read two columns only."""
    zeros = np.zeros_like(displacement)

    def differentiate(orders: Array) -> Array:
        raise InputError("term of the moment", expected="without memory", found=f"order {orders}")

    return Motion(np.arange(zeros.size, dtype=np.float64), displacement, velocity, zeros,
                  differentiate, "moment")  # fmt: skip


def sort_forces(structure: Structure) -> tuple[DeviceForces, ...]:
    """Return the devices' laws.

    Raises
    ------
    InputError
        For segmented models (take one band's model) and terms that have a memory of their own.
    """
    return tuple(_sort(mount.model) for mount in structure.devices)


def _sort(model: object) -> DeviceForces:
    if not isinstance(model, ForceModel):
        raise InputError(
            "model for harmonic balance",
            expected="of one band (take `model.at(coordinate)`)",
            found="a segmented model",
        )
    linear, bent, stribeck, friction = [], [], [], 0.0
    for fitted in model.terms:
        order = fitted.shape.get("order", WHOLE_ORDERS.get(fitted.id))
        smooth = fitted.shape.get("transition_speed", 0.0) > 0.0
        if fitted.id in _MEASURING_CHAIN:
            continue  # it moves nothing
        if order is not None:
            linear.append((order, fitted.coefficient))
        elif fitted.id in _OF_THE_MOMENT or (fitted.id == "coulomb-friction" and smooth):
            bent.append(fitted)
        elif fitted.id == "coulomb-friction":
            friction += fitted.coefficient
        elif fitted.id == "stribeck-friction" and not smooth and not fitted.shape.get("form"):
            stribeck.append((fitted.coefficient, fitted.shape["stribeck_velocity"]))
        else:
            raise InputError(
                f"term {fitted.id!r}",
                expected="one that harmonic balance knows",
                found="no rule for it",
            )
    return DeviceForces(tuple(linear), tuple(bent), friction, tuple(stribeck))

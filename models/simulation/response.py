"""What a simulation returns: the motion, the devices' forces, the error and the energy balance."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from models.checks import Array, InputError, number


@dataclass(frozen=True)
class PeriodicPast:
    """A steady state that the structure has been in before t = 0, instead of rest.

    The displacement is Re sum_k c_k exp(i 2 pi k f t). The fractional derivative is then the one
    from minus infinity (Weyl), so a simulation goes on in the steady state without a transient.
    """

    coefficients: NDArray[np.complex128]
    """(H + 1, n) m: mean and harmonics of each degree of freedom."""
    frequency: float
    """Fundamental, Hz."""

    def __post_init__(self) -> None:
        """Check the shape."""
        values = np.asarray(self.coefficients, dtype=np.complex128)
        if values.ndim != 2 or not np.isfinite(values).all():
            raise InputError(
                "coefficients of the past",
                expected="finite, (harmonics + 1, degrees of freedom)",
                found=f"shape {values.shape}",
            )
        object.__setattr__(self, "coefficients", values)
        number("frequency", self.frequency, above=0.0)

    @property
    def rates(self) -> Array:
        """(H + 1,) rad/s."""
        harmonics = np.arange(self.coefficients.shape[0], dtype=np.float64)
        return np.asarray(2.0 * np.pi * self.frequency * harmonics, dtype=np.float64)

    def displacement(self, time: ArrayLike) -> Array:
        """Return x at `time` (N,), (N, n) m."""
        return self._derivative_at(time, np.zeros(1))

    def velocity(self, time: ArrayLike) -> Array:
        """Return v at `time` (N,), (N, n) m/s."""
        return self._derivative_at(time, np.ones(1))

    def _derivative_at(self, time: ArrayLike, order: Array) -> Array:
        turn = np.exp(1j * np.outer(np.atleast_1d(time), self.rates))
        return np.asarray((turn * (1j * self.rates) ** order @ self.coefficients).real)


@dataclass(frozen=True)
class EnergyBalance:
    """Energies from start to end of a simulation, J. Works are those that the forces absorb."""

    input: float
    """Work of the load."""
    initial: float
    """Kinetic and potential energy at the start."""
    kinetic: float
    """At the end, inertance included."""
    potential: float
    """At the end, the devices' springs included."""
    viscous: float
    """Absorbed by linear damping."""
    fractional: float
    """Absorbed by terms with memory, which store energy as well as lose it."""
    curved: float
    """Absorbed by damping that is not linear in speed."""
    friction: float
    """Absorbed by Coulomb and Stribeck friction."""
    switching: float
    """Brought in where a segmented model changed its band."""
    turnover: float
    """Sum of the magnitudes that are balanced: the scale of `residual`."""

    @property
    def residual(self) -> float:
        """What is missing from the balance, relative to the turnover."""
        spent = self.viscous + self.fractional + self.curved + self.friction
        stored = self.kinetic + self.potential
        gap = self.initial + self.input + self.switching - stored - spent
        return gap / self.turnover if self.turnover > 0.0 else 0.0

    def to_dict(self) -> dict[str, float]:
        """Return all energies and the residual."""
        return {**self.__dict__, "residual": self.residual}


@dataclass(frozen=True)
class ErrorEstimate:
    """Difference to the same simulation at half the step, scaled to an error of the result."""

    displacement: Array
    """(n,) m, largest over time."""
    velocity: Array
    """(n,) m/s, largest over time."""
    relative: float
    """Largest displacement error over the largest displacement."""

    def to_dict(self) -> dict[str, Any]:
        """Return plain lists."""
        return {
            "displacement": self.displacement.tolist(),
            "velocity": self.velocity.tolist(),
            "relative": self.relative,
        }


@dataclass(frozen=True)
class Response:
    """Motion of a structure in time, with the devices' forces."""

    time: Array
    """(N,) s."""
    displacement: Array
    """(N, n) m; relative to the base under base acceleration."""
    velocity: Array
    """(N, n) m/s."""
    device_force: Array
    """(N, q) N, positive in extension."""
    step: float
    """s, of the integration."""
    operator: str
    """"caputo" from rest, "weyl" after a periodic past."""
    energy: EnergyBalance
    """At the end."""
    error: ErrorEstimate | None
    """None where the estimate was not asked for."""
    extrapolated: bool
    """True after Richardson extrapolation."""
    switches: int
    """How often a segmented model changed its band."""
    left_out: tuple[str, ...]
    """Ids of the models' measuring-chain effects: they move nothing."""

    @property
    def acceleration(self) -> Array:
        """(N, n) m/s^2, by second-order differences of the velocity that is kept."""
        return np.asarray(np.gradient(self.velocity, self.time, axis=0, edge_order=2))

    def to_dict(self) -> dict[str, Any]:
        """Return what documents carry: everything but the histories."""
        return {
            "step": self.step,
            "duration": float(self.time[-1]),
            "operator": self.operator,
            "energy": self.energy.to_dict(),
            "error": None if self.error is None else self.error.to_dict(),
            "extrapolated": self.extrapolated,
            "switches": self.switches,
            "left_out": list(self.left_out),
        }

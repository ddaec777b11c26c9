"""The discretised problem: harmonics and samples of one cycle, and the linear part.

A cycle has N = 2 H + 1 samples. Linear and fractional terms are exact per harmonic; the others are
evaluated at the samples and carried over by the discrete Fourier transform.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from models.checks import Array, InputError, number
from models.harmonic_balance.forces import DeviceForces, sort_forces
from models.structure import Structure

_CREEP = 1e-12
BLUNT = 0.4
SHARP = (0.6, 0.8, 0.95)


@dataclass(frozen=True)
class SineDrive:
    """Load amplitude * sin(omega t) on a degree of freedom, or as the base's acceleration."""

    amplitude: float
    """N, or m/s^2."""
    acts: Literal["force", "base"] = "force"
    """As in a simulation."""
    at: int = 0
    """Degree of freedom that a force acts on."""

    def vector(self, mass: Array) -> Array:
        """Return the amplitude of the force on each degree of freedom, (n,) N."""
        number("amplitude", self.amplitude)
        if self.acts == "base":
            return np.asarray(-self.amplitude * mass.sum(axis=1))
        if not 0 <= self.at < mass.shape[0]:
            raise InputError(
                "at", expected=f"in 0..{mass.shape[0] - 1}", found=f"{self.at}"
            )
        return np.asarray(self.amplitude * np.eye(mass.shape[0])[self.at])


@dataclass(frozen=True)
class Problem:
    """Everything that does not depend on the state. Unknowns are (n, N) real Fourier coefficients:
    mean, then cosine and sine of each harmonic.
    """  # noqa: D205

    structure: Structure
    """Masses and devices."""
    forces: tuple[DeviceForces, ...]
    """One a device."""
    load: Array
    """(n, N) coefficients of the load."""
    to_samples: Array
    """(N, N) coefficients to samples."""
    to_coefficients: Array
    """(N, N) its inverse."""
    slope: Array
    """(N, N) coefficients to the samples of the derivative by phase."""
    from_cells: Array
    """(N, N) means over the cells around the samples to coefficients."""
    creep: float
    """m/s per N at which held samples move: too little to matter, but where all stick it chooses
    the position without a mean force."""
    sharpest: float
    """The most that the kink of a reversal may be, over the change of velocity across it: as it is
    up to one; less keeps Newton's method on its way next to sticking."""

    @property
    def samples(self) -> int:
        """N."""
        return int(self.to_samples.shape[0])


def make_problem(structure: Structure, drive: SineDrive, harmonics: int) -> Problem:
    """Return the problem with `harmonics` harmonics."""
    if harmonics < 1:
        raise InputError("harmonics", expected=">= 1", found=f"{harmonics}")
    count = 2 * harmonics + 1
    phase = 2.0 * np.pi * np.arange(count) / count
    to_samples, slope = np.ones((count, count)), np.zeros((count, count))
    k = np.arange(1, harmonics + 1)
    cosine, sine = np.cos(np.outer(phase, k)), np.sin(np.outer(phase, k))
    to_samples[:, 1::2], to_samples[:, 2::2] = cosine, sine
    slope[:, 1::2], slope[:, 2::2] = -k * sine, k * cosine
    weights = np.full(count, 2.0 / count)
    weights[0] = 1.0 / count
    load = np.zeros((structure.size, count))
    load[:, 2] = drive.vector(structure.mass)
    to_coefficients = weights[:, None] * to_samples.T
    size = np.linalg.norm(structure.mass, 2) * np.linalg.norm(structure.stiffness, 2)
    impedance = float(np.sqrt(size)) or float(np.linalg.norm(structure.mass, 2))
    # A mean over a cell has its harmonics reduced by this factor.
    mean = np.append(1.0, np.repeat(np.sinc(k / count), 2))
    return Problem(
        structure, sort_forces(structure), load, to_samples, to_coefficients, slope,
        to_coefficients / mean[:, None], _CREEP / impedance, BLUNT,
    )  # fmt: skip


def dynamic_stiffness(problem: Problem, s: NDArray[np.complex128]) -> NDArray[np.complex128]:
    """Return the linear part at rates s (K,) rad/s, (K, n, n) N/m."""
    structure = problem.structure
    square = s[:, None, None]
    total: NDArray[np.complex128] = np.asarray(
        square**2 * structure.mass + square * structure.damping + structure.stiffness,
        dtype=np.complex128,
    )
    for direction, force in zip(structure.directions, problem.forces, strict=True):
        scalar: NDArray[np.complex128] = np.zeros(s.size, dtype=np.complex128)
        for order, coefficient in force.linear:
            scalar += coefficient * s**order
        total = total + scalar[:, None, None] * np.outer(direction, direction)
    return total


def linear_matrix(problem: Problem, omega: float) -> Array:
    """Return the linear part on the coefficients, (n N, n N)."""
    count = problem.samples
    size, harmonics = problem.structure.size, (count - 1) // 2
    rates = np.asarray(1j * omega * np.arange(harmonics + 1), dtype=np.complex128)
    stiffness = dynamic_stiffness(problem, rates)
    matrix = np.zeros((size, count, size, count))
    c, d = np.arange(1, count, 2), np.arange(2, count, 2)
    for i in range(size):
        for j in range(size):
            z = stiffness[1:, i, j]
            matrix[i, 0, j, 0] = stiffness[0, i, j].real
            matrix[i, c, j, c] = matrix[i, d, j, d] = z.real
            matrix[i, c, j, d], matrix[i, d, j, c] = z.imag, -z.imag
    return matrix.reshape(size * count, size * count)


def relative_motion(problem: Problem, unknowns: Array, omega: float) -> tuple[Array, Array]:
    """Return displacement and velocity of the devices at the samples, (q, N)."""
    own = problem.structure.directions @ unknowns
    return own @ problem.to_samples.T, omega * own @ problem.slope.T

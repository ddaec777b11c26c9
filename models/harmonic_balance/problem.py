"""The balance of every harmonic, with its Jacobian; friction as a set, sample by sample.

A cycle has N = 2 H + 1 samples. Linear and fractional terms are exact per harmonic; the others are
evaluated at the samples and carried over by the discrete Fourier transform. Where a device rubs,
its friction l, the mean over a sample's cell, is one unknown a sample: it is the limit with the
sign of v where the cell does not hold a zero of v, and where it does, v = (l/limit) d with
d = |dv/dphase| h/2 says where in the cell the motion reverses. A cell that sticks has v = 0 and any
l within the limit. Newton's method sorts the samples on the way.
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
_CLEAR = 0.6  # of half a cell's change of speed, that the neighbours of a reversal move at
_SOFTEST = 1e-2  # of the top speed: where in a cell a slower zero lies is left to Newton's method


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
    rub_slope: Array
    """(N, N) as `slope`, for the velocity at which friction works: the adjoint of `from_cells`."""
    rub_curve: Array
    """(N, N) coefficients to the samples of its derivative by phase."""
    creep: float
    """m/s per N at which held samples move: too little to matter, but where all stick it chooses
    the position without a mean force."""

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
    to_samples, slope, curve = np.ones((count, count)), *np.zeros((2, count, count))
    k = np.arange(1, harmonics + 1)
    cosine, sine = np.cos(np.outer(phase, k)), np.sin(np.outer(phase, k))
    to_samples[:, 1::2], to_samples[:, 2::2] = cosine, sine
    slope[:, 1::2], slope[:, 2::2] = -k * sine, k * cosine
    curve[:, 1::2], curve[:, 2::2] = -(k**2) * cosine, -(k**2) * sine
    weights = np.full(count, 2.0 / count)
    weights[0] = 1.0 / count
    load = np.zeros((structure.size, count))
    load[:, 2] = drive.vector(structure.mass)
    to_coefficients = weights[:, None] * to_samples.T
    size = np.linalg.norm(structure.mass, 2) * np.linalg.norm(structure.stiffness, 2)
    impedance = float(np.sqrt(size)) or float(np.linalg.norm(structure.mass, 2))
    # With the same factor on both sides the work of friction over the cycle is exact, and lost.
    mean = np.append(1.0, np.repeat(np.sinc(k / count), 2))
    return Problem(
        structure, sort_forces(structure), load, to_samples, to_coefficients, slope,
        to_coefficients / mean[:, None], slope / mean, curve / mean, _CREEP / impedance,
    )  # fmt: skip


def linear_matrix(problem: Problem, omega: float) -> Array:
    """Return the linear part on the coefficients, (n N, n N)."""
    structure, count = problem.structure, problem.samples
    size, harmonics = structure.size, (count - 1) // 2
    s = 1j * omega * np.arange(harmonics + 1)
    stiffness = np.asarray(
        s[:, None, None] ** 2 * structure.mass
        + s[:, None, None] * structure.damping
        + structure.stiffness,
        dtype=np.complex128,
    )
    for direction, force in zip(structure.directions, problem.forces, strict=True):
        scalar: NDArray[np.complex128] = np.zeros(harmonics + 1, dtype=np.complex128)
        for order, coefficient in force.linear:
            scalar += coefficient * s**order
        stiffness = stiffness + scalar[:, None, None] * np.outer(direction, direction)
    matrix = np.zeros((size, count, size, count))
    c, d = np.arange(1, count, 2), np.arange(2, count, 2)
    for i in range(size):
        for j in range(size):
            z = stiffness[1:, i, j]
            matrix[i, 0, j, 0] = stiffness[0, i, j].real
            matrix[i, c, j, c] = matrix[i, d, j, d] = z.real
            matrix[i, c, j, d], matrix[i, d, j, c] = z.imag, -z.imag
    return matrix.reshape(size * count, size * count)


@dataclass(frozen=True)
class Friction:
    """State of the rubbing devices at the samples."""

    force: Array
    """(q, N) N, mean over the cell; zero for devices that do not rub."""
    held: NDArray[np.bool_]
    """(q, N) where the velocity has a zero in the cell: reversals and sticking."""


def relative_motion(problem: Problem, unknowns: Array, omega: float) -> tuple[Array, Array]:
    """Return displacement and velocity of the devices at the samples, (q, N)."""
    own = problem.structure.directions @ unknowns
    return own @ problem.to_samples.T, omega * own @ problem.slope.T


def rubbing_speed(problem: Problem, unknowns: Array, omega: float) -> Array:
    """Return the velocity at which friction works, (q, N) m/s."""
    return np.asarray(omega * (problem.structure.directions @ unknowns) @ problem.rub_slope.T)


def zero_shift(problem: Problem, unknowns: Array, omega: float, *, give: float = 0.0) -> Array:
    """Return dv/dphase times half a cell where the motion reverses without sticking, else zero.

    (q, N) m/s; the reversal is in the cell where |v| is less. With some `give` none is told apart.
    """
    velocity = rubbing_speed(problem, unknowns, omega)
    own = problem.structure.directions @ unknowns
    shift = np.asarray((np.pi / problem.samples) * omega * own @ problem.rub_curve.T)
    before, after = np.roll(velocity, 1, axis=1), np.roll(velocity, -1, axis=1)
    return np.where(reverses(before, after, shift), 0.0 if give else shift, 0.0)


def reverses(before: Array, after: Array, shift: Array) -> NDArray[np.bool_]:
    """Return whether a velocity goes through zero at a slope, by the samples on either side."""
    clear = np.minimum(np.abs(before), np.abs(after)) > _CLEAR * np.abs(shift)
    return np.asarray(clear & (before * after < 0.0) & (before * shift < 0.0))


def sort_friction(
    problem: Problem, unknowns: Array, friction: Array, omega: float, *, give: float = 0.0
) -> Friction:
    """Return which samples are held, and the friction of those that slide, from the state.

    With some `give`, m/s per N, friction reverses over a range of speed instead: a way to a first
    guess.
    """
    velocity = rubbing_speed(problem, unknowns, omega)
    shift = np.abs(zero_shift(problem, unknowns, omega, give=give))
    force = np.zeros_like(velocity)
    held: NDArray[np.bool_] = np.zeros(velocity.shape, dtype=np.bool_)
    for j, law in enumerate(problem.forces):
        if not law.rubs:
            continue
        level, _ = law.limit(velocity[j])
        at_rest = float(law.limit(np.zeros(1))[0][0])
        yields = give + problem.creep + shift[j] / at_rest
        floor = _SOFTEST * float(np.abs(velocity[j]).max()) / at_rest + 1e-300
        trial = friction[j] + (velocity[j] - yields * friction[j]) / np.maximum(yields, floor)
        held[j] = np.less(np.abs(trial), at_rest)
        force[j] = np.where(held[j], trial if give else friction[j], level * np.sign(trial))
    return Friction(force, held)


def held_gap(
    problem: Problem, unknowns: Array, state: Friction, omega: float, *, give: float = 0.0
) -> Array:
    """Return what held samples miss of their rule, (sum of held,) m/s, device by device."""
    velocity = rubbing_speed(problem, unknowns, omega)
    shift = np.abs(zero_shift(problem, unknowns, omega, give=give))
    yields = give + problem.creep + shift / _at_rest(problem)[:, None]
    return np.asarray((velocity - yields * state.force)[state.held])


def _at_rest(problem: Problem) -> Array:
    zero = np.zeros(1)
    return np.array([law.limit(zero)[0][0] if law.rubs else 1.0 for law in problem.forces])


def residual(problem: Problem, unknowns: Array, friction: Array, omega: float) -> Array:
    """Return the imbalance of the coefficients, (n, N) N."""
    moved, velocity = relative_motion(problem, unknowns, omega)
    total = (linear_matrix(problem, omega) @ unknowns.ravel()).reshape(unknowns.shape)
    total -= problem.load
    for j, law in enumerate(problem.forces):
        own = problem.to_coefficients @ law.force(moved[j], velocity[j])
        own += problem.from_cells @ friction[j]
        total += problem.structure.directions[j][:, None] * own
    return total


def jacobian(
    problem: Problem, unknowns: Array, state: Friction, omega: float, *, give: float = 0.0
) -> Array:
    """Return the matrix for (unknowns, friction of held samples): balance, then their rules."""
    size, count = unknowns.shape
    moved, velocity = relative_motion(problem, unknowns, omega)
    matrix = linear_matrix(problem, omega).reshape(size, count, size, count)
    rubbing = rubbing_speed(problem, unknowns, omega)
    shift = zero_shift(problem, unknowns, omega, give=give)
    at_rest = _at_rest(problem)
    rows, columns, corner = [], [], []
    for j, law in enumerate(problem.forces):
        direction = problem.structure.directions[j]
        by_x, by_v = law.slopes(moved[j], velocity[j])
        own = problem.to_coefficients @ (
            by_x[:, None] * problem.to_samples + (omega * by_v)[:, None] * problem.slope
        )
        if law.stribeck:
            falling = law.limit(rubbing[j])[1] * np.sign(state.force[j])
            falling = np.where(state.held[j], 0.0, falling)
            own += problem.from_cells @ ((omega * falling)[:, None] * problem.rub_slope)
        matrix += np.einsum("i,k,ab->iakb", direction, direction, own)
        for index in np.nonzero(state.held[j])[0]:
            share = np.pi / problem.samples * state.force[j, index] / at_rest[j]
            share *= np.sign(shift[j, index])
            rule = omega * (problem.rub_slope[index] - share * problem.rub_curve[index])
            rows.append(np.outer(direction, rule).ravel())
            columns.append(np.outer(direction, problem.from_cells[:, index]).ravel())
            corner.append(-give - problem.creep - abs(shift[j, index]) / at_rest[j])
    total = matrix.reshape(size * count, size * count)
    if not rows:
        return total
    extra = len(rows)
    bordered = np.zeros((total.shape[0] + extra, total.shape[0] + extra))
    bordered[: total.shape[0], : total.shape[0]] = total
    bordered[total.shape[0] :, : total.shape[0]] = np.array(rows)
    bordered[: total.shape[0], total.shape[0] :] = np.array(columns).T
    bordered[total.shape[0] :, total.shape[0] :] = np.diag(corner)
    return bordered

"""One steady state: its harmonics, and the motion that they make."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from models.checks import Array, InputError, number
from models.harmonic_balance.newton import Solution, from_stuck, newton, settle, sharpen
from models.harmonic_balance.problem import Problem, SineDrive, linear_matrix, make_problem
from models.structure import Structure

_FINE = 4096
_GUESSES = (0.5, 0.2, -0.5, 0.0)  # shares of the linear response


@dataclass(frozen=True)
class SteadyState:
    """A periodic motion, stable or not."""

    structure: Structure
    """That moves."""
    drive: SineDrive
    """That drives it."""
    frequency: float
    """Hz."""
    coefficients: NDArray[np.complex128]
    """(H + 1, n) m: x = Re sum_k c_k exp(i k omega t)."""
    friction: Array
    """(q, 2 H + 1) N, Coulomb and Stribeck friction at evenly spaced moments of the cycle."""
    held: NDArray[np.bool_]
    """(q, 2 H + 1) where a device reverses or sticks."""
    imbalance: float
    """Largest imbalance of a harmonic over the load's amplitude."""

    @property
    def omega(self) -> float:
        """rad/s."""
        return 2.0 * np.pi * self.frequency

    @property
    def amplitude(self) -> Array:
        """(n,) m: half the travel from peak to peak."""
        moved = self.displacement(np.arange(_FINE) / (_FINE * self.frequency))
        return np.asarray(np.ptp(moved, axis=0) / 2.0)

    def displacement(self, time: ArrayLike) -> Array:
        """Return x at `time` (N,) s, (N, n) m."""
        t = np.atleast_1d(np.asarray(time, dtype=np.float64))
        rates = 1j * self.omega * np.arange(self.coefficients.shape[0])
        return np.asarray((np.exp(np.outer(t, rates)) @ self.coefficients).real)

    def to_dict(self) -> dict[str, Any]:
        """Return frequency, amplitudes and fundamentals."""
        return {
            "frequency_hz": self.frequency,
            "amplitude": self.amplitude.tolist(),
            "fundamental": np.abs(self.coefficients[1]).tolist(),
            "imbalance": self.imbalance,
        }


def from_solution(problem: Problem, drive: SineDrive, solution: Solution) -> SteadyState:
    """Return a solution in complex harmonics."""
    x = solution.unknowns
    coefficients = np.empty((x.shape[1] // 2 + 1, x.shape[0]), dtype=np.complex128)
    coefficients[0] = x[:, 0]
    coefficients[1:] = (x[:, 1::2] - 1j * x[:, 2::2]).T
    return SteadyState(
        problem.structure, drive, solution.omega / (2.0 * np.pi), coefficients,
        solution.friction.force, solution.friction.held,
        solution.imbalance,
    )  # fmt: skip


def unknowns_of(state: SteadyState) -> Array:
    """Return the real coefficients of a steady state, (n, N)."""
    c = state.coefficients
    x = np.empty((c.shape[1], 2 * c.shape[0] - 1))
    x[:, 0] = c[0].real
    x[:, 1::2], x[:, 2::2] = c[1:].real.T, -c[1:].imag.T
    return x


def steady_state(
    structure: Structure,
    drive: SineDrive,
    frequency: float,
    *,
    harmonics: int = 32,
    guess: SteadyState | None = None,
) -> SteadyState:
    """Return a steady state at one frequency.

    Parameters
    ----------
    structure : Structure
        Devices of one band each.
    drive : SineDrive
        Load amplitude * sin(2 pi f t).
    frequency : float
        f, Hz.
    harmonics : int
        Smooth forces need few. Of a motion that slides all the time with friction the error falls
        faster than their number; where it sticks for a part of the cycle, only about as fast: the
        error is then some percent, and a simulation in time is the better answer.
    guess : SteadyState, optional
        Start of Newton's method, with as many harmonics; the linear response where left out.

    Returns
    -------
    SteadyState
        Harmonics of every displacement, m.

    Raises
    ------
    InputError
        Where no steady state is found from the guess; follow a branch there instead.

    Examples
    --------
    >>> from models.structure import oscillator
    >>> state = steady_state(oscillator(1.0, 4.0), SineDrive(3.0), 1.0 / (2.0 * np.pi))
    >>> state.amplitude.round(9)
    array([1.])
    """
    number("frequency", frequency, above=0.0)
    problem = make_problem(structure, drive, harmonics)
    omega = 2.0 * np.pi * frequency
    friction = np.zeros((len(structure.devices), problem.samples))
    if guess is None:
        start = first_guess(problem, omega)
    else:
        start = unknowns_of(guess)
        if start.shape != problem.load.shape:
            raise InputError("guess", expected=f"with {harmonics} harmonics", found="others")
        friction = guess.friction
    solution = newton(problem, start, friction, omega)
    if not solution.converged:
        solution = settle(problem, start, friction, omega)
    if not solution.converged and guess is None:
        for attempt in _GUESSES:
            solution = settle(problem, attempt * start, friction, omega)
            if solution.converged:
                break
        else:
            solution = by_load(problem, omega)
        if not solution.converged and any(law.rubs for law in problem.forces):
            solution = from_stuck(problem, omega)
    if not solution.converged:
        raise InputError(
            "steady state", expected=f"to be found at {frequency:g} Hz from the guess",
            found=f"an imbalance of {solution.imbalance:.1e}",
        )  # fmt: skip
    return from_solution(problem, drive, sharpen(problem, solution))


def first_guess(problem: Problem, omega: float) -> Array:
    """Return the response of the linear part alone."""
    matrix = linear_matrix(problem, omega)
    found = np.linalg.lstsq(matrix, problem.load.ravel(), rcond=1e-12)[0]
    return np.asarray(found.reshape(problem.load.shape), dtype=np.float64)


def by_load(problem: Problem, omega: float) -> Solution:
    """Return the solution reached by raising the load from small."""
    friction = np.zeros((len(problem.forces), problem.samples))
    x = np.zeros_like(problem.load)
    share, step = 0.0, 0.1
    solution = None
    while share < 1.0 and step > 1e-4:
        ahead = min(1.0, share + step)
        scaled = replace(problem, load=ahead * problem.load)
        start = x * (ahead / share) if share > 0.0 else first_guess(scaled, omega)
        solution = settle(scaled, start, friction, omega)
        if solution.converged:
            x, friction, share = solution.unknowns, solution.friction.force, ahead
            step *= 1.5
        else:
            step *= 0.5
    return solution if solution is not None else newton(problem, x, friction, omega)

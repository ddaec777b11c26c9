"""Frequency response by continuation: along the branch, through its folds."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from models.checks import Array, InputError, number
from models.harmonic_balance.newton import (
    SHORT_LADDER,
    Constraint,
    Solution,
    newton,
    settle,
    sharpen,
    tangent,
)
from models.harmonic_balance.problem import Problem, SineDrive, make_problem
from models.harmonic_balance.stability import unstable_exponents
from models.harmonic_balance.steady_state import (
    SteadyState,
    by_load,
    first_guess,
    from_solution,
)
from models.structure import Structure

_SHORTEST = 1e-6
_SWIFT, _SLOW = 4, 9
_JUMPS = (1e-4, 3e-4, 1e-3, 3e-3, 1e-2)
_JUMP_REACH = 20.0  # change of displacement per change of frequency, both relative


@dataclass(frozen=True)
class Fold:
    """Where the branch turns back in frequency: a stable and an unstable state meet."""

    frequency: float
    """Hz."""
    amplitude: Array
    """(n,) m."""
    after: int
    """Index of the last point before the turn."""


@dataclass(frozen=True)
class Branch:
    """A frequency response, in the order of the continuation."""

    points: tuple[SteadyState, ...]
    """Steady states."""
    folds: tuple[Fold, ...]
    """Turns in frequency."""
    stable: NDArray[np.bool_] | None
    """(P,) by `unstable_exponents`; None where it was not asked for."""
    complete: bool
    """False where the continuation stuck before the end of the band; `points` ends there."""

    @property
    def frequency(self) -> Array:
        """(P,) Hz."""
        return np.array([p.frequency for p in self.points])

    @property
    def amplitude(self) -> Array:
        """(P, n) m: half the travel from peak to peak."""
        return np.array([p.amplitude for p in self.points])


def frequency_response(
    structure: Structure,
    drive: SineDrive,
    band: tuple[float, float],
    *,
    harmonics: int = 32,
    step: float = 0.02,
    most: int = 2000,
    stability: bool = True,
) -> Branch:
    """Follow the response from one end of a band to the other, through folds.

    Parameters
    ----------
    structure : Structure
        Devices of one band each.
    drive : SineDrive
        Load.
    band : tuple of float
        First and last frequency, Hz; downwards where the first is the higher.
    harmonics : int
        As in `steady_state`.
    step : float
        Longest step: relative in frequency, and in the displacement over its largest so far.
    most : int
        Points at most.
    stability : bool
        Judge every point.

    Returns
    -------
    Branch
        Its `complete` says whether the far end was reached.

    Examples
    --------
    >>> from models.structure import oscillator
    >>> branch = frequency_response(oscillator(1.0, 1.0, damping=0.2), SineDrive(1.0), (0.1, 0.2))
    >>> bool(abs(branch.amplitude.max() - 1.0 / (0.2 * 0.99**0.5)) < 0.01), branch.folds
    (True, ())
    """
    first = number("first frequency of the band", band[0], above=0.0)
    last = number("last frequency of the band", band[1], above=0.0)
    if first == last:
        raise InputError("band", expected="two frequencies", found=f"{first} twice")
    number("step", step, above=_SHORTEST, at_most=0.5)
    problem = make_problem(structure, drive, harmonics)
    omega = 2.0 * np.pi * first
    friction = np.zeros((len(structure.devices), problem.samples))
    start = settle(problem, first_guess(problem, omega), friction, omega)
    if not start.converged:
        start = by_load(problem, omega)
    if not start.converged:
        raise InputError(
            "first frequency of the band", expected="where Newton's method finds a steady state",
            found=f"{first:g} Hz",
        )  # fmt: skip
    solutions, signs, complete = _follow(problem, start, 2.0 * np.pi * last, step, most)
    points = tuple(from_solution(problem, drive, _sharpened(problem, s)) for s in solutions)
    stable = None
    if stability:
        stable = np.array([unstable_exponents(p) == 0 for p in points])
    return Branch(points, _folds(points, signs), stable, complete)


def _sharpened(problem: Problem, solution: Solution) -> Solution:
    """Return the solution with sharp kinks, in the plane across the branch."""
    if not any(law.rubs for law in problem.forces):
        return solution
    scale = float(np.linalg.norm(solution.unknowns)) or 1.0
    way, along = tangent(problem, solution, scale)
    constraint = Constraint(solution.unknowns, float(np.log(solution.omega)), way, along, scale)
    return sharpen(problem, solution, constraint=constraint)


def _follow(
    problem: Problem, start: Solution, end: float, longest: float, most: int
) -> tuple[list[Solution], list[float], bool]:
    forward = float(np.sign(end - start.omega))
    solutions, signs = [start], [forward]
    length = 0.5 * longest
    past_way: Array | None = None
    while len(solutions) < most:
        here = solutions[-1]
        scale = max(float(np.linalg.norm(s.unknowns)) for s in solutions)
        way, along = tangent(problem, here, scale)
        if past_way is None:
            turn = forward
        else:
            turn = float(np.sign(np.append(way.ravel(), along) @ past_way))
        way, along = turn * way, turn * along
        found = None
        while length > _SHORTEST:
            ahead = here.unknowns + length * scale * way
            log_omega = np.log(here.omega) + length * along
            constraint = Constraint(ahead, log_omega, way, along, scale)
            trial = newton(
                problem, ahead, here.friction.force, float(np.exp(log_omega)), constraint=constraint
            )
            if not trial.converged:
                trial = settle(
                    problem, ahead, here.friction.force, here.omega, constraint=constraint,
                    ladder=SHORT_LADDER,
                )  # fmt: skip
            if trial.converged and _near(trial, constraint, length):
                found = trial
                break
            length *= 0.5
        if found is None:
            # Grazing: a sample begins or ends to stick, and the branch has a corner there.
            found = _across(problem, here, float(np.sign(along)), scale)
            length = 0.1 * longest
        if found is None:
            return solutions, signs, False
        if (found.omega - end) * forward >= 0.0:
            final = newton(problem, found.unknowns, found.friction.force, end)
            solutions.append(final if final.converged else found)
            signs.append(turn)
            return solutions, signs, True
        solutions.append(found)
        signs.append(float(np.sign(found.omega - here.omega)))
        past_way = np.append(way.ravel(), along)
        if found.iterations <= _SWIFT:
            length = min(1.5 * length, longest)
        elif found.iterations >= _SLOW:
            length *= 0.7
    return solutions, signs, False


def _across(problem: Problem, here: Solution, way: float, scale: float) -> Solution | None:
    """Return a state a little ahead in frequency, and near in displacement, past a corner."""
    if not any(law.rubs for law in problem.forces):
        return None
    for jump in _JUMPS:
        omega = here.omega * (1.0 + way * jump)
        trial = settle(problem, here.unknowns, here.friction.force, omega)
        moved = float(np.linalg.norm(trial.unknowns - here.unknowns)) / scale
        if trial.converged and moved < _JUMP_REACH * jump:
            return trial
    return None


def _near(trial: Solution, constraint: Constraint, length: float) -> bool:
    """Return whether the correction stayed short against the step: no jump to another branch."""
    off = float(np.linalg.norm(trial.unknowns - constraint.unknowns)) / constraint.scale
    return off < 0.5 * length + 1e-9


def _folds(points: tuple[SteadyState, ...], signs: list[float]) -> tuple[Fold, ...]:
    found = []
    for i in range(1, len(points) - 1):
        if signs[i] * signs[i + 1] >= 0.0:
            continue
        three = points[i - 1 : i + 2]
        frequency = np.array([p.frequency for p in three])
        amplitude = np.array([p.amplitude for p in three])
        arc = np.linalg.norm(np.diff(amplitude, axis=0), axis=1) / amplitude.max()
        s = np.array([-arc[0], 0.0, arc[1]])
        a, b, _ = np.polyfit(s, frequency, 2)
        top = -b / (2.0 * a)
        size = np.array([np.polyval(np.polyfit(s, column, 2), top) for column in amplitude.T])
        found.append(Fold(float(np.polyval(np.polyfit(s, frequency, 2), top)), size, i))
    return tuple(found)

"""Newton's method for the balance, at a fixed frequency or along a branch."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from models.checks import Array
from models.harmonic_balance.balance import jacobian, residual
from models.harmonic_balance.friction import Friction, held_gap, sort_friction
from models.harmonic_balance.problem import SHARP, Problem, relative_motion

_ITERATIONS = 40
_TOLERANCE = 1e-11  # of the balance, over the largest force in it
_RULE_TOLERANCE = 1e-9  # of the top speed, for samples that are held
_LEAST_SPEED = 1e-12  # m/s: below it nothing moves
_FREQUENCY_STEP = 1e-6
_FINEST_RATIO = 0.9999
_NEAR = 0.05  # of the displacement: what blunt kinks may have been wrong by
LADDER = (1.0, 0.3, 0.1, 0.03, 0.01, 0.003, 0.001)
SHORT_LADDER = (0.03, 0.01, 0.003, 0.001)


@dataclass(frozen=True)
class Constraint:
    """The plane that a point of a branch is sought in: tangent . (point - predicted) = 0."""

    unknowns: Array
    """(n, N) predicted."""
    log_omega: float
    """Predicted."""
    tangent: Array
    """(n, N) direction, in unknowns over `scale`."""
    tangent_omega: float
    """Direction in log omega."""
    scale: float
    """m, that unknowns are measured in."""


@dataclass(frozen=True)
class Solution:
    """A state that balances, or the last attempt at it."""

    unknowns: Array
    """(n, N) m."""
    friction: Friction
    """Of the rubbing devices."""
    omega: float
    """rad/s."""
    imbalance: float
    """Largest imbalance over the largest force."""
    iterations: int
    """Used."""
    converged: bool
    """False where the iterations ran out."""


def newton(
    problem: Problem,
    unknowns: Array,
    friction: Array,
    omega: float,
    *,
    constraint: Constraint | None = None,
    give: float = 0.0,
) -> Solution:
    """Return the solution near a guess, at fixed omega or in the constraint's plane.

    `give`, m/s per N, lets friction yield as `sort_friction` says.
    """
    x, f, w = unknowns.copy(), friction.copy(), omega
    state = sort_friction(problem, x, f, w, give=give)
    f = state.force
    scale = _force_scale(problem)
    imbalance = np.inf
    for iteration in range(1, _ITERATIONS + 1):
        balance = residual(problem, x, f, w)
        gaps = held_gap(problem, x, state, w, give=give)
        right = [-balance.ravel(), -gaps]
        matrix = jacobian(problem, x, state, w, give=give)
        if constraint is not None:
            matrix, gap = _border(problem, matrix, x, f, w, state, constraint)
            right.append(np.array([-gap]))
        try:
            step = np.linalg.solve(matrix, np.concatenate(right))
        except np.linalg.LinAlgError:
            # A resonance that nothing drives or damps: the shortest step leaves it alone.
            step = np.linalg.lstsq(matrix, np.concatenate(right), rcond=1e-13)[0]
        if not np.isfinite(step).all():
            return Solution(x, state, w, float(imbalance), iteration, converged=False)
        if give:
            move = np.asarray(step[: x.size].reshape(x.shape), dtype=np.float64)
            step[: x.size] *= _damping(problem, x, f, w, move, give)
        x = x + step[: x.size].reshape(x.shape)
        f = f.copy()
        f[state.held] += step[x.size : x.size + int(state.held.sum())]
        if constraint is not None:
            w = w * float(np.exp(np.clip(step[-1], -0.5, 0.5)))
        before = state.held
        state = sort_friction(problem, x, f, w, give=give)
        f = state.force
        largest = max(scale, float(np.abs(f).max(initial=0.0)))
        imbalance = float(np.abs(residual(problem, x, f, w)).max()) / largest
        speed = max(float(np.abs(relative_motion(problem, x, w)[1]).max(initial=0.0)), _LEAST_SPEED)
        off = float(np.abs(held_gap(problem, x, state, w, give=give)).max(initial=0.0)) / speed
        settled = bool((before == state.held).all()) and off < _RULE_TOLERANCE
        if imbalance < _TOLERANCE and settled:
            return Solution(x, state, w, imbalance, iteration, converged=True)
    return Solution(x, state, w, float(imbalance), _ITERATIONS, converged=False)


def settle(
    problem: Problem,
    unknowns: Array,
    friction: Array,
    omega: float,
    *,
    constraint: Constraint | None = None,
    ladder: tuple[float, ...] = LADDER,
) -> Solution:
    """Return the solution reached with friction that gives less and less, at last not at all."""
    x, f = unknowns, friction
    if not any(law.rubs for law in problem.forces):
        return newton(problem, x, f, omega, constraint=constraint)
    _, velocity = relative_motion(problem, x, omega)
    least = min(float(law.limit(np.zeros(1))[0][0]) for law in problem.forces if law.rubs)
    soft = max(float(np.abs(velocity).max()), 1e-300) / least
    w = omega
    for share in ladder:
        solution = newton(problem, x, f, w, constraint=constraint, give=share * soft)
        if solution.converged:
            x, f, w = solution.unknowns, solution.friction.force, solution.omega
    return newton(problem, x, f, w, constraint=constraint)


def sharpen(
    problem: Problem, solution: Solution, *, constraint: Constraint | None = None
) -> Solution:
    """Return a solution with the kinks of its reversals as they are, where that is found near."""
    if not any(law.rubs for law in problem.forces):
        return solution
    best = solution
    size = float(np.linalg.norm(solution.unknowns))
    for sharpest in SHARP:
        trial = newton(
            replace(problem, sharpest=sharpest), best.unknowns, best.friction.force, best.omega,
            constraint=constraint,
        )  # fmt: skip
        moved = float(np.linalg.norm(trial.unknowns - solution.unknowns))
        if not trial.converged or moved > _NEAR * size:
            break
        best = trial
    return best


def from_stuck(problem: Problem, omega: float) -> Solution:
    """Return the solution reached from full sticking as friction falls to what it is."""
    x = np.zeros_like(problem.load)
    f = np.zeros((len(problem.forces), problem.samples))
    at_rest = [float(law.limit(np.zeros(1))[0][0]) for law in problem.forces if law.rubs]
    share = 10.0 * float(np.abs(problem.load).sum()) / min(at_rest) + 1.0
    ratio = 0.5
    solution = newton(_with_friction(problem, share), x, f, omega)
    while solution.converged and ratio < _FINEST_RATIO:
        following = max(1.0, share * ratio)
        trial = newton(
            _with_friction(problem, following), solution.unknowns, solution.friction.force, omega
        )
        if not trial.converged:
            ratio = ratio**0.5
            continue
        solution, share = trial, following
        if share == 1.0:
            return solution
        ratio = max(ratio**1.5, 0.5)
    return newton(problem, solution.unknowns, solution.friction.force, omega)


def _with_friction(problem: Problem, factor: float) -> Problem:
    forces = tuple(law.scaled_friction(factor) for law in problem.forces)
    return replace(problem, forces=forces)


def _damping(
    problem: Problem, x: Array, f: Array, omega: float, step: Array, give: float
) -> float:
    """Return the share of a step that lowers the imbalance: friction that gives is a function."""

    def imbalance(moved: Array) -> float:
        rubbed = sort_friction(problem, moved, f, omega, give=give).force
        return float(np.linalg.norm(residual(problem, moved, rubbed, omega)))

    now = imbalance(x)
    share = 1.0
    while share > 1e-3 and imbalance(x + share * step) > (1.0 - 0.1 * share) * now:
        share *= 0.5
    return share


def tangent(problem: Problem, solution: Solution, scale: float) -> tuple[Array, float]:
    """Return the branch's unit direction at a solution: unknowns over scale, and log omega."""
    matrix = jacobian(problem, solution.unknowns, solution.friction, solution.omega)
    change = _by_log_omega(problem, solution.unknowns, solution.friction, solution.omega)
    way = np.linalg.solve(matrix, -change)[: solution.unknowns.size] / scale
    length = float(np.sqrt(way @ way + 1.0))
    unit: Array = np.asarray(way.reshape(solution.unknowns.shape) / length, dtype=np.float64)
    return unit, 1.0 / length


def _by_log_omega(problem: Problem, x: Array, state: Friction, omega: float) -> Array:
    """Return the derivative of balance and held samples' rules by log omega."""
    up, down = omega * (1.0 + _FREQUENCY_STEP), omega * (1.0 - _FREQUENCY_STEP)
    forces = residual(problem, x, state.force, up) - residual(problem, x, state.force, down)
    gaps = held_gap(problem, x, state, up) - held_gap(problem, x, state, down)
    return np.concatenate([forces.ravel(), gaps]) / (2.0 * _FREQUENCY_STEP)


def _border(
    problem: Problem, matrix: Array, x: Array, f: Array, w: float, state: Friction,
    constraint: Constraint,
) -> tuple[Array, float]:  # fmt: skip
    size = matrix.shape[0]
    wide = np.zeros((size + 1, size + 1))
    wide[:size, :size] = matrix
    wide[:size, size] = _by_log_omega(problem, x, Friction(f, state.held), w)
    wide[size, : x.size] = constraint.tangent.ravel() / constraint.scale
    wide[size, size] = constraint.tangent_omega
    gap = float(np.sum(constraint.tangent * (x - constraint.unknowns)) / constraint.scale)
    gap += constraint.tangent_omega * (np.log(w) - constraint.log_omega)
    return wide, gap


def _force_scale(problem: Problem) -> float:
    return max(float(np.abs(problem.load).max()), 1e-300)

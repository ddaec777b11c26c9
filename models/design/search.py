"""Search for the best design: differential evolution over everything, then SLSQP from its best.

Both work on the same `Problem`; SLSQP also starts from scattered points, so that agreement of
independent runs shows whether the optimum is the only one.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy import optimize
from scipy.stats import qmc

from models.checks import Array
from models.design.constraints import Problem

# SLSQP meets constraints to about this; a design that exceeds a bound by less is within it.
TOLERANCE = 1e-7
_STEP = 1e-6


@dataclass(frozen=True)
class SearchResult:
    """The best point found and how surely it is the best."""

    point: Array
    """y, (6,)."""
    value: float
    """ln f_low there; meaningless where not feasible."""
    violation: float
    """Largest ratio - 1; above zero where no point meets all bounds."""
    evaluations: int
    """Points at which the problem was evaluated."""
    agreeing: int
    """Local searches that ended within 1e-4 of the best value (relative, of the frequency)."""
    starts: int
    """Local searches run."""
    global_value: float | None
    """ln f_low that differential evolution reached alone; None where it wasn't run."""

    @property
    def feasible(self) -> bool:
        """Whether every bound is met."""
        return self.violation <= TOLERANCE


def gradient(problem: Problem, y: Array) -> tuple[Array, Array]:
    """Return d(objective)/dy (6,) and d(ratios)/dy (C, 6) by central differences."""
    steps = _STEP * np.eye(y.size)
    points = np.concatenate([y + steps, y - steps]).T
    values, ratios = problem.objective(points), problem.ratios(points)
    n = y.size
    slope = (values[:n] - values[n:]) / (2.0 * _STEP)
    return slope, (ratios[:, :n] - ratios[:, n:]) / (2.0 * _STEP)


def local_search(problem: Problem, start: Array) -> tuple[Array, int]:
    """Return where SLSQP ends from `start`, and the number of points evaluated."""
    lower, upper = np.array(problem.box()).T
    calls = 0

    def cost(y: Array) -> float:
        nonlocal calls
        calls += 1
        return float(problem.objective(y))

    def slope(y: Array) -> Array:
        nonlocal calls
        calls += 2 * y.size
        return gradient(problem, y)[0]

    point = _slsqp(
        cost,
        slope,
        lambda y: 1.0 - problem.ratios(y),
        lambda y: -gradient(problem, y)[1],
        np.clip(start, lower, upper),
        list(zip(lower, upper, strict=True)),
    )
    return np.clip(point, lower, upper), calls


def _slsqp(
    cost: Callable[[Array], float],
    slope: Callable[[Array], Array],
    room: Callable[[Array], Array],
    room_slope: Callable[[Array], Array],
    start: Array,
    box: Sequence[tuple[float | None, float | None]],
) -> Array:
    """Return where SLSQP ends: least `cost` with `room` >= 0 inside the box."""
    run: Any = optimize.minimize  # its stubs know no callables that take plain arrays
    result = run(
        cost,
        start,
        jac=slope,
        method="SLSQP",
        bounds=box,
        constraints={"type": "ineq", "fun": room, "jac": room_slope},
        options={"maxiter": 300, "ftol": 1e-12},
    )
    return np.asarray(result.x, dtype=np.float64)


def least_violation(problem: Problem, start: Array) -> tuple[Array, float]:
    """Return the point near `start` whose worst ratio is smallest, and that ratio - 1."""
    lower, upper = np.array(problem.box()).T
    begin = np.clip(start, lower, upper)
    worst = float(np.max(problem.ratios(begin)))

    def room_slope(z: Array) -> Array:
        return np.column_stack([-gradient(problem, z[:-1])[1], np.ones(len(problem.listed))])

    found = _slsqp(
        lambda z: float(z[-1]),
        lambda z: np.append(np.zeros(z.size - 1), 1.0),
        lambda z: np.asarray(z[-1] - problem.ratios(z[:-1])),
        room_slope,
        np.append(begin, worst),
        [*zip(lower, upper, strict=True), (None, None)],
    )
    point = np.clip(found[:-1], lower, upper)
    return point, float(np.max(problem.ratios(point))) - 1.0


def global_search(problem: Problem, *, seed: int) -> tuple[Array, int]:
    """Return the best point of differential evolution (constraints by Lampinen's rule)."""
    calls = 0

    def cost(y: Array) -> Array:
        nonlocal calls
        calls += 1 if y.ndim == 1 else y.shape[1]
        return problem.objective(y)

    run: Any = optimize.differential_evolution  # its stubs know no vectorised cost
    result = run(
        cost,
        problem.box(),
        constraints=optimize.NonlinearConstraint(problem.ratios, -np.inf, 1.0),
        rng=np.random.default_rng(seed),
        popsize=20,
        maxiter=400,
        tol=1e-8,
        polish=False,
        vectorized=True,
        updating="deferred",
        init="sobol",
    )
    return np.asarray(result.x, dtype=np.float64), calls


def search(
    problem: Problem, *, seed: int = 0, starts: int = 12, near: Array | None = None
) -> SearchResult:
    """Return the design with the lowest critical frequency, or the least infeasible one.

    Parameters
    ----------
    problem : Problem
        What to solve.
    seed : int
        Of the evolution and of the scattered starts.
    starts : int
        Scattered starts of the local search.
    near : array, shape (6,), optional
        A point close to the optimum (a neighbouring problem's): then no evolution is run.
    """
    lower, upper = np.array(problem.box()).T
    sampler = qmc.Sobol(d=lower.size, rng=np.random.default_rng(seed + 1))
    count = 1 << max(starts - 1, 0).bit_length()
    scattered = (lower + sampler.random(count) * (upper - lower))[:starts]
    evaluations, alone = 0, None
    first = [near] if near is not None else []
    if near is None:
        found, evaluations = global_search(problem, seed=seed)
        first = [found]
        if float(np.max(problem.ratios(found))) - 1.0 <= TOLERANCE:
            alone = float(problem.objective(found))
    ends = []
    for start in [*first, *scattered]:
        # A feasible beginning keeps SLSQP's linearised constraints consistent.
        begin, _ = least_violation(problem, start)
        end, calls = local_search(problem, begin)
        evaluations += calls
        ends += [end, begin]
    ends += [np.clip(y, lower, upper) for y in first]
    violations = np.array([float(np.max(problem.ratios(y))) - 1.0 for y in ends])
    values = np.array([float(problem.objective(y)) for y in ends])
    met = violations <= TOLERANCE
    if not met.any():
        best = int(np.argmin(violations))
        return SearchResult(
            ends[best], float(values[best]), float(violations[best]), evaluations, 0,
            len(first) + starts, None,
        )
    best = int(np.argmin(np.where(met, values, np.inf)))
    close = met & (values - values[best] < 1e-4)
    return SearchResult(
        ends[best],
        float(values[best]),
        max(float(violations[best]), 0.0),
        evaluations,
        int(np.sum(close[: 2 * (len(first) + starts) : 2])),
        len(first) + starts,
        alone,
    )

"""Why no design fits: which bounds conflict, and what each would have to become alone."""

from __future__ import annotations

import numpy as np
from scipy import optimize

from models.checks import Array
from models.design.constraints import Bound, Problem
from models.design.result import Conflict
from models.design.search import TOLERANCE, gradient, least_violation

_WIDEST = 1e3


def _loosened(problem: Problem, bound: Bound, factor: float) -> Problem:
    """Return the problem with one bound loosened by a factor above one."""
    return problem.moved(bound, factor if bound.kind == "at most" else 1.0 / factor)


def _admits(problem: Problem, starts: list[Array]) -> bool:
    return any(least_violation(problem, start)[1] <= TOLERANCE for start in starts)


def _needed(problem: Problem, bound: Bound, starts: list[Array]) -> float | None:
    """Return the value of one bound from which on a design exists, others kept."""
    if not _admits(_loosened(problem, bound, _WIDEST), starts):
        return None
    low, high = 0.0, float(np.log(_WIDEST))
    while high - low > 1e-3:
        middle = 0.5 * (low + high)
        if _admits(_loosened(problem, bound, float(np.exp(middle))), starts):
            high = middle
        else:
            low = middle
    factor = float(np.exp(high))
    return bound.limit * (factor if bound.kind == "at most" else 1.0 / factor)


def conflicts(problem: Problem, y: Array) -> tuple[Conflict, ...]:
    """Return the bounds that conflict at the least infeasible point, with what each needs.

    At that point the worst ratios can't all be lowered: a combination of their gradients with
    weights that sum to one vanishes. Bounds of weight zero play no part.

    Parameters
    ----------
    problem : Problem
        A problem that no design solves.
    y : array, shape (6,)
        Its least infeasible point.
    """
    ratios = problem.ratios(y)
    _, jacobian = gradient(problem, y)
    worst = [k for k in range(ratios.size) if ratios[k] > ratios.max() - 1e-4]
    # The inertance is fixed from below: its gradient is free to take up what is left.
    rows = [*(jacobian[k] for k in worst), -np.eye(y.size)[5]]
    sums = [*(1.0 for _ in worst), 0.0]
    weights, _ = optimize.nnls(np.vstack([np.array(rows).T, sums]), np.append(np.zeros(6), 1.0))
    involved = [problem.listed[k] for k, w in zip(worst, weights, strict=False) if w > 1e-4]
    if weights[-1] > 1e-4:
        involved.append(Bound("inertance", problem.bounds.inertance, "kg", "at least", "inertance"))
    starts = [y, problem_middle(problem)]
    return tuple(
        Conflict(
            b.name,
            b.limit,
            b.unit,
            b.kind,
            None if b.kind == "geometry" else _needed(problem, b, starts),
        )
        for b in involved
    )


def problem_middle(problem: Problem) -> Array:
    """Return the middle of the search box, a start that favours no bound."""
    return np.asarray(np.array(problem.box()).mean(axis=1))

"""The rough design: geometry and fluid with the lowest critical frequency (Eq. 16) under bounds."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from models.checks import Array, InputError
from models.design.constraints import Problem
from models.design.infeasible import conflicts
from models.design.prices import active_bounds, elasticities
from models.design.problem import DesignBounds, Duty
from models.design.result import DesignPoint, DesignResult
from models.design.search import SearchResult, search
from models.device import Device, Fluid

FRONT_INERTANCE = (0.5, 1.0, 2.0)
"""Inertances of the trade-off front, over the wanted one."""
FRONT_DAMPING = (0.03, 0.1, 0.2, 0.35, 0.5, 0.7, 1.0, 1.5, 2.0)
"""Damping limits of the trade-off front, over the baseline's parasitic damping."""


def minimise_critical_frequency(
    baseline: Device,
    *,
    duty: Duty | None = None,
    bounds: DesignBounds | None = None,
    fluids: Mapping[str, Fluid] | None = None,
    front: bool = True,
    seed: int = 0,
) -> DesignResult:
    """Return the design with the lowest critical frequency at the duty's amplitude.

    Parameters
    ----------
    baseline : Device
        The device to improve on; its fluid is kept unless `fluids` offers others.
    duty : Duty, optional
        Motion: 5 mm, up to 10 Hz.
    bounds : DesignBounds, optional
        `DesignBounds.around(baseline)`: its package, inertance and rod, at most twice its damping.
    fluids : mapping of name to Fluid, optional
        What may be filled in; the baseline's own fluid alone where absent.
    front : bool
        Whether to trace the trade-off of critical frequency, inertance and damping.
    seed : int
        Makes the search repeatable.

    Returns
    -------
    DesignResult
        Where nothing meets the bounds, `best` is None and `conflicts` says why.

    Raises
    ------
    InputError
        Without a fluid, or for a duty or bounds that are out of range.

    Notes
    -----
    The two Dean conventions differ by the factor 2 sqrt(2), so one design is best by both.

    References
    ----------
    Chen & Chen, *Materials* 2025, 18(11), 2556, section 3.3 and Eq. 16.

    Examples
    --------
    >>> result = minimise_critical_frequency(Device.preset("device-12"), front=False)
    >>> result.improvement > 5.0
    True
    """
    motion = duty or Duty()
    limits = bounds or DesignBounds.around(baseline, duty=motion)
    offered = dict(fluids) if fluids is not None else {"own": baseline.fluid}
    if not offered:
        raise InputError("fluids", expected="at least one fluid", found="none", where="design")
    if limits.package_length < 2.0 * motion.amplitude:
        raise InputError(
            "package_length",
            expected=f"at least the stroke, {2.0 * motion.amplitude:g} m",
            found=f"{limits.package_length:g} m",
            where="bounds",
        )
    found = {
        name: (problem, search(problem, seed=seed))
        for name, problem in (
            (name, Problem(motion, limits, fluid)) for name, fluid in offered.items()
        )
    }
    evaluations = sum(result.evaluations for _, result in found.values())
    start = DesignPoint(baseline, "own", motion)
    fitting = {name: pair for name, pair in found.items() if pair[1].feasible}
    if not fitting:
        problem, result = min(found.values(), key=lambda pair: pair[1].violation)
        return DesignResult(
            baseline=start, best=None, duty=motion, bounds=limits, front=(), active=(),
            elasticities=elasticities(baseline), conflicts=conflicts(problem, result.point),
            evaluations=evaluations, agreeing=result.agreeing, starts=result.starts,
            global_gap=None,
        )
    name = min(fitting, key=lambda key: fitting[key][1].value)
    problem, result = fitting[name]
    best = DesignPoint(problem.device(result.point), name, motion)
    alone = result.global_value
    traced: Sequence[DesignPoint] = ()
    if front:
        searches = {key: (pair[0], pair[1].point) for key, pair in fitting.items()}
        traced, more = trade_off(searches, start)
        evaluations += more
    return DesignResult(
        baseline=start, best=best, duty=motion, bounds=limits, front=tuple(traced),
        active=active_bounds(problem, result.point), elasticities=elasticities(best.device),
        conflicts=(), evaluations=evaluations, agreeing=result.agreeing, starts=result.starts,
        global_gap=None if alone is None else float(np.expm1(alone - result.value)),
    )


def trade_off(
    problems: Mapping[str, tuple[Problem, Array]], baseline: DesignPoint
) -> tuple[list[DesignPoint], int]:
    """Return the front of critical frequency, inertance and damping, and the evaluations it took.

    Parameters
    ----------
    problems : mapping of fluid name to (Problem, point)
        The problems that have a solution, each with its best point.
    baseline : DesignPoint
        Whose parasitic damping the limits are scaled with.

    Returns
    -------
    list of DesignPoint, by inertance and then damping
        No point is at least as good as another in all three and better in one.
    """
    points: list[DesignPoint] = []
    evaluations = 0
    for name, (problem, point) in problems.items():
        for ratio in FRONT_INERTANCE:
            near = point
            for limit in reversed(FRONT_DAMPING):
                changed = replace(
                    problem.bounds,
                    inertance=problem.bounds.inertance * ratio,
                    inertance_rule="equal",
                    damping=limit * baseline.damping,
                )
                narrowed = replace(problem, bounds=changed)
                result: SearchResult = search(narrowed, starts=2, near=near)
                evaluations += result.evaluations
                if not result.feasible:
                    break
                near = result.point
                points.append(DesignPoint(narrowed.device(near), name, problem.duty))
    return _undominated(points), evaluations


def _undominated(points: Sequence[DesignPoint]) -> list[DesignPoint]:
    """Return the points that no other one beats; of equal ones the first."""
    if not points:
        return []
    costs = np.array(
        [[p.critical_frequency("paper"), -p.device.inertance, p.damping] for p in points]
    )
    # Points that differ by the search's accuracy are the same design.
    costs = np.array([[float(f"{v:.6g}") for v in row] for row in costs])
    kept = []
    for i, cost in enumerate(costs):
        better = np.all(costs <= cost, axis=1) & np.any(costs < cost, axis=1)
        twin = np.all(costs[:i] == cost, axis=1)
        if not better.any() and not twin.any():
            kept.append(points[i])
    return sorted(kept, key=lambda p: (round(p.device.inertance, 3), p.damping))

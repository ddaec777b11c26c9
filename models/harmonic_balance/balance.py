"""The balance of every harmonic, and its Jacobian."""

from __future__ import annotations

import numpy as np

from models.checks import Array
from models.harmonic_balance.friction import Friction, rules
from models.harmonic_balance.problem import Problem, linear_matrix, relative_motion


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
    found = rules(problem, unknowns, state.force, omega, give=give)
    rows, columns, corner = [], [], []
    for j, law in enumerate(problem.forces):
        direction = problem.structure.directions[j]
        by_x, by_v = law.slopes(moved[j], velocity[j])
        own = problem.to_coefficients @ (
            by_x[:, None] * problem.to_samples + (omega * by_v)[:, None] * problem.slope
        )
        if law.stribeck:
            falling = law.limit(velocity[j])[1] * np.sign(state.force[j])
            falling = np.where(state.held[j], 0.0, falling)
            own += problem.from_cells @ ((omega * falling)[:, None] * problem.slope)
        matrix += np.einsum("i,k,ab->iakb", direction, direction, own)
        rule = found[j]
        if rule is None:
            continue
        for index in np.nonzero(state.held[j])[0]:
            line = rule.own[index] * problem.slope[index]
            line = line + rule.across[index] * problem.slope[rule.neighbour[index]]
            rows.append(np.outer(direction, omega * line).ravel())
            columns.append(np.outer(direction, problem.from_cells[:, index]).ravel())
            corner.append(-rule.yields[index])
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

"""Friction as a set: one unknown a sample, and the rule that ties it to the velocity.

The unknown l is the mean of friction over the sample's cell. Where the cell holds no zero of the
velocity, l is the limit L with the sign of v. Where the motion comes to rest in the cell, v = 0 and
l is anything within the limit. Where it reverses without resting, the zero lies between two
samples, a share t of the way from the first: friction there is L one way for a part of the cell and
the other way for the rest, so that l = 2 t L in the first cell or -2 (1 - t) L in the second. With
speeds p before and q after, and the velocity's kink at the zero (friction jumps by 2 L, the
acceleration by 2 L over the inertia, D over the step),

    p/t - q/(1 - t) = D,    or    p - (p + q + D) t + D t^2 = 0.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from models.checks import Array
from models.harmonic_balance.problem import Problem, dynamic_stiffness, relative_motion

_CLEAR = 0.05  # of the faster neighbour's speed, that the slower one of a reversal moves at
_SOFTEST = 1e-2  # of the top speed: the least slope of the rule that samples are sorted by


@dataclass(frozen=True)
class Friction:
    """State of the rubbing devices at the samples."""

    force: Array
    """(q, N) N, mean over the cell; zero for devices that do not rub."""
    held: NDArray[np.bool_]
    """(q, N) where the velocity has a zero in the cell: reversals and sticking."""


@dataclass(frozen=True)
class Rule:
    """What held samples have to satisfy, for one device."""

    gap: Array
    """(N,) m/s: zero where the rule holds; rises with the velocity, falls with the friction."""
    yields: Array
    """(N,) m/s per N: less its slope by friction."""
    own: Array
    """(N,) its slope by the sample's velocity."""
    across: Array
    """(N,) its slope by the neighbour's."""
    neighbour: NDArray[np.int64]
    """(N,) index of the sample across the zero."""


def friction_rule(
    velocity: Array,
    friction: Array,
    limit: float,
    jump: float,
    *,
    sharpest: float,
    give: float,
    creep: float,
) -> Rule:
    """Return the rule at all samples of one device, whether they are held or not.

    Parameters
    ----------
    velocity, friction : ndarray, shape (N,)
        m/s and N.
    limit : float
        L at rest, N.
    jump : float
        D, m/s.
    sharpest : float
        The most that D may be over p + q.
    give : float
        m/s per N: where not zero, v = give l for every held sample.
    creep : float
        m/s per N, added to keep the rule regular.
    """
    count = velocity.size
    before, after = np.roll(velocity, 1), np.roll(velocity, -1)
    forward = velocity * before > 0.0  # the zero comes after this sample
    neighbour = np.where(forward, np.arange(1, count + 1), np.arange(-1, count - 1)) % count
    ones = np.ones(count)
    plain = Rule(
        velocity - (give + creep) * friction, (give + creep) * ones, ones, 0.0 * ones, neighbour
    )
    if give:
        return plain
    size = np.maximum(np.abs(before), np.abs(after))
    least = np.minimum(np.abs(before), np.abs(after))
    through = (before * after < 0.0) & (least > _CLEAR * size)
    sign = np.sign(before)
    p = sign * np.where(forward, velocity, before)
    q = -sign * np.where(forward, after, velocity)
    # Next to sticking the speeds after the zero are small, and the rule has to stay monotonic.
    kink = np.minimum(jump, sharpest * (p + q))
    share = sign * friction / (2.0 * limit) + np.where(forward, 0.0, 1.0)
    gap = sign * (p - (p + q + kink) * share + kink * share**2)
    yields = (p + q + kink - 2.0 * kink * share) / (2.0 * limit)
    by_first, by_second = 1.0 - share, share
    return Rule(
        np.where(through, gap - creep * friction, plain.gap),
        np.where(through, yields + creep, plain.yields),
        np.where(through, np.where(forward, by_first, by_second), 1.0),
        np.where(through, np.where(forward, by_second, by_first), 0.0),
        neighbour,
    )


def kinks(problem: Problem, omega: float) -> Array:
    """Return D of each device, m/s: the change of velocity per sample that a reversal brings."""
    rate = 1j * omega * problem.samples
    inverse = np.linalg.inv(dynamic_stiffness(problem, np.array([rate]))[0])
    ways = problem.structure.directions
    mobility = abs(rate) ** 2 * np.abs(np.einsum("ji,ik,jk->j", ways, inverse, ways))
    step = 2.0 * np.pi / (omega * problem.samples)
    return np.asarray(2.0 * limits(problem) * mobility * step)


def limits(problem: Problem) -> Array:
    """Return friction at rest of each device, N; zero for those that do not rub."""
    zero = np.zeros(1)
    return np.array([law.limit(zero)[0][0] if law.rubs else 0.0 for law in problem.forces])


def rules(
    problem: Problem, unknowns: Array, friction: Array, omega: float, *, give: float = 0.0
) -> list[Rule | None]:
    """Return the rule of each device; None for those that do not rub."""
    _, velocity = relative_motion(problem, unknowns, omega)
    at_rest = limits(problem)
    if not at_rest.any():
        return [None] * at_rest.size
    kink = kinks(problem, omega)
    return [
        friction_rule(
            velocity[j], friction[j], at_rest[j], kink[j],
            sharpest=problem.sharpest, give=give, creep=problem.creep,
        )  # fmt: skip
        if law.rubs
        else None
        for j, law in enumerate(problem.forces)
    ]


def sort_friction(
    problem: Problem, unknowns: Array, friction: Array, omega: float, *, give: float = 0.0
) -> Friction:
    """Return which samples are held, and the friction of those that slide, from the state.

    With some `give`, m/s per N, friction reverses over a range of speed instead: a way to a first
    guess.
    """
    _, velocity = relative_motion(problem, unknowns, omega)
    force = np.zeros_like(velocity)
    held: NDArray[np.bool_] = np.zeros(velocity.shape, dtype=np.bool_)
    for j, rule in enumerate(rules(problem, unknowns, friction, omega, give=give)):
        if rule is None:
            continue
        law = problem.forces[j]
        level, _ = law.limit(velocity[j])
        at_rest = float(law.limit(np.zeros(1))[0][0])
        floor = _SOFTEST * float(np.abs(velocity[j]).max()) / at_rest + 1e-300
        trial = friction[j] + rule.gap / np.maximum(rule.yields, floor)
        held[j] = np.less(np.abs(trial), at_rest)
        force[j] = np.where(held[j], trial if give else friction[j], level * np.sign(trial))
    return Friction(force, held)


def held_gap(
    problem: Problem, unknowns: Array, state: Friction, omega: float, *, give: float = 0.0
) -> Array:
    """Return what held samples miss of their rule, (sum of held,) m/s, device by device."""
    found = rules(problem, unknowns, state.force, omega, give=give)
    parts = [r.gap[h] for r, h in zip(found, state.held, strict=True) if r is not None]
    return np.concatenate(parts) if parts else np.zeros(0)

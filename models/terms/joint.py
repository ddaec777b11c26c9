"""A joint in series with a device: a spring, play, or a limit of what it carries.

The device behind it is the mass and the resistance that fit its own force best on the motion; it
is driven through the joint and stepped in time to its steady state.
"""

from dataclasses import dataclass

import numpy as np
from numba import njit
from scipy.optimize import nnls

from models.checks import Array
from models.motion import Motion

_STEP = 0.15  # of the joint's natural period over 2 pi
_PASSES = 8  # at most, until a cycle ends as it began
_SETTLED = 3e-3
_SHORT = 2048  # samples of one cycle; longer periods of many cycles settle within one
_MOST_INNER = 60
_HARDEST = 8.0
_RIDGE = 1e-12
_SLOW = 0.002  # of the greatest speed, over which dry friction reverses in time stepping


@dataclass(frozen=True)
class Joint:
    """What is between the driven end and the device."""

    stiffness: float
    """N/m."""
    loss: float
    """Damping over twice the critical damping of the device's mass on the stiffness."""
    gap: float = 0.0
    """m, whole play."""
    lower: float = -np.inf
    """N, least force that it carries."""
    upper: float = np.inf
    """N, greatest force that it carries."""
    refilled: bool = False
    """True where what is lost at a limit is made up at once, as by a valve: the joint slips."""
    hardening: float = 0.0
    """N of force over which the spring grows twice as stiff; 0 for a linear one."""
    hardens: float = 0.0
    """1 or -1 where it does so only under positive or negative force, 0 where under both."""
    fluid_only: bool = False
    """True where dry friction is beside the joint and not behind it."""


def device_of(force: Array, motion: Motion) -> Array:
    """Return the device that fits a force best: mass, viscous, quadratic and dry resistance.

    In SI units; none is negative, and all are zero for a force that is not finite.
    """
    if not np.all(np.isfinite(force)):
        return np.zeros(4)
    v = motion.velocity
    columns = np.stack([motion.acceleration, v, v * np.abs(v), np.sign(v)])
    gram = columns @ columns.T
    scale = np.sqrt(np.diagonal(gram))
    scale = np.where(scale > 0.0, scale, 1.0)
    factor = np.linalg.cholesky(gram / np.outer(scale, scale) + _RIDGE * np.eye(4))
    seen = np.linalg.solve(factor, columns @ (force - force.mean()) / scale)
    return np.asarray(nnls(factor.T, seen)[0] / scale)


def through_joint(force: Array, motion: Motion, joint: Joint, device: Array) -> Array:
    """Return the force (N,) with a joint before a device whose own force is `force`.

    Parameters
    ----------
    force : ndarray, shape (N,)
        The device's force where the joint is rigid, N.
    motion : Motion
        Of the driven end.
    joint : Joint
        What it is driven through.
    device : ndarray, shape (4,)
        What `device_of` makes of the force.
    """
    mass, viscous, quadratic, dry = device
    if mass <= 0.0:
        return force
    v, x = motion.velocity, motion.displacement
    top = float(np.abs(v).max())
    behind = 0.0 if joint.fluid_only else dry
    rigid = mass * motion.acceleration + viscous * v + quadratic * v * np.abs(v)
    rigid = rigid + behind * np.clip(v / (_SLOW * top), -1.0, 1.0)
    natural = np.sqrt(joint.stiffness / mass)
    inner = int(np.clip(np.ceil(natural * motion.step / _STEP), 1, _MOST_INNER))
    stiffness = min(joint.stiffness, mass * (_STEP * 2.0 * inner / motion.step) ** 2)
    damping = 2.0 * joint.loss * np.sqrt(stiffness * mass)
    passes = 1 if not motion.periodic else (_PASSES if x.size <= _SHORT else 2)
    carried = _step(
        x, v, motion.step, inner, mass, viscous, quadratic, behind, _SLOW * top, stiffness,
        damping, 0.5 * joint.gap, joint.lower, joint.upper, int(joint.refilled), joint.hardening,
        joint.hardens, passes,
    )
    return np.asarray(force + carried - rigid)


@njit(cache=True, fastmath=True)  # type: ignore[untyped-decorator]
def _step(
    x: Array, v: Array, step: float, inner: int, mass: float, viscous: float, quadratic: float,
    dry: float, slow: float, stiffness: float, damping: float, half: float, lower: float,
    upper: float, refilled: int, hardening: float, hardens: float, passes: int,
) -> Array:
    """Return the force that the joint carries, (N,), mean over each sample's inner steps."""
    size = x.size
    result = np.empty(size)
    position, speed, slipped = x[0], v[0], 0.0
    stroke, pace_limit = np.max(np.abs(x)), np.max(np.abs(v))
    h = step / inner
    brake = h * dry / mass
    for turn in range(passes):
        was, was_speed = position - x[0] + slipped, speed
        for i in range(size):
            following = i + 1 if i + 1 < size else 0
            total = 0.0
            for k in range(inner):
                share = (k - 0.5 * inner) / inner
                if share >= 0.0:
                    end = x[i] + share * (x[following] - x[i])
                    pace = v[i] + share * (v[following] - v[i])
                else:
                    end = x[i] + share * (x[i] - x[i - 1])
                    pace = v[i] + share * (v[i] - v[i - 1])
                depth = end - position - slipped
                force = 0.0
                if depth > half:
                    force = stiffness * (depth - half) + damping * (pace - speed)
                    force = max(force, 0.0) if half > 0.0 else force
                elif depth < -half:
                    force = stiffness * (depth + half) + damping * (pace - speed)
                    force = min(force, 0.0) if half > 0.0 else force
                if hardening > 0.0 and (hardens == 0.0 or hardens * force > 0.0):
                    force *= 1.0 + min(abs(force) / hardening, _HARDEST)
                if refilled == 1 and (force < lower or force > upper):
                    slipped += (force - min(max(force, lower), upper)) / stiffness
                force = min(max(force, lower), upper)
                total += force
                speed += h * (force - (viscous + quadratic * abs(speed)) * speed) / mass
                if abs(speed) > slow + brake:  # friction implicitly: it never overshoots
                    speed -= brake if speed > 0.0 else -brake
                else:
                    speed /= 1.0 + brake / slow
                position += h * speed
            result[i] = total / inner
        moved = abs(position - x[0] + slipped - was)
        steady = moved < _SETTLED * stroke and abs(speed - was_speed) < _SETTLED * pace_limit
        if turn > 0 and steady:
            break
    return result

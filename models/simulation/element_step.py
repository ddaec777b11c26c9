"""One device over one step: the scalar equation for its speed at the end, friction exactly.

The rest of the structure acts on a device as u = a - G N(u): u the relative speed at the end of the
step, a its value without the device's nonlinear forces, G the response to an impulse, N the
impulse of those forces. N rises with u, so the root is unique. Coulomb friction enters as a set:
the device sticks, u = 0, where an impulse within the friction limit suffices (the soft threshold).
A reversal without sticking counts both directions, each for its share of the step, which keeps
second order through reversals.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from models.simulation.elements import (
    ASYMMETRIC,
    CUBIC,
    END_STOP,
    FRICTION,
    OFFSET,
    SMOOTH_FRICTION,
    STRIBECK,
    STRIBECK_SPEED,
)

_ITERATIONS = 80
_LINEAR = 1e-6  # of a transition speed, below which friction over it is a straight line
_JIT = {"cache": True, "error_model": "numpy", "forceinline": True}


@njit(**_JIT)
def knee_share(u, knee):  # type: ignore[no-untyped-def] # noqa: ANN001, ANN201
    """Return the share of friction at u transition speeds, and its slope, by their sharpness."""
    if u < _LINEAR:
        return u, 1.0
    if knee > 0.0:
        th = np.tanh(u**knee)
        return th ** (1.0 / knee), (1.0 - th * th) * (u / th ** (1.0 / knee)) ** (knee - 1.0)
    power = -2.0 * knee
    less, more = min(u, 1.0), max(u, 1.0)
    share = less * (less**power + more**-power) ** (-1.0 / power)
    return share, (share / u) ** (power + 1.0)


@njit(**_JIT)
def curved_force(v, curves, start, stop):  # type: ignore[no-untyped-def] # noqa: ANN001, ANN201
    """Return force and slope of the curves start..stop at speed v."""
    force, slope = 0.0, 0.0
    for i in range(start, stop):
        code, c, p = curves[i, 0], curves[i, 1], curves[i, 2]
        if code == SMOOTH_FRICTION and curves[i, 3] != 1.0:
            share, rise = knee_share(abs(v) / p, curves[i, 3])
            force += c * share * np.sign(v)
            slope += c * rise / p
        elif code == SMOOTH_FRICTION:
            th = np.tanh(v / p)
            force += c * th
            slope += c * (1.0 - th * th) / p
        elif code == ASYMMETRIC:
            side = curves[i, 3]
            if side * v >= 0.0:
                power = c * abs(v) ** p * (side if side != 0.0 else 1.0)
                force += power
                slope += p * power / v if v != 0.0 else (c if p == 1.0 else 0.0)
        elif code == END_STOP:
            continue
        elif p == 2.0:
            force += c * v * abs(v)
            slope += 2.0 * c * abs(v)
        elif v != 0.0:
            power = c * abs(v) ** (p - 1.0)
            force += power * v
            slope += power * p
    return force, slope


@njit(**_JIT)
def stop_force(x0, x1, stiffness, gap, power):  # type: ignore[no-untyped-def] # noqa: ANN001, ANN201
    """Return the mean force of an end stop from x0 to x1, whose work is exact, and its slope."""
    side = 1.0 if gap >= 0.0 else -1.0
    a, b = max(side * x0 - abs(gap), 0.0), max(side * x1 - abs(gap), 0.0)
    if a == 0.0 and b == 0.0:
        return 0.0, 0.0
    move = side * (x1 - x0)
    if abs(move) < 1e-6 * max(a, b):
        depth = 0.5 * (a + b)
        return side * stiffness * depth**power, 0.5 * stiffness * power * depth ** (power - 1.0)
    mean = stiffness * (b ** (power + 1.0) - a ** (power + 1.0)) / ((power + 1.0) * move)
    return side * mean, (stiffness * b**power - mean) / move


@njit(**_JIT)
def smooth_impulse(u, u0, x0, h, table, row, curves, start, stop):  # type: ignore[no-untyped-def] # noqa: ANN001, ANN201
    """Return impulse of the curves, of the position terms, and the slope of their sum."""
    mean = 0.5 * (u0 + u)
    impulse, slope = 0.0, 0.0
    if stop > start:
        force, rise = curved_force(mean, curves, start, stop)
        impulse, slope = h * force, 0.5 * h * rise
    position = h * table[row, OFFSET]
    for i in range(start, stop):
        if curves[i, 0] == END_STOP:
            force, rise = stop_force(x0, x0 + h * mean, curves[i, 1], curves[i, 2], curves[i, 3])
            position += h * force
            slope += 0.5 * h * h * rise
    if table[row, CUBIC] != 0.0:
        # The mean of k x^3 whose work is exactly the change of potential energy.
        x1 = x0 + h * mean
        position += 0.25 * h * table[row, CUBIC] * (x0 * x0 + x1 * x1) * (x0 + x1)
        slope += 0.125 * h * h * table[row, CUBIC] * (3.0 * x1 * x1 + 2.0 * x0 * x1 + x0 * x0)
    return impulse, position, slope


@njit(**_JIT)
def friction_share(u, u0, side, h, table, row):  # type: ignore[no-untyped-def] # noqa: ANN001, ANN201
    """Return impulse of sliding friction and its slope; side 0: reversal from u0 to u."""
    limit, rise = table[row, FRICTION], 0.0
    if table[row, STRIBECK] != 0.0:
        ratio = 0.5 * (u0 + u) / table[row, STRIBECK_SPEED]
        extra = table[row, STRIBECK] * np.exp(-ratio * ratio)
        limit += extra
        rise = -extra * ratio / table[row, STRIBECK_SPEED]
    if side != 0.0:
        return h * limit * side, h * rise * side
    gap = u - u0
    if gap == 0.0:
        return h * limit * np.sign(u0), 0.0
    share = (abs(u) - abs(u0)) / gap
    share_slope = (np.sign(u) - share) / gap
    return h * limit * share, h * (limit * share_slope + rise * share)


@njit(**_JIT)
def slide(u, u0, x0, a, g, h, side, table, row, curves, start, stop):  # type: ignore[no-untyped-def] # noqa: ANN001, ANN201
    """Return the root of u + G N(u) = a while sliding: Newton's method held in a bracket."""
    low, high = -np.inf, np.inf
    rub = table[row, FRICTION] != 0.0 or table[row, STRIBECK] != 0.0
    for _ in range(_ITERATIONS):
        impulse, position, slope = smooth_impulse(u, u0, x0, h, table, row, curves, start, stop)
        if rub:
            share, rise = friction_share(u, u0, side, h, table, row)
            impulse += share
            slope += rise
        residual = u + g * (impulse + position) - a
        if residual == 0.0:
            return u
        if residual > 0.0:
            high = min(high, u)
        else:
            low = max(low, u)
        rate = 1.0 + g * slope
        following = u - residual / rate if rate > 0.0 else u - residual
        if not (low <= following <= high):
            if np.isinf(low) or np.isinf(high):
                following = u - 2.0 * residual
            else:
                following = 0.5 * (low + high)
        if abs(following - u) <= 2e-16 * (abs(u) + abs(u0)):
            return following
        u = following
    return u


@njit(**_JIT)
def device_step(u0, x0, a, g, h, table, row, curves, start, stop):  # type: ignore[no-untyped-def] # noqa: ANN001, ANN201
    """Return speed at the end, impulses (curves, position, friction), and whether it sticks.

    Parameters are the relative speed u0 and displacement x0 at the start, a and G as in this
    file's head, the step h, the device's row in the table of coefficients
    and its range of curves.
    """
    limit = h * (table[row, FRICTION] + table[row, STRIBECK])
    bent = stop > start or table[row, CUBIC] != 0.0
    if limit == 0.0:
        if bent:
            u = slide(u0, u0, x0, a, g, h, 1.0, table, row, curves, start, stop)
        else:
            u = a - g * h * table[row, OFFSET]
        impulse, position, _ = smooth_impulse(u, u0, x0, h, table, row, curves, start, stop)
        return u, impulse, position, 0.0, False

    side = np.sign(u0)
    impulse, position, _ = smooth_impulse(0.0, u0, x0, h, table, row, curves, start, stop)
    # Impulse that friction must give for the speed to end at zero.
    needed = (a - g * (impulse + position)) / g
    if side == 0.0:
        if abs(needed) <= limit:
            return 0.0, impulse, position, needed, True
        side = np.sign(needed)
    elif table[row, STRIBECK] != 0.0:
        reach, _ = friction_share(0.0, u0, side, h, table, row)
        if (needed - reach) * side <= 0.0:
            side = 0.0
    elif (needed - limit * side) * side <= 0.0:
        side = 0.0
    if side == 0.0:
        # The speed comes to zero within the step. What would hold it there?
        push, shift, _ = smooth_impulse(u0, u0, x0, h, table, row, curves, start, stop)
        hold = (a - u0) / g - push - shift
        if hold * np.sign(u0) >= -limit:
            return 0.0, impulse, position, needed, True
    if bent or table[row, STRIBECK] != 0.0:
        start_at = u0 if side != 0.0 else -1e-3 * u0
        u = slide(start_at, u0, x0, a, g, h, side, table, row, curves, start, stop)
    else:
        free = a - g * h * table[row, OFFSET]
        rub = g * limit
        if side != 0.0:
            u = free - rub * side
        else:
            # (u - free)(u - u0) = rub (|u| - |u0|) mirrored to u0 > 0: one negative root.
            turn = np.sign(u0)
            p, w = free * turn, abs(u0)
            b = p + w + rub
            q = w * (p - rub)
            root = np.sqrt(b * b - 4.0 * q)
            u = turn * (2.0 * q / (b + root) if b > 0.0 else 0.5 * (b - root))
    impulse, position, _ = smooth_impulse(u, u0, x0, h, table, row, curves, start, stop)
    rubbed, _ = friction_share(u, u0, side, h, table, row)
    return u, impulse, position, rubbed, False

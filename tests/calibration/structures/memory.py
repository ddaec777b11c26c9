"""Friction with memory, run along the path itself: what it does depends on where motion turned."""

from __future__ import annotations

import numpy as np

Array = np.ndarray


def turns(x: Array) -> Array:
    """Return the places (T,) at which a path (M,) turns, with its first and last."""
    steps = np.sign(np.diff(x))
    moving = np.flatnonzero(steps)
    if moving.size == 0:
        return np.array([0, x.size - 1])
    changes = moving[1:][steps[moving[1:]] != steps[moving[:-1]]]
    return np.concatenate([[0], changes, [x.size - 1]])


def stops(x: Array, lengths: Array) -> Array:
    """Return elastic-then-slip states (S, M), -1 to 1, along a path (M,) from rest.

    Each is a spring that reaches its limit after a length (S,) of travel from zero and slides on.
    """
    result = np.zeros((lengths.size, x.size))
    state = np.zeros(lengths.size)
    corners = turns(x)
    for first, last in zip(corners[:-1], corners[1:], strict=True):
        gone = (x[first : last + 1] - x[first]) / lengths[:, None]
        result[:, first : last + 1] = np.clip(state[:, None] + gone, -1.0, 1.0)
        state = result[:, last]
    return result


def dahl(x: Array, length: float) -> Array:
    """Return Dahl's state (M,), dz/dx = (1 - z sign v)/length, along a path (M,) from rest."""
    result = np.zeros(x.size)
    state = 0.0
    corners = turns(x)
    for first, last in zip(corners[:-1], corners[1:], strict=True):
        side = 1.0 if x[last] >= x[first] else -1.0
        gone = np.abs(x[first : last + 1] - x[first])
        result[first : last + 1] = side + (state - side) * np.exp(-gone / length)
        state = float(result[last])
    return result


def lugre(x: Array, limit: Array, length: float, lag: float, step: float) -> Array:
    """Return LuGre friction over its sliding limit (M,) along a path (M,) from rest.

    length dz/dt = v - |v| z/g, F = z + lag dz/dt, integrated step by step; exact for a limit g
    that is constant over a step.

    Parameters
    ----------
    x : array, shape (M,)
        Displacement on an even grid of time, m.
    limit : array, shape (M,)
        g: friction at steady sliding over the sliding limit.
    length : float
        Deflection at which bristles slide, m.
    lag : float
        Of the micro-viscous part, s.
    step : float
        Of the grid, s.
    """
    travel = np.diff(x) / length
    bound = 0.5 * (limit[1:] + limit[:-1])
    kept = np.exp(-np.abs(travel) / bound)
    fresh = np.sign(travel) * bound * (1.0 - kept)
    state, states = 0.0, [0.0]
    for a, b in zip(kept.tolist(), fresh.tolist(), strict=True):
        state = a * state + b
        states.append(state)
    z = np.array(states)
    return z + lag * np.gradient(z, step)

"""A force as a curve of speed: lines between nodes, close to each other near rest."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Self

import numpy as np

from models.checks import Array, Indices
from models.compiled import compiled

_NODES = 24  # of each direction, beside that at rest
_TURNS = 2  # of taking what is left; the first alone rounds bends


@dataclass(frozen=True)
class SpeedCurves:
    """What gives forces of one motion as curves of its speed."""

    below: Indices
    """(N,) node below each sample's speed."""
    share: Array
    """(N,) how far it is on the way to the next."""
    weight: Array
    """(K,) of samples around each of K nodes."""
    nodes: Array
    """(K,) m/s."""

    @classmethod
    def of(cls, velocity: Array) -> Self:
        """Return those of a motion's speeds (N,), not all of them zero."""
        nodes = nodes_of(float(np.abs(velocity).max()))
        below = np.clip(np.searchsorted(nodes, velocity, side="right") - 1, 0, nodes.size - 2)
        share = (velocity - nodes[below]) / np.diff(nodes)[below]
        weight = _around(below, share, np.ones(velocity.size), nodes.size)
        return cls(below, share, weight, nodes)

    def fitted(self, force: Array) -> Array:
        """Return at the nodes (K,) what of a force (N,) is a curve of speed: its mean around each.

        Nodes without samples lie on a line between those with some. A mean never goes beyond what
        there is, as a fit of lines does beside a jump.
        """
        return np.asarray(_fitted(self.below, self.share, self.weight, self.nodes, force))


@compiled(cache=True, nogil=True)
def _fitted(below: Indices, share: Array, weight: Array, nodes: Array, force: Array) -> Array:
    known = weight > 0.0
    found, left = np.zeros(nodes.size), force.copy()
    for _ in range(_TURNS):
        mean = _around(below, share, left, nodes.size)[known]
        more = np.interp(nodes, nodes[known], mean / weight[known])
        found += more
        for i, node in enumerate(below):
            left[i] -= more[node] + share[i] * (more[node + 1] - more[node])
    return found


def nodes_of(top: float) -> Array:
    """Return the nodes' speeds up to `top`, (K,) m/s."""
    steps = np.arange(-_NODES, _NODES + 1) / _NODES
    return np.asarray(top * steps * np.abs(steps))


@compiled(cache=True, nogil=True)
def _around(below: Indices, share: Array, values: Array, count: int) -> Array:
    """Return sums (count,) of values (N,) around nodes, by how near each is."""
    found = np.zeros(count)
    for i, node in enumerate(below):
        found[node] += (1.0 - share[i]) * values[i]
        found[node + 1] += share[i] * values[i]
    return found

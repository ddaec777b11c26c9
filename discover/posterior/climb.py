"""The sizes of what no term explains: a grid in the logarithm, climbed from one start."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import product

import numpy as np

from discover.posterior.covariance import Sizes

STEP = 2.0
"""Ratio of neighbouring sizes."""
_LEAST, _MOST = -12, 0  # powers of STEP, of the force
_BETTER = 0.05  # nats, by which a move has to gain
_START = (-8, -10, -8)
_STRIDES = (4, 1)
_MOVES = sorted(
    (m for m in product((-1, 0, 1), repeat=3) if any(m)), key=lambda m: sum(map(abs, m))
)


@dataclass(frozen=True)
class Place:
    """A point of the grid: powers of two of the remainder, the loud error, and own friction."""

    powers: tuple[int, int, int] = _START
    """Of each size, over the force (friction: over what would make the whole of it)."""

    def sizes(self, friction: float) -> Sizes:
        """Return the sizes, with that of own friction that would make the whole force, N."""
        remainder, loud, own = (STEP**p for p in self.powers)
        return Sizes(remainder, loud, friction * own)

    def moved(self, move: tuple[int, int, int], stride: int = 1) -> Place:
        """Return a place that many powers away, kept within the grid."""
        return Place(
            tuple(  # type: ignore[arg-type]
                int(np.clip(p + stride * m, _LEAST, _MOST))
                for p, m in zip(self.powers, move, strict=True)
            )
        )


QUIET = Place((_LEAST, _LEAST, _LEAST))
"""Where a model explains all but noise."""


def climb(value: Callable[[Place], float], start: Place) -> Place:
    """Return the place that no neighbour beats, moving one size or two or three at a time.

    Parameters
    ----------
    value : callable
        Log evidence at a place, nats; asked for at every place that is looked at.
    start : Place
        Where to begin.
    """
    here, best = start, value(start)
    for stride in _STRIDES:
        moved = True
        while moved:
            moved = False
            for move in _MOVES:
                there = here.moved(move, stride)
                if there == here:
                    continue
                found = value(there)
                if found > best + _BETTER:
                    here, best, moved = there, found, True
                    break
    return here

"""The sizes of what no term explains: a grid in the logarithm, climbed from one start."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import product

import numpy as np

from discover.posterior.covariance import Sizes

STEP = 2.0
"""Ratio of neighbouring sizes."""
_LEAST, _MOST = -12, 0  # powers of STEP, of the force
_BETTER = 0.05  # nats, by which a move has to gain
_BEGIN = (-8, -8, -10)  # of the remainder, own friction, each independent error
_STRIDES = (4, 1)  # powers of STEP moved at once: coarse first, then fine
_TOGETHER = sorted(  # moves of one size, or of one up and another down by the same power
    (m for m in product((-1, 0, 1), repeat=3) if sum(map(abs, m)) == 1 or sorted(m) == [-1, 0, 1]),
    key=lambda m: sum(map(abs, m)),
)


@dataclass(frozen=True)
class Place:
    """A point of the grid."""

    powers: tuple[int, ...]
    """Powers of `STEP` of the remainder, of own friction, and of each kind of independent error:
    over the force (friction: over what would make the whole of it)."""
    flat: int | None = None
    """Power of an independent error that is the same in all rows; None without. It stands for
    whatever terms leave where they alone shall predict."""

    @property
    def remainder(self) -> int:
        """Power of the remainder."""
        return self.powers[0]

    @property
    def own(self) -> int:
        """Power of the friction that records have of their own."""
        return self.powers[1]

    @property
    def loudest(self) -> int:
        """Power of the greatest independent error."""
        return max(self.powers[2:])

    @classmethod
    def start(cls, kinds: int) -> Place:
        """Return where a search begins, with so many kinds of independent error."""
        return cls((*_BEGIN[:2], *[_BEGIN[2]] * kinds))

    @classmethod
    def quiet(cls, kinds: int) -> Place:
        """Return the place of a model that explains all but noise."""
        return cls((_LEAST,) * (2 + kinds))

    @property
    def unaided(self) -> list[Place]:
        """Places with nothing beside the terms but an error that is the same in all rows."""
        powers = (_LEAST,) * len(self.powers)
        return [Place(powers, flat) for flat in range(_LEAST, _MOST + 1)]

    def sizes(self, friction: float) -> Sizes:
        """Return the sizes, with that of own friction that would make the whole force, N."""
        remainder, own, *loud = (STEP**p for p in self.powers)
        flat = 0.0 if self.flat is None else STEP**self.flat
        return Sizes(remainder, (*loud, flat), friction * own)

    def moved(self, move: tuple[int, ...], stride: int = 1) -> Place:
        """Return a place that many powers away, kept within the grid."""
        return Place(
            tuple(
                int(np.clip(p + stride * m, _LEAST, _MOST))
                for p, m in zip(self.powers, move, strict=True)
            )
        )

    def towards(self, other: Place) -> Place:
        """Return the place half-way to another."""
        return Place(tuple((p + q) // 2 for p, q in zip(self.powers, other.powers, strict=True)))

    @property
    def around(self) -> list[Place]:
        """Return places with remainders and independent errors of all sizes, from none to all."""
        sizes = range(_LEAST, _MOST + 1, _STRIDES[0])
        kinds = len(self.powers) - 2
        return [Place((r, self.own, *[loud] * kinds)) for r in sizes for loud in sizes]

    @property
    def moves(self) -> list[tuple[int, ...]]:
        """Moves of one size or two: independent errors all together, and each alone."""
        kinds = len(self.powers) - 2
        together = [(r, f, *[loud] * kinds) for r, f, loud in _TOGETHER]
        if kinds < 2:
            return together
        alone = [
            (0, 0, *(sign * int(k == i) for k in range(kinds)))
            for i in range(kinds) for sign in (1, -1)
        ]
        return [*alone, *together]


def climb(value: Callable[[Place], float], start: Place, *, near: bool = False) -> Place:
    """Return the place that no neighbour beats.

    Sizes stand in for each other: where no size alone gains, one may go up as another goes down. A
    remainder and independent errors may each explain what is left, and the way from one to the
    other leads through places that explain nothing. So there is a second search, from the best of
    a coarse grid of both.

    Parameters
    ----------
    value : callable
        Log evidence at a place, nats; asked for at every place that is looked at.
    start : Place
        Where to begin.
    near : bool
        True where that is next to the place already: neither long strides nor a second search.
    """
    if near:
        return _climbed(value, start, _STRIDES[1:])[0]
    starts = (start, max(start.around, key=value))
    return max((_climbed(value, s, _STRIDES) for s in starts), key=lambda end: end[1])[0]


def _climbed(
    value: Callable[[Place], float], start: Place, strides: Sequence[int]
) -> tuple[Place, float]:
    """Return where one search ends, and the value there."""
    here, best = start, value(start)
    for stride in strides:
        moves = here.moves
        while moves:
            move = moves.pop(0)
            there = here.moved(move, stride)
            found = best if there == here else value(there)
            if found > best + _BETTER:
                here, best, moves = there, found, [move, *here.moves]  # on the same way first
    return here, best

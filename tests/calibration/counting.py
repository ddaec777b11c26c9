"""How many right answers a small part of a study has to hold."""

from __future__ import annotations

from collections.abc import Sequence

from scipy.stats import binom

CHANCE = 0.05
"""Of studies at their bar, the share that may fail at most."""


def fewest(asked: int, bar: float) -> int:
    """Return the least number of right answers that passes, of so many at a bar of 0 to 1.

    Raises
    ------
    ValueError
        Where none right would pass too: a bar over so few says nothing.
    """
    count = int(binom.ppf(CHANCE, asked, bar))
    if count < 1:
        raise ValueError(f"{asked} answers are too few for a bar of {bar:g}: none right passes")
    return count


def holds(hits: Sequence[bool], bar: float) -> bool:
    """Tell whether as many are right as at the bar in 19 of 20 such studies or more."""
    return sum(hits) >= fewest(len(hits), bar)

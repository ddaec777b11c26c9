"""A record's times in words: with the digits that tell its samples apart, of a clock too."""

from __future__ import annotations

import math


def digits_of(step: float) -> int:
    """Return how many decimals tell times apart that are `step` (s) apart.

    Examples
    --------
    >>> digits_of(0.0025), digits_of(0.01), digits_of(20.0)
    (3, 2, 0)
    """
    return max(0, math.ceil(-math.log10(step))) if step > 0.0 else 0


def time_text(time: float, step: float) -> str:
    """Return a time (s) of samples that are `step` (s) apart, as a `range` takes it.

    Examples
    --------
    >>> time_text(2.0, 0.005), time_text(1700000001.46325, 0.0025)
    ('2', '1700000001.463')
    """
    return f"{round(time, digits_of(step)):.15g}"

"""Channels that stay at their extreme value: clipped, where the signal had further to go."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from models.checks import Array

_LONGEST = 4  # samples at the extreme in a row, and twice as many in all, from which it is odd
_ABRUPT = 0.2  # of the top speed: a motion that rests has slowed down before


@dataclass(frozen=True)
class Pile:
    """Samples that lie on an extreme value."""

    end: str
    """"largest" or "smallest"."""
    value: float
    """In the signal's unit."""
    where: NDArray[np.bool_]
    """(N,) the samples."""


def clipping_text(force: Array) -> str:
    """Return what to tell about a force that stays at its extreme value, else an empty string.

    A smooth extreme passes through neighbouring values too, even when quantised; a clipped one
    piles its samples up on exactly one value.

    Examples
    --------
    >>> x = np.sin(np.arange(2000) / 50.0)
    >>> clipping_text(x), clipping_text(np.clip(x, -0.9, 0.9)) != ""
    ('', True)
    """
    return _text("force", "N", _piled(force), force.size)


def clipped_motion_text(displacement: Array) -> str:
    """Return what to tell about a displacement that is cut off, else an empty string.

    A drive may rest at its end of stroke, but it slows down before: only a stop from much of the
    top speed within one sample is a sensor's.

    Examples
    --------
    >>> x = np.sin(np.arange(2000) / 50.0)
    >>> clipped_motion_text(np.clip(x, -0.9, 0.9)) != ""
    True
    >>> clipped_motion_text(np.sin(0.5 * np.pi * x))  # rests at its ends, nearly
    ''
    """
    step = np.abs(np.diff(displacement))
    top = float(np.quantile(step, 0.99))
    cut = [pile for pile in _piled(displacement) if _edge_speed(step, pile) > _ABRUPT * top]
    return _text("displacement", "m", cut, displacement.size)


def _edge_speed(step: Array, pile: Pile) -> float:
    """Return how far a sample is from the next, in the usual case, just before and after a pile."""
    ends = np.flatnonzero(np.diff(pile.where.astype(np.int8)) < 0) + 1  # first steps away from it
    begins = np.flatnonzero(np.diff(pile.where.astype(np.int8)) > 0) - 1  # last whole ones to it
    beside = np.r_[begins[begins >= 0], ends[ends < step.size]]
    return float(np.median(step[beside])) if beside.size else 0.0


def _piled(values: Array) -> Iterator[Pile]:
    """Yield the extreme values that samples pile up on."""
    for sign, end in ((1.0, "largest"), (-1.0, "smallest")):
        signed = sign * values
        at_top = signed == signed.max()
        count = int(np.count_nonzero(at_top))
        edges = np.flatnonzero(np.diff(np.r_[0, at_top.astype(np.int8), 0]))
        if int((edges[1::2] - edges[::2]).max()) < _LONGEST or count < 2 * _LONGEST:
            continue
        below = signed[~at_top]
        # A quantised smooth peak has 2.4 times as many samples at its top value as at the next.
        if below.size and count > 6 * int(np.count_nonzero(below == below.max())):
            yield Pile(end, sign * float(signed.max()), at_top)


def _text(name: str, unit: str, piles: Iterable[Pile], size: int) -> str:
    parts = []
    for pile in piles:
        count = int(np.count_nonzero(pile.where))
        share = 100.0 * count / size
        parts.append(
            f"{pile.end} value {pile.value:.6g} {unit} for {count} samples ({share:.2g} %)"
        )
    if not parts:
        return ""
    return (
        f"the {name} stays at its " + " and its ".join(parts) + ": the channel looks clipped; "
        "raise its range and measure again, or leave the record out"
    )

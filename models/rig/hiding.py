"""Give each hidden effect its size: rms change in force over rms force, pooled over records."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from models.checks import Array, InputError
from models.rig.bench import Bench, Scales
from models.rig.effects import Effect
from models.rig.effects.effect import Values

_PRECISION = 5e-3
_EVALUATIONS = 40


@dataclass(frozen=True)
class Hidden:
    """An effect as it was hidden: the truth to judge an answer by."""

    effect: Effect
    """Which, in which form."""
    size: float
    """rms change in force over rms force, as asked for."""
    amount: float
    """What gives that size, in the effect's unit."""
    values: Values
    """Its other parameters, SI."""

    def change(self, bench: Bench, force: Array) -> Array:
        """Return the change (M,) of the force (M,) of one record, N."""
        return self.effect.change(bench, force, self.amount, self.values)


def hide(
    effect: Effect,
    size: float,
    benches: Sequence[Bench],
    scales: Scales,
    rng: np.random.Generator,
) -> Hidden:
    """Draw an effect's parameters and find the amount that gives its size.

    Parameters
    ----------
    effect : Effect
        What to hide.
    size : float
        rms change in force over rms force, pooled over all samples of all records.
    benches : sequence of Bench
        The records without it.
    scales : Scales
        Theirs.
    rng : Generator
        For the effect's parameters.

    Raises
    ------
    InputError
        Where no amount gives the size (a force can't fall by more than all of it).
    """
    values = effect.draw(rng, scales)
    forces = [bench.force for bench in benches]
    pairs = tuple(zip(benches, forces, strict=True))
    total = math.sqrt(sum(float(np.sum(force[bench.lead :] ** 2)) for bench, force in pairs))

    def reached(amount: float) -> float:
        change = 0.0
        for bench, force in pairs:
            change += float(np.sum(effect.change(bench, force, amount, values)[bench.lead :] ** 2))
        return math.sqrt(change) / total

    if effect.linear or effect.start is None:
        unit = reached(1.0)
        if not unit > 0.0:
            raise InputError(
                f"size of {effect.id}:{effect.form}",
                expected="an effect that acts in this campaign",
                found="no change in force",
            )
        return Hidden(effect, size, size / unit, values)
    amount = _search(reached, size, effect.start(scales), name=f"{effect.id}:{effect.form}")
    return Hidden(effect, size, amount, values)


def _search(reached: Callable[[float], float], size: float, start: float, *, name: str) -> float:
    """Return the amount at which `reached` is `size`, by bracketing and regula falsi in logs."""
    low = high = start
    value = reached(start)
    below, above = value, value
    for _ in range(_EVALUATIONS):
        if abs(value - size) <= _PRECISION * size:
            return high if value >= size else low
        if value < size:
            low, below = high, value
            high = high * 1.6
            value = above = reached(high)
            if value >= size:
                break
        else:
            high, above = low, value
            low = low / 1.6
            value = below = reached(low)
            if value < size:
                break
    else:
        raise InputError(f"size of {name}", expected="one that it can reach", found=f"{size}")
    for _ in range(_EVALUATIONS):
        for side, reading in ((low, below), (high, above)):
            if abs(reading - size) <= _PRECISION * size:
                return side
        share = (size - below) / (above - below) if above > below else 0.5
        amount = low * (high / low) ** min(max(share, 0.1), 0.9)
        value = reached(amount)
        if value < size:
            low, below = amount, value
        else:
            high, above = amount, value
    raise InputError(
        f"size of {name}",
        expected="one that it can reach",
        found=f"{size} (it jumps from {below:.4g} to {above:.4g})",
    )

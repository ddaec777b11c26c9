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
_JUMP = 0.03
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
    """Its other parameters, SI; of an effect at the seals, `reversal` is their half speed."""
    law: str = ""
    """Of an effect at the seals, by which law they reverse."""

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
    values, law = effect.draw(rng, scales), ""
    if effect.at_seals:
        seal = benches[0].law.seal
        values, law = values | {"reversal": seal.half_speed}, seal.reversal.name
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
        return Hidden(effect, size, size / unit, values, law)
    amount = _search(reached, size, effect.start(scales), name=f"{effect.id}:{effect.form}")
    return Hidden(effect, size, amount, values, law)


def _search(reached: Callable[[float], float], size: float, start: float, *, name: str) -> float:
    """Return the amount at which `reached` is `size`: bracketed, then the Illinois method in logs.

    Where impacts make the size jump by a little between neighbouring amounts, the nearest will do.
    """
    tried: dict[float, float] = {}

    def log_ratio(amount: float) -> float:
        value = max(reached(math.exp(amount)), 1e-12 * size)
        tried[amount] = abs(value / size - 1.0)
        return math.log(value / size)

    low = high = math.log(start)
    below = above = log_ratio(low)
    stride = 0.5
    while below > 0.0 or above < 0.0:
        if len(tried) > _EVALUATIONS:
            raise InputError(f"size of {name}", expected="one that it can reach", found=f"{size}")
        if above < 0.0:
            low, below = high, above
            high += stride
            above = log_ratio(high)
        else:
            high, above = low, below
            low -= stride
            below = log_ratio(low)
        stride = min(1.3 * stride, 3.0)
    side = 0
    while min(tried.values()) > _PRECISION and len(tried) < 2 * _EVALUATIONS and high - low > 1e-4:
        share = below / (below - above) if side < 3 and side > -3 else 0.5
        middle = low + share * (high - low)
        value = log_ratio(middle)
        if value < 0.0:
            low, below, side = middle, value, min(side, 0) - 1
            above = 0.5 * above if side < -1 else above
        else:
            high, above, side = middle, value, max(side, 0) + 1
            below = 0.5 * below if side > 1 else below
    best = min(tried, key=lambda amount: tried[amount])
    if tried[best] > _JUMP:
        raise InputError(
            f"size of {name}",
            expected="one that it can reach",
            found=f"{size} ({100.0 * tried[best]:.1f} % off at best)",
        )
    return math.exp(best)

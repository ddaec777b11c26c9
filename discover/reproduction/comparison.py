"""Identification both ways on records that stand in for the paper's experiments."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from discover.identification import (
    INERTIAL,
    ULTRA_LOW,
    Identification,
    Trial,
    identify_by_evolution,
    identify_by_projection,
)
from discover.motion_fit import observe
from discover.records import Record
from discover.reproduction.paper import Identified


@dataclass(frozen=True)
class StandIn:
    """A record in the place of one that isn't public."""

    identified: Identified
    """What the paper identified from its own record of this test."""
    record: Record
    """Measured on something else: a virtual test rig."""


@dataclass(frozen=True)
class IdentificationRow:
    """One record identified both ways."""

    identified: Identified
    """The paper's result, for its own record."""
    order_bounds: tuple[float, float]
    """The paper's bounds."""
    evolution: Identification
    """By the genetic algorithm."""
    projection: Identification
    """By variable projection."""
    free: Identification
    """By variable projection with the order free from 0 to 2."""

    @property
    def fewer(self) -> float:
        """Evaluations of the genetic algorithm over those of variable projection."""
        return self.evolution.evaluations / self.projection.evaluations

    @property
    def difference(self) -> float:
        """Largest relative difference of misfit, order and product."""
        a, b = self.evolution, self.projection
        pairs = ((a.objective, b.objective), (a.order, b.order), (a.product, b.product))
        return max(abs(p - q) / abs(q) for p, q in pairs)

    def to_dict(self) -> dict[str, Any]:
        """Return the row."""
        one = self.identified
        return {
            "record": one.condition.label,
            "paper": {"name": one.name, "order": one.order, "b0": one.b0},
            "order_bounds": list(self.order_bounds),
            "evolution": self.evolution.to_dict(),
            "projection": self.projection.to_dict(),
            "free_order": self.free.to_dict(),
            "evaluations_ratio": self.fewer,
            "relative_difference": self.difference,
        }


def compare_identification(
    stand_ins: Sequence[StandIn], *, seed: int = 0
) -> tuple[IdentificationRow, ...]:
    """Identify each record by the genetic algorithm and by variable projection.

    Parameters
    ----------
    stand_ins : sequence of StandIn
        Sine tests at the paper's conditions.
    seed : int
        Of the genetic algorithm.

    Returns
    -------
    tuple of IdentificationRow
        The paper's bounds: order 0 to 1.5 for M1's record, 1.5 to 2 for the others; b0 0 to 30;
        friction fixed at the device's.
    """
    rows = []
    for item in stand_ins:
        seen = observe(item.record)
        trials = [Trial(seen.motion, seen.measured)]
        device = item.identified.condition.device
        bounds = ULTRA_LOW if item.identified.order < ULTRA_LOW[1] else INERTIAL
        rows.append(
            IdentificationRow(
                item.identified,
                bounds,
                identify_by_evolution(trials, device, order_bounds=bounds, seed=seed),
                identify_by_projection(trials, device, order_bounds=bounds),
                identify_by_projection(trials, device, order_bounds=(0.0, 2.0)),
            )
        )
    return tuple(rows)

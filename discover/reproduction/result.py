"""Everything that `inerter reproduce` shows, as one frozen value."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from discover._version import __version__
from discover.reproduction.claims import Claim, all_claims
from discover.reproduction.comparison import IdentificationRow, StandIn, compare_identification
from discover.reproduction.figures import PaperFigure, paper_figures
from discover.reproduction.orders import OrderCurve, OrderPoint, order_curve, order_points
from discover.reproduction.paper import CITATION
from discover.reproduction.tables import (
    BoundaryRow,
    ComparisonRow,
    DeviceRow,
    ExperimentRow,
    critical_frequencies,
    table_1,
    table_2,
    table_3,
)


@dataclass(frozen=True)
class Reproduction:
    """The paper's tables, figures and claims beside what its formulas give."""

    devices: tuple[DeviceRow, ...]
    """Table 1."""
    experiments: tuple[ExperimentRow, ...]
    """Table 2."""
    comparisons: tuple[ComparisonRow, ...]
    """Table 3."""
    boundaries: tuple[BoundaryRow, ...]
    """Critical frequencies."""
    figures: tuple[PaperFigure, ...]
    """Figures 2 to 5 and 7 to 9."""
    claims: tuple[Claim, ...]
    """Every claim with its verdict."""
    curve: OrderCurve
    """Order over Womersley number."""
    orders: tuple[OrderPoint, ...]
    """The identified orders beside it."""
    identification: tuple[IdentificationRow, ...]
    """Both methods on stand-in records; empty where none were given."""
    seed: int
    """Of the genetic algorithm."""

    @property
    def counts(self) -> dict[str, int]:
        """Number of claims by verdict."""
        counted = Counter(str(claim.verdict) for claim in self.claims)
        return {name: counted[name] for name in ("reproduced", "not-reproduced", "unverifiable")}

    def to_dict(self) -> dict[str, Any]:
        """Return the document ``reproduction.json``."""
        return {
            "schema": "inerter.reproduction/1",
            "version": __version__,
            "seed": self.seed,
            "campaign": {"title": "Chen and Chen 2025, reproduced and questioned", "hash": ""},
            "citation": CITATION,
            "counts": self.counts,
            "tables": {
                "table_1": [row.to_dict() for row in self.devices],
                "table_2": [row.to_dict() for row in self.experiments],
                "table_3": [row.to_dict() for row in self.comparisons],
                "critical_frequencies": [row.to_dict() for row in self.boundaries],
                "orders": [point.to_dict() for point in self.orders],
            },
            "claims": [claim.to_dict() for claim in self.claims],
            "identification": [row.to_dict() for row in self.identification],
        }


def reproduce(stand_ins: Sequence[StandIn] = (), *, seed: int = 0) -> Reproduction:
    """Return the paper's tables, figures and claims recomputed.

    Parameters
    ----------
    stand_ins : sequence of StandIn
        Records in the place of the paper's experiments, for identification; none by default.
    seed : int
        Of the genetic algorithm.

    Examples
    --------
    >>> reproduce().counts["unverifiable"]
    6
    """
    return Reproduction(
        devices=table_1(),
        experiments=table_2(),
        comparisons=table_3(),
        boundaries=critical_frequencies(),
        figures=paper_figures(),
        claims=all_claims(),
        curve=order_curve(),
        orders=order_points(),
        identification=compare_identification(stand_ins, seed=seed),
        seed=seed,
    )

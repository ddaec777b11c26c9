"""A statement of the paper and what its own formulas say of it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal

Verdict = Literal["reproduced", "not-reproduced", "unverifiable"]
Value = float | str | None


@dataclass(frozen=True)
class Claim:
    """A statement with its verdict and the figure that decides it.

    Examples
    --------
    >>> claim = Claim("sum", "two and two", "reproduced", 4.0, 4.0, "kg", "Eq. 1", "addition")
    >>> claim.to_dict()["id"]
    'sum'
    """

    id: str
    """Stable name."""
    text: str
    """What the paper states, in our words."""
    verdict: Verdict
    """"reproduced", "not-reproduced" or "unverifiable", as computed."""
    printed: Value
    """The paper's value."""
    computed: Value
    """What its formulas give."""
    unit: str
    """Unit of both; "" where dimensionless or in words."""
    where: str
    """Where in the paper."""
    decided_by: str
    """What decides the verdict, with its limit, in one sentence."""

    def to_dict(self) -> dict[str, Any]:
        """Return the entry of `claims` in ``reproduction.json``."""
        return {
            "id": self.id,
            "text": self.text,
            "verdict": self.verdict,
            "printed": self.printed,
            "computed": self.computed,
            "unit": self.unit,
            "where": self.where,
            "decided_by": self.decided_by,
        }


def verdict(*, holds: bool) -> Verdict:
    """Return the verdict of a statement that can be checked."""
    return "reproduced" if holds else "not-reproduced"

"""Which numbers of several answers differ by more than their intervals allow.

The test of homogeneity: W. G. Cochran, *Biometrics* 10 (1954) 101. Answers that rest on the same
records are not independent; it then finds fewer differences than there are.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from discover.compare.side import Side, SideBand
from models.terms import TERMS

_NORMAL = 1.959963984540054  # of 95 %, two-sided
_LEVEL = 0.05

Interval = tuple[float, float]
Entry = Mapping[str, Any]


@dataclass(frozen=True)
class Difference:
    """One quantity in every answer."""

    band: str
    """Which bands are compared, in words."""
    term: str
    """Id of the term."""
    quantity: str
    """"coefficient", or a shape parameter."""
    units: tuple[str, ...]
    """SI unit in each answer; "" where it has none or lacks the term."""
    values: tuple[float | None, ...]
    """In each answer; None where it lacks the term."""
    intervals: tuple[Interval | None, ...]
    """95 % of each; None where not known."""
    p: float | None
    """Of one value behind all; None where that can't be told."""
    why: str
    """Why not; else ""."""

    @property
    def differs(self) -> bool | None:
        """Whether the values differ at the level of 5 %; None where that can't be told."""
        return None if self.p is None else self.p < _LEVEL

    def to_dict(self) -> dict[str, Any]:
        """Return the document's entry."""
        return {
            "band": self.band,
            "term": self.term,
            "quantity": self.quantity,
            "values": [
                None if v is None else {"value": v, "interval": None if i is None else list(i),
                                        "unit": u}
                for v, i, u in zip(self.values, self.intervals, self.units, strict=True)
            ],
            "differs": self.differs,
            "p": self.p,
            "why": self.why,
        }  # fmt: skip


def homogeneous(values: Sequence[float], intervals: Sequence[Interval | None]) -> float | None:
    """Return how probable so different values are where one value is behind all.

    Parameters
    ----------
    values : sequence of float
        At least two.
    intervals : sequence of (float, float) or None
        95 %; None of a value that is given without.

    Returns
    -------
    float or None
        None where fewer than all but one have an interval of any width.

    Examples
    --------
    >>> round(homogeneous([1.0, 1.0 + 1.96 * 2**0.5], [(-0.96, 2.96), (1.81, 5.73)]), 2)
    0.05
    >>> homogeneous([1.0, 2.0], [None, None]) is None
    True
    """
    from scipy.stats import chi2

    x = np.asarray(values, dtype=float)
    widths = [0.0 if i is None else i[1] - i[0] for i in intervals]
    spread = np.array(widths) / (2.0 * _NORMAL)
    exact = spread <= 0.0
    if exact.sum() > 1:
        return None
    if exact.any():
        middle = float(x[exact][0])
    else:
        middle = float(np.sum(x / spread**2) / np.sum(1.0 / spread**2))
    square = float(np.sum(((x - middle)[~exact] / spread[~exact]) ** 2))
    return float(chi2.sf(square, x.size - 1))


def differences(sides: Sequence[Side]) -> list[Difference]:
    """Return every quantity of every pair of matching bands.

    Bands match by their place where all answers have as many, else by their structure.
    """
    found = []
    for name, bands in _matched(sides):
        ids = list(dict.fromkeys(t["id"] for b in bands if b is not None for t in b.terms))
        for identifier in ids:
            terms = [None if b is None else _term(b, identifier) for b in bands]
            names = [k.removesuffix("_interval") for t in terms if t for k in t
                     if k.endswith("_interval")]  # fmt: skip
            for quantity in dict.fromkeys(["coefficient", *names]):
                found.append(_difference(name, identifier, quantity, terms, sides))
    return found


def _matched(sides: Sequence[Side]) -> list[tuple[str, list[SideBand | None]]]:
    counts = {len(s.bands) for s in sides}
    if len(counts) == 1:
        count = counts.pop()
        names = ["everywhere"] if count == 1 else [f"band {i}" for i in range(1, count + 1)]
        return [(n, [s.bands[i] for s in sides]) for i, n in enumerate(names)]
    structures = list(dict.fromkeys(b.structure for s in sides for b in s.bands))
    return [
        (f"where {structure} holds",
         [next((b for b in s.bands if b.structure == structure), None) for s in sides])
        for structure in structures
    ]  # fmt: skip


def _term(band: SideBand, identifier: str) -> Entry | None:
    return next((t for t in band.terms if t["id"] == identifier), None)


def _difference(
    band: str,
    identifier: str,
    quantity: str,
    terms: Sequence[Entry | None],
    sides: Sequence[Side],
) -> Difference:
    key = "interval" if quantity == "coefficient" else f"{quantity}_interval"
    values = tuple(None if t is None or t.get(quantity) is None else float(t[quantity])
                   for t in terms)  # fmt: skip
    intervals = tuple(_pair(t.get(key)) if t is not None else None for t in terms)
    units = tuple(_unit(t, quantity) for t in terms)
    there = [i for i, v in enumerate(values) if v is not None]
    p, why = None, ""
    if len(there) < 2:
        why = "only in " + " and ".join(sides[i].name for i in there)
    elif len({units[i] for i in there}) > 1:
        why = "their units differ with their shapes"
    else:
        p = homogeneous(
            [v for v in values if v is not None], [intervals[i] for i in there]
        )
        why = "" if p is not None else "at most one has an interval"
        if p is None and all(intervals[i] is None for i in there):
            why = "none has an interval"
    return Difference(band, identifier, quantity, units, values, intervals, p, why)


def _unit(term: Entry | None, quantity: str) -> str:
    if term is None:
        return ""
    if quantity == "coefficient":
        return str(term["unit"])
    known = TERMS.get(str(term["id"]))
    named = () if known is None else known.parameters
    return next((p.unit for p in named if p.name == quantity), "")


def _pair(ends: Any) -> Interval | None:
    if ends is None or ends[0] is None or ends[1] is None:
        return None
    return float(ends[0]), float(ends[1])

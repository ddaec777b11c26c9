"""Friction whose curve is a sum of parts, as one row of a table and one summand of an equation."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

from discover.shape_words import shape
from discover.words import listed, significant
from models.cores import FRICTION

_SAME = 1e-3  # of relative intervals


def whole_friction(terms: Sequence[Mapping[str, Any]]) -> list[dict[str, Any]]:
    """Return terms with friction's parts made one, whose ``parts`` say in words what they are.

    Where the parts share one size, whose interval scales them all, the ends of their intervals add
    up; where each has its own, the whole's interval is not told by theirs and is left out.

    Parameters
    ----------
    terms : sequence of mapping
        As in a document.

    Examples
    --------
    >>> part = {"id": "coulomb-friction", "unit": "N"}
    >>> parts = [{**part, "coefficient": 100.0, "transition_speed": 0.001},
    ...          {**part, "coefficient": 20.0, "presliding": 2e-5}]
    >>> (whole,) = whole_friction(parts)
    >>> whole["coefficient"], whole["parts"]
    (120.0, '100 N (transition speed 1 mm/s) and 20 N (presliding over 0.02 mm)')
    """
    parts = [t for t in terms if t["id"] == FRICTION]
    if len(parts) < 2:
        return [dict(t) for t in terms]
    whole: dict[str, Any] = {
        "id": FRICTION,
        "coefficient": sum(p["coefficient"] for p in parts),
        "unit": parts[0]["unit"],
        "parts": listed(
            f"{significant(p['coefficient'], 3)} {p['unit']} ({shape(p) or 'a jump'})"
            for p in parts
        ),
    }
    ends = [p.get("interval") for p in parts]
    if all(ends) and _one_size(parts):
        whole["interval"] = [sum(e[i] for e in ends if e) for i in (0, 1)]
    first = list(terms).index(parts[0])
    rest = [dict(t) for t in terms if t["id"] != FRICTION]
    return [*rest[:first], whole, *rest[first:]]


def _one_size(parts: Sequence[Mapping[str, Any]]) -> bool:
    """Tell whether one number scales all parts: their relative intervals are the same."""
    relative = [
        [end / p["coefficient"] for end in p["interval"]] for p in parts if p["coefficient"]
    ]
    return len(relative) == len(parts) and all(
        math.isclose(a, b, rel_tol=_SAME)
        for r in relative[1:]
        for a, b in zip(r, relative[0], strict=True)
    )

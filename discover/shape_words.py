"""A term's shape parameters as a person reads them."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

from discover.words import quantity
from models.terms import TERMS
from models.terms.term import Parameter

_ALWAYS = ("order", "exponent")  # shown at their defaults too
_AFTER = {"over": "tests", "relative_speed": "of the test's greatest speed"}
_NAMES = {
    "relative_speed": "transition speed",
    "presliding": "presliding over",
    "stribeck_velocity": "Stribeck velocity",
}
_OF_A_TEST = ("over", "only")
_BETWEEN_TESTS = ("from_test", *_OF_A_TEST)


def shape(term: Mapping[str, Any]) -> str:
    """Return a term's shape parameters with their intervals.

    The end of an interval that lies at a bound of what is sensible, or beyond, says nothing of the
    value and is not told.

    Examples
    --------
    >>> shape({"id": "fractional-derivative", "order": 1.48, "order_interval": [1.42, 1.55]})
    'order 1.48 (1.42 to 1.55)'
    >>> shape({"id": "coulomb-friction", "transition_speed": 0.002, "presliding": 0.0})
    'transition speed 2 mm/s'
    >>> shape({"id": "coulomb-friction", "presliding": 2.4e-5, "form": 1.0})
    'presliding over 0.024 mm, an elastic slider'
    >>> shape({"id": "sensor-gain", "load": 151.5, "load_power": 2.0, "from_test": 3.0})
    "from test 3, at a force of 152 N, with the force's size to the power 2"
    >>> shape({"id": "thermal-drift", "from_test": 2.0, "over": 7.0})
    'from test 2, over 7 tests'
    >>> shape({"id": "sensor-drift", "over": 1.0, "only": 3.0})
    'in test 3 only'
    >>> shape({"id": "sensor-drift", "over": 0.0, "power": 1.0, "only": 3.0})
    'power 1, in test 3 only'
    >>> stop = {"id": "series-compliance", "load_share": 0.4, "half_load": 900.0}
    >>> shape({**stop, "load_share_interval": [-2.6, 0.97]})
    'half load 900 N, load share 0.4 (at least −2.6)'
    >>> shape({**stop, "load_share_interval": [-3.4, 0.97]})
    'half load 900 N, load share undetermined'
    """
    parts = []
    known = TERMS.get(str(term.get("id")))
    alone = float(term.get("only") or 0.0)
    described = known is not None and known.described is not None
    for parameter in () if known is None else known.parameters:
        name = parameter.name
        value = term.get(name)
        growing = bool(alone) and name == "power" and not term.get("over")
        if value is None or (value == parameter.default and name not in _ALWAYS and not growing):
            continue
        covered = described and not parameter.fitted and name not in _BETWEEN_TESTS
        if covered or (alone and name in _OF_A_TEST):
            continue
        ends = _told_ends(parameter, term.get(f"{name}_interval"))
        text = quantity(value, parameter.unit or _AFTER.get(name, ""), ends, 4)
        if ends == (None, None):
            text = "undetermined"
        parts.append(f"{_NAMES.get(name, name.replace('_', ' '))} {text}")
    if known is not None and known.described is not None:
        given = {p.name: float(term.get(p.name, p.default)) for p in known.parameters}
        parts += [text] if (text := known.described(given)) else []
    if alone:
        parts.append(f"in test {alone:g} only")
    return ", ".join(parts)


def _told_ends(
    parameter: Parameter, ends: Sequence[float | None] | None
) -> tuple[float | None, float | None] | None:
    """Return an interval without the ends that a parameter's bounds give and no record does.

    Where the bounds are parts of a campaign's amplitude, of the lower one the sign alone is known.
    """
    if not ends:
        return None
    low, high = ends
    least, most = parameter.lower, parameter.upper
    if parameter.scaled_by:
        least, most = 0.0 if least >= 0.0 else -math.inf, math.inf
    return (
        None if low is None or low <= least else low,
        None if high is None or high >= most else high,
    )

"""A term's shape parameters as a person reads them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from discover.words import interval, significant
from models.terms import TERMS

_ALWAYS = ("order", "exponent")  # shown at their defaults too
_COUNTED = {"over": "tests"}
_OF_A_TEST = ("over", "only")


def shape(term: Mapping[str, Any]) -> str:
    """Return a term's shape parameters with their intervals.

    Examples
    --------
    >>> shape({"id": "fractional-derivative", "order": 1.48, "order_interval": [1.42, 1.55]})
    'order 1.48 (1.42 to 1.55)'
    >>> shape({"id": "coulomb-friction", "transition_speed": 0.002, "presliding": 0.0})
    'transition speed 0.002 m/s'
    >>> shape({"id": "thermal-drift", "from_test": 2.0, "over": 7.0})
    'from test 2, over 7 tests'
    >>> shape({"id": "sensor-drift", "over": 1.0, "only": 3.0})
    'in test 3 only'
    >>> shape({"id": "sensor-drift", "over": 0.0, "power": 1.0, "only": 3.0})
    'power 1, in test 3 only'
    """
    parts = []
    known = TERMS.get(str(term.get("id")))
    alone = float(term.get("only") or 0.0)
    for parameter in () if known is None else known.parameters:
        name = parameter.name
        value = term.get(name)
        growing = bool(alone) and name == "power" and not term.get("over")
        if value is None or (value == parameter.default and name not in _ALWAYS and not growing):
            continue
        if alone and name in _OF_A_TEST:
            continue
        unit = parameter.unit or _COUNTED.get(name, "")
        unit_text = f" {unit}" if unit else ""
        text = f"{name.replace('_', ' ')} {significant(value, 4)}{unit_text}"
        spread = interval(term.get(f"{name}_interval"), 4)
        parts.append(f"{text} ({spread})" if spread else text)
    if alone:
        parts.append(f"in test {alone:g} only")
    return ", ".join(parts)

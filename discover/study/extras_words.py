"""What a device has beside its structures, in words: each effect with its numbers, how surely."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from discover.shape_words import shape
from discover.words import (
    counted,
    in_parts,
    listed,
    probability,
    quantity,
    short_name,
    spread,
    zero_possible,
)
from models.terms.between_tests import ONLY, OVER


def extras(document: Mapping[str, Any]) -> list[Mapping[str, Any]]:
    """Return what the device has beside its structures, each once with its numbers."""
    seen: list[Mapping[str, Any]] = []
    for band in document["bands"]:
        for extra in band.get("extras", ()):
            if not any(_same_effect(extra, e) for e in seen):
                seen.append(extra)
    return seen


def _same_effect(one: Mapping[str, Any], other: Mapping[str, Any]) -> bool:
    return all(one[key] == other[key] for key in ("id", "coefficient"))


def extras_line(document: Mapping[str, Any]) -> str:
    """Say what stands beside the structures, with numbers and how surely; "" for nothing."""
    groups: dict[str, list[Mapping[str, Any]]] = {}
    for extra in extras(document):
        groups.setdefault(str(extra["id"]), []).append(extra)
    return f"Beside it: {'; '.join(_extra(g) for g in groups.values())}." if groups else ""


def _extra(group: Sequence[Mapping[str, Any]]) -> str:
    """Say an effect, of which there may be several, as one of each record.

    Of those of each test the range is told, where tests are more than a sentence has room for.
    """
    alike: dict[str, list[Mapping[str, Any]]] = {}
    for extra in group:
        alike.setdefault(_shape(extra, ONLY.name), []).append(extra)
    sizes = []
    for some in alike.values():
        if len(some) > _FEW_TESTS:
            told = f"{_sizes(some)} in {counted(len(some), 'test')}, each its own"
            sizes.append(", ".join(filter(None, (told, _shape(some[0], ONLY.name, OVER.name)))))
            continue
        for extra in some:
            size = quantity(extra["coefficient"], extra["unit"], extra["interval"])
            sizes.append(", ".join(filter(None, (size, _shape(extra)))))
    possibly = "possibly " if all(zero_possible(e["interval"]) for e in group) else ""
    text = f"{possibly}{short_name(str(group[0]['id']))} {'; '.join(sizes)}"
    text += f", {probability(group[0]['probability'])} sure"
    others = [
        f"{short_name(str(a['effect']))} ({probability(a['probability'])})"
        for a in group[0].get("alternatives", ())
    ]
    return f"{text}, or {listed(others, last='or')}" if others else text


_FEW_TESTS = 3  # whose own values are told one by one


def _shape(extra: Mapping[str, Any], *but: str) -> str:
    """Return an effect's shape parameters in words, without intervals and those left out."""
    left_out = tuple(f"{key}_interval" for key in extra) + but
    return shape({key: value for key, value in extra.items() if key not in left_out})


def _sizes(some: Sequence[Mapping[str, Any]]) -> str:
    """Return the least and the greatest coefficient of some effects of one unit."""
    values = [float(e["coefficient"]) for e in some]
    unit, factor = in_parts(max(values, key=abs), str(some[0]["unit"]))
    text = spread([factor * min(values), factor * max(values)])
    return text if unit in ("", "1") else f"{text} {unit}"

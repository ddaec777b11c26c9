"""What pooling over a fleet changed, in words and as the page shows it."""

from __future__ import annotations

import math
import statistics
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from discover.plots.fleet_pooled import alone_and_pooled
from discover.report.fleet_quantity import pictured, quantity_name
from discover.words import (
    capitalize_first,
    counted,
    interval,
    percent,
    probability,
    significant,
)

_MOST_NAMED = 3  # changes of ways that a line holds


def pooling_lines(pooling: Mapping[str, Any]) -> list[str]:
    """Return what pooling changed, in lines.

    Parameters
    ----------
    pooling : mapping
        As in ``batch.json``.
    """
    if not pooling["quantities"] and not pooling["choices"]:
        return ["Pooled: nothing: no two devices that were studied have an answer in common."]
    lines = []
    widths = [(w, v, q) for q in pooling["quantities"] for w, v in _widths(q)]
    if widths:
        least, value, q = min(widths, key=lambda entry: entry[0])
        devices = len({v["campaign"] for _, v, _ in widths})
        lines.append(
            f"Pooled: {counted(len(widths), 'value')} of {counted(devices, 'device')}; of the"
            f" width that they have alone, 95 % intervals have"
            f" {_share(statistics.median(w for w, _, _ in widths))} (median), at least"
            f" {_share(least)} ({value['campaign']}, {quantity_name(q)})."
        )
    changed = [
        f"{c['campaign']}, {c['name']}: {c['way']} {_arrow(c)}" for c in _changes(pooling)
    ]
    if changed:
        count = len(changed)
        more = len(changed) - _MOST_NAMED
        if more > 0:
            changed = [*changed[:_MOST_NAMED], f"{counted(more, 'other')} on the page"]
        lines.append(f"Pooled probabilities: {count} read otherwise: {'; '.join(changed)}.")
    elif pooling["choices"]:
        lines.append("Pooled probabilities: as alone.")
    return lines


def _share(value: float) -> str:
    return percent(100.0 * value)


def _arrow(change: Mapping[str, Any]) -> str:
    then = "" if change["before"] == change["way"] else f", {change['before']} alone"
    return f"{probability(change['alone'])} to {probability(change['pooled'])}{then}"


def _widths(q: Mapping[str, Any]) -> Iterator[tuple[float, Mapping[str, Any]]]:
    """Yield how wide each value's pooled interval is over its own alone, with the value."""
    for v in q["values"]:
        (low, high), (first, last) = (
            [math.log(t[e]) if q["logarithmic"] else t[e] for e in ("lower", "upper")]
            for t in (v["pooled"], v["alone"])
        )
        yield (high - low) / (last - first), v


def _changes(pooling: Mapping[str, Any]) -> list[dict[str, Any]]:
    """Return the likeliest ways that read otherwise than alone, what changed most first."""
    found = []
    for choice in pooling["choices"]:
        for v in choice["values"]:
            now = max(v["ways"], key=lambda w: w["pooled"])
            before = max(v["ways"], key=lambda w: w["alone"])
            if now is before and probability(now["pooled"]) == probability(now["alone"]):
                continue
            found.append(
                {"campaign": v["campaign"], "name": choice["name"], **now, "before": before["way"]}
            )
    return sorted(found, key=lambda c: -round(abs(c["pooled"] - c["alone"]), 2))


def pooling_shown(pooling: Mapping[str, Any]) -> dict[str, Any]:
    """Return what the page's section on pooling needs.

    Parameters
    ----------
    pooling : mapping
        As in ``batch.json``.
    """
    quantities = []
    ranked: Sequence[Mapping[str, Any]] = sorted(
        pooling["quantities"], key=lambda q: min(w for w, _ in _widths(q))
    )
    for number, q in enumerate(ranked):
        widths = list(_widths(q))
        least, narrowest = min(widths, key=lambda entry: entry[0])
        quantities.append(
            {**pictured(q, number, alone_and_pooled, "pooled"),
             "median_width": 100.0 * statistics.median(w for w, _ in widths),
             "least_width": 100.0 * least, "narrowest": narrowest["campaign"],
             **_spread(q)}
        )  # fmt: skip
    return {
        "quantities": quantities,
        "changes": [{**c, "name": capitalize_first(c["name"])} for c in _changes(pooling)],
        "choices": [{**c, "name": capitalize_first(c["name"])} for c in pooling["choices"]],
    }


def _spread(q: Mapping[str, Any]) -> dict[str, Any]:
    """Return how much devices differ: a standard deviation, or a factor where logarithms do."""
    ends = [q["spread"], *q["spread_interval"]]
    if not q["logarithmic"]:
        return {"differ": significant(ends[0], 2), "differ_unit": q["unit"],
                "differ_interval": interval(ends[1:], 2)}  # fmt: skip
    factors = [math.exp(e) for e in ends]
    return {"differ": f"× {significant(factors[0], 3)}", "differ_unit": "",
            "differ_interval": interval(factors[1:], 3)}  # fmt: skip

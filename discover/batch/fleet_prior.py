"""A fleet's prior: devices of one type tell each other's shapes, and what that changed.

Works on what the studies state: numbers by their intervals, ways (structures, what friction turns
over) by their probabilities. Nothing is studied again.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from discover.batch.answer import Answer
from discover.batch.compared import Compared, Row, compared
from discover.batch.even_pooling import evenly_pooled
from discover.batch.partial_pooling import Told, partly_pooled
from discover.batch.pooling import normals_of
from discover.batch.shared_choice import shared_choice
from models.cores import CORES

_TURNS_OVER = {"presliding_displacement": "displacement", "transition_speed": "speed"}
"""What friction turns over, by the key of its size."""


def fleet_prior(answers: Sequence[Answer], rows: Sequence[Row], *, seed: int) -> dict[str, Any]:
    """Return ``pooling`` of ``batch.json``: every answer alone and beside the others'.

    Parameters
    ----------
    answers : sequence of Answer
        Of all campaigns.
    rows : sequence of mapping
        Of their table, see `discover.batch.table`.
    seed : int
        Of the draws.
    """
    studied = {a.label: a.study for a in answers if a.study is not None}
    found = [*compared(rows), *_friction_sizes(studied)]
    numbers = [n for n in found if len(n.campaigns) > 1]
    generator = np.random.default_rng(seed)
    return {
        "quantities": [_number(n) for n in numbers],
        "choices": [
            _choice(name, values, generator)
            for name, values in (*_structures(studied), *_turning(studied))
            if len({v["campaign"] for v in values}) > 1
        ],
    }


def _number(number: Compared) -> dict[str, Any]:
    """Return a number of several devices, alone and pooled."""
    table = np.array([[v["value"], v["lower"], v["upper"]] for v in number.values])
    devices = [v["campaign"] for v in number.values]
    if number.between_tests:
        found = evenly_pooled(np.log(table[:, 1]), np.log(table[:, 2]), devices)
    else:
        value, lower, upper = table.T
        found = partly_pooled(*normals_of(value, lower, upper, number.bounds), devices)
    return {
        "kind": number.kind,
        "name": number.name,
        "structure": number.structure,
        "unit": number.unit,
        "logarithmic": number.between_tests,
        "spread": found.spread.value,
        "spread_interval": list(found.spread.interval),
        "values": [
            {"campaign": v["campaign"], "band": v["band"],
             "alone": {k: v[k] for k in ("value", "lower", "upper")},
             "pooled": _stated(told, number)}
            for v, told in zip(number.values, found.values, strict=True)
        ],
    }  # fmt: skip


def _stated(told: Told, number: Compared) -> dict[str, float]:
    ends = np.array([told.value, *told.interval])
    ends = np.exp(ends) if number.between_tests else np.clip(ends, *number.bounds)
    return dict(zip(("value", "lower", "upper"), ends.tolist(), strict=True))


def _friction_sizes(studied: Mapping[str, Mapping[str, Any]]) -> list[Compared]:
    """Return the displacement or the speed that friction turns over, one value a device."""
    found = []
    for key, name in _TURNS_OVER.items():
        values = []
        for label, study in studied.items():
            friction = _friction(study) or {}
            if key in friction:
                low, high = friction[f"{key}_interval"]
                told = {"value": friction[key], "lower": low, "upper": high}
                values.append({"campaign": label, "band": None, **told})
        unit = "m" if name == "displacement" else "m/s"
        ends = (0.0, math.inf)
        name = f"{name} that friction turns over"
        found.append(Compared("shape", "", name, unit, ends, tuple(values), between_tests=True))
    return found


def _friction(study: Mapping[str, Any]) -> Mapping[str, Any] | None:
    """Return a study's friction, which all its bands share; None where it has none."""
    return next((b["friction"] for b in study["bands"] if b.get("friction")), None)


def _structures(
    studied: Mapping[str, Mapping[str, Any]],
) -> Iterator[tuple[str, list[dict[str, Any]]]]:
    """Yield the structures of each band, among devices that have as many bands."""
    for count in sorted({len(s["bands"]) for s in studied.values()}):
        some = {label: s["bands"] for label, s in studied.items() if len(s["bands"]) == count}
        for band in range(count):
            place = f" of band {band + 1} of {count}" if count > 1 else " of the only band"
            ways = [core.name for core in CORES]
            values = []
            for label, bands in some.items():
                told = {e["structure"]: e["probability"] for e in bands[band]["equivalents"]}
                chances = {way: told.get(way, 0.0) for way in ways}
                values.append({"campaign": label, "band": band + 1, "alone": chances})
            yield f"structure{place}", values


def _turning(
    studied: Mapping[str, Mapping[str, Any]],
) -> Iterator[tuple[str, list[dict[str, Any]]]]:
    """Yield whether friction turns over a displacement or a speed."""
    values = []
    for label, study in studied.items():
        friction = _friction(study) or {}
        for key, name in _TURNS_OVER.items():
            if key in friction:
                sure = friction["probability"]
                chances = {n: sure if n == name else 1.0 - sure for n in _TURNS_OVER.values()}
                values.append({"campaign": label, "band": None, "alone": chances})
    yield "what friction turns over", values


def _choice(
    name: str, values: Sequence[Mapping[str, Any]], generator: np.random.Generator
) -> dict[str, Any]:
    """Return the ways of several devices, alone and pooled."""
    ways = list(values[0]["alone"])
    alone = np.array([[v["alone"][w] for w in ways] for v in values])
    found = shared_choice(alone, generator)
    return {
        "name": name,
        "agreement": found.agreement,
        "values": [
            {"campaign": v["campaign"], "band": v["band"],
             "ways": [
                 {"way": w, "alone": float(a), "pooled": float(p)}
                 for w, a, p in zip(ways, own, chances, strict=True) if a > 0.0
             ]}
            for v, own, chances in zip(values, alone, found.chances, strict=True)
        ],
    }  # fmt: skip

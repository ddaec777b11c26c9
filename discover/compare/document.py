"""The document of a comparison."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from discover.compare.differences import Difference, differences
from discover.compare.side import Side
from discover.header import document_header


def comparison_document(
    sides: Sequence[Side], simulations: Sequence[Mapping[str, Any]], *, seed: int
) -> dict[str, Any]:
    """Return ``comparison.json``.

    Parameters
    ----------
    sides : sequence of Side
        At least two.
    simulations : sequence of mapping
        ``simulation.json`` of each common campaign, with all sides' models.
    seed : int
        Of what was run.
    """
    title = " beside ".join(s.name for s in sides)
    hashes = {s.content_hash for s in sides if s.content_hash}
    found = differences(sides)
    return {
        **document_header("comparison", seed=seed, title=title,
                          content_hash=hashes.pop() if len(hashes) == 1 else ""),
        "sides": [_side(s) for s in sides],
        "same_structures": _same_structures(sides),
        "quantities": [d.to_dict() for d in found],
        "errors": [_errors(s) for s in simulations],
        "findings": _findings(sides, found),
    }  # fmt: skip


def _side(side: Side) -> dict[str, Any]:
    return {
        "name": side.name,
        "kind": side.kind,
        "campaign": {"title": side.title, "hash": side.content_hash},
        "headline": side.headline,
        "coordinate": side.coordinate,
        "bands": [
            {
                "lower": b.lower,
                "upper": b.upper,
                "structure": b.structure,
                "probability": b.probability,
                "terms": [dict(t) for t in b.terms],
            }
            for b in side.bands
        ],
    }


def _same_structures(sides: Sequence[Side]) -> bool:
    return len({tuple(b.structure for b in s.bands) for s in sides}) == 1


def _errors(simulation: Mapping[str, Any]) -> dict[str, Any]:
    return {
        "campaign": simulation["campaign"],
        "noise_percent": simulation["noise_percent"],
        "ranked_on": simulation["ranked_on"],
        "models": simulation["models"],
    }


def _findings(sides: Sequence[Side], found: Sequence[Difference]) -> list[dict[str, Any]]:
    notes = []
    hashes = [s.content_hash for s in sides if s.content_hash]
    if len(hashes) > len(set(hashes)):
        notes.append("Some answers rest on the same records: their intervals are not independent,"
                     " and the comparison finds fewer differences than there are.")  # fmt: skip
    counts = {len(s.bands) for s in sides}
    if len(counts) > 1:
        notes.append("The answers have different numbers of bands: bands of the same structure are"
                     " compared.")  # fmt: skip
    if len({s.coordinate for s in sides if len(s.bands) > 1}) > 1:
        notes.append("The bands lie on different coordinates: their ends can't be compared.")
    untold = any(d.p is None and d.why.endswith("an interval") for d in found)
    if untold and any(s.kind == "model" for s in sides):
        notes.append("A model alone has no intervals; a folder of results, with study.json or"
                     " gap.json in it, has them.")  # fmt: skip
    expected = 0.05 * sum(d.p is not None for d in found)
    if expected >= 1.0:
        notes.append(f"By chance alone about {expected:.0f} of the numbers would be told to"
                     " differ.")  # fmt: skip
    return [{"level": "note", "text": text} for text in notes]

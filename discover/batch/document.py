"""The document of a batch."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping, Sequence
from typing import Any

from discover.batch.answer import Answer
from discover.batch.fleet import fleet_quantities, structure_counts
from discover.batch.fleet_prior import fleet_prior
from discover.header import document_header
from discover.words import counted


def batch_document(
    answers: Sequence[Answer],
    rows: Sequence[Mapping[str, Any]],
    *,
    seed: int,
    model: str | None,
    pool: bool = False,
) -> dict[str, Any]:
    """Return ``batch.json``.

    Parameters
    ----------
    answers : sequence of Answer
        Of all campaigns.
    rows : sequence of mapping
        Of their table.
    seed : int
        Of all studies.
    model : str or None
        That gaps were searched with; None where none were.
    pool : bool, optional
        Whether devices tell each other's answers (`discover.batch.fleet_prior`).
    """
    quantities = fleet_quantities(rows)
    hashes = [a.study["campaign"]["hash"] for a in answers if a.study is not None]
    title = f"A fleet of {counted(len(answers), 'campaign')}"
    whole = hashlib.sha256("\n".join(hashes).encode()).hexdigest()
    return {
        **document_header("batch", seed=seed, title=title, content_hash=whole),
        "model": model,
        "campaigns": [_campaign(a) for a in answers],
        "structures": structure_counts(rows),
        "quantities": quantities,
        "outliers": [
            {**o, "kind": q["kind"], "name": q["name"], "structure": q["structure"],
             "unit": q["unit"]}
            for q in quantities
            for o in q["outliers"]
        ],
        **({"pooling": fleet_prior(answers, rows, seed=seed)} if pool else {}),
    }  # fmt: skip


def _campaign(answer: Answer) -> dict[str, Any]:
    told: dict[str, Any] = {
        "campaign": answer.label, "path": answer.path, "status": answer.status
    }  # fmt: skip
    if answer.error:
        told["error"] = answer.error
    if answer.study is not None:
        told["title"] = answer.study["campaign"]["title"]
        told["hash"] = answer.study["campaign"]["hash"]
        told["headline"] = answer.study["headline"]
    if answer.gap is not None:
        told["gap"] = {
            "verdict": answer.gap["verdict"],
            "gap_percent": answer.gap["gap_percent"],
            "final_gap_percent": answer.gap["final_gap_percent"],
            "effects": [r["effect"] for r in answer.gap["rounds"]],
        }
    return told

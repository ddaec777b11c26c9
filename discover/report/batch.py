"""The page over a fleet of devices, and what a batch prints."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any
from urllib.parse import quote

from discover.plots.fleet import over_devices
from discover.report.environment import render
from discover.report.fleet_quantity import pictured, quantity_name
from discover.report.pooling import pooling_lines, pooling_shown
from discover.words import (
    capitalize_first,
    counted,
    listed,
    named_line,
    significant,
    spread,
)


def batch_lines(document: Mapping[str, Any]) -> list[str]:
    """Return what a batch found, in lines.

    Parameters
    ----------
    document : mapping
        As ``batch.json``.
    """
    campaigns = document["campaigns"]
    failed = [c for c in campaigns if c["status"] == "failed"]
    partly = [c for c in campaigns if c["status"] == "partly"]
    told = f"{len(campaigns) - len(failed)} of {counted(len(campaigns), 'campaign')} studied"
    if failed:
        told += f", {len(failed)} failed"
    if partly:
        told += f", {len(partly)} without their gap"
    lines = [f"Fleet: {told}."]
    if document["structures"]:
        shares = (
            f"{' then '.join(s['structures'])} in {s['campaigns']}" for s in document["structures"]
        )
        lines.append(f"Structures: {listed(shares)}.")
    for q in document["quantities"]:
        if q["kind"] == "boundary":
            lines.append(
                f"{capitalize_first(quantity_name(q))}: {significant(q['mean'], 3)}"
                f" ({spread(q['interval'])}) over {counted(len(q['values']), 'device')};"
                f" they differ by {significant(q['spread'], 2)} (standard deviation)."
            )
    apart = sorted({o["campaign"] for o in document["outliers"]})
    if apart:
        lines.append(f"Apart from the rest: {counted(len(apart), 'device')}, {listed(apart)}.")
    if "pooling" in document:
        lines += pooling_lines(document["pooling"])
    return lines


def batch_report(
    document: Mapping[str, Any], rows: Sequence[Mapping[str, Any]], *, command: str
) -> str:
    """Return ``report.html`` of a batch.

    Parameters
    ----------
    document : mapping
        As ``batch.json``.
    rows : sequence of mapping
        Of its table.
    command : str
        What a person types to repeat it, or to go on.
    """
    bands: dict[str, dict[int, Mapping[str, Any]]] = {}
    for row in rows:
        if row["band"] is not None:
            bands.setdefault(row["campaign"], {}).setdefault(row["band"], row)
    devices = [
        {**c, "bands": [own[b] for b in sorted(own)],
         "link": f"{quote(c['campaign'])}/report.html",
         "gap_link": f"{quote(c['campaign'])}/gap/report.html"}
        for c in document["campaigns"]
        for own in [bands.get(c["campaign"], {})]
    ]  # fmt: skip
    quantities = [
        pictured(q, number, over_devices, "fleet")
        for number, q in enumerate(document["quantities"])
    ]
    return render(
        "batch.html",
        command=command,
        document_name="batch.json",
        document=document,
        verdict=[named_line(line) for line in batch_lines(document)],
        devices=[d for d in devices if d["status"] != "failed"],
        failed=[d for d in devices if "error" in d],
        quantities=quantities,
        outliers=[{**o, "label": quantity_name(o)} for o in document["outliers"]],
        pooling=pooling_shown(document["pooling"]) if "pooling" in document else None,
    )

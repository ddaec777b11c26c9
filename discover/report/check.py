"""A check of the data in lines for the terminal."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from typing import Any

from discover.report.words import counted, listed, percent


def check_lines(document: Mapping[str, Any]) -> list[str]:
    """Return what a person should know: records, noise, findings, what can't be told apart.

    Parameters
    ----------
    document : mapping
        The check as in ``check.json``.
    """
    records = document["records"]
    kinds = Counter(str(r["kind"]) for r in records)
    noise = [r["force_noise_percent"] for r in records if r["force_noise_percent"] is not None]
    kind_text = listed([f"{n} {kind}" for kind, n in kinds.items()])
    lines = [
        f"Records: {counted(len(records), 'record')} ({kind_text})"
        + (f"; force noise {_spread(noise)} of the force." if noise else ".")
    ]
    for finding in document["findings"]:
        record = f"{finding['record']}: " if finding.get("record") else ""
        lines.append(f"{str(finding['level']).capitalize()}: {record}{finding['text']}")
    lines += [f"Can't be told apart: {pair['why']}." for pair in document["inseparable"]]
    if not document["inseparable"]:
        lines.append("Plan: these tests can tell the four structures apart at their noise.")
    lines.append("Check: passed." if document["passed"] else "Check: failed.")
    return lines


def _spread(noise: list[float]) -> str:
    low, high = percent(min(noise)), percent(max(noise))
    return low if low == high else f"{low} to {high}"

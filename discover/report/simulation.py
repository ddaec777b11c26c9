"""Predicted forces in lines for the terminal: models, best first."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from discover.words import counted, percent


def simulation_lines(document: Mapping[str, Any]) -> list[str]:
    """Return the ranking and what a person should know of it.

    Parameters
    ----------
    document : mapping
        The comparison as in ``simulation.json``.
    """
    lines = []
    for model in sorted(document["models"], key=lambda m: int(m["rank"])):
        fitted = model["relative_error_percent"]
        unseen = model["held_out_relative_error_percent"]
        parts = []
        if unseen is not None:
            parts.append(f"{percent(unseen)} of the force on held-out records")
        if fitted is not None:
            others = "the others" if unseen is not None else "all records"
            parts.append(f"{percent(fitted)} on {others}")
        lines.append(f"{model['rank']}. {model['name']}: misses " + ", ".join(parts) + ".")
    records = counted(len(document["models"][0]["records"]), "record")
    lines.append(f"Noise: {percent(document['noise_percent'])} of the force ({records}).")
    for finding in document["findings"]:
        lines.append(f"{str(finding['level']).capitalize()}: {finding['text']}")
    return lines

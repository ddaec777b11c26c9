"""The gap on simulated motion in lines, beside the gap on force."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from discover.words import percent


def motion_lines(motion: Mapping[str, Any]) -> list[str]:
    """Return what the models' motion says.

    Parameters
    ----------
    motion : mapping
        The part ``motion`` of ``gap.json``.
    """
    before, after = motion["before"], motion["after"]
    if after is None:
        reason = motion["reason"]
        lines = [f"Motion: {_gap(before)} off; the mended model can't be moved: {reason}."]
    else:
        lines = [f"Motion: {_gap(before)} off before, {_gap(after)} after."]
    for name, part in (("before", before), ("after", after)):
        for finding in (part or {}).get("findings", ()):
            if finding["level"] == "warning":
                lines.append(f"Motion {name}, {finding['record']}: {finding['text']}.")
    return lines


def _gap(part: Mapping[str, Any]) -> str:
    held_out = part["held_out_gap_percent"]
    fitted = part["gap_percent"]
    texts = [] if fitted is None else [percent(fitted)]
    if held_out is not None:
        texts.append(f"{percent(held_out)} on held-out records")
    return ", ".join(texts)

"""What is told about data or an answer."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Finding:
    """Something that a user should know about the data or the answer."""

    level: str
    """"error", "warning" or "note"."""
    text: str
    """What was found and what to do about it."""
    record: str | None = None
    """The record that it concerns; None for the whole campaign."""
    about: str | None = None
    """"unit" where it doubts that a column is in the unit as read; None otherwise."""

    def to_dict(self) -> dict[str, Any]:
        """Return the entry as documents carry it."""
        result: dict[str, Any] = {"level": self.level, "text": self.text}
        if self.record is not None:
            result["record"] = self.record
        if self.about is not None:
            result["about"] = self.about
        return result

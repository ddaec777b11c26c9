"""What a batch keeps of one campaign."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Answer:
    """A campaign's documents, or why there are none."""

    label: str
    """Name of its folder of results."""
    path: str
    """Of the campaign, as given."""
    study: Mapping[str, Any] | None
    """As in ``study.json``; None where it failed."""
    gap: Mapping[str, Any] | None = None
    """As in ``gap.json``; None where none was asked for, or it failed."""
    error: str = ""
    """Why the study or the gap failed, in one line."""

    @property
    def status(self) -> str:
        """Return "done", "failed", or "partly" where the gap failed and the study did not."""
        if not self.error:
            return "done"
        return "failed" if self.study is None else "partly"

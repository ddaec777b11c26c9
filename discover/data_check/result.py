"""What a check of the data found, as a frozen value and as ``check.json``."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from discover.header import document_header
from discover.record_checks import RecordCheck
from discover.records import Finding


@dataclass(frozen=True)
class Inseparable:
    """Two structures that the plan can't tell apart at the measured noise."""

    structures: tuple[str, str]
    """Their names."""
    gap: float
    """Expected log-likelihood gap, nats."""
    why: str
    """In words."""

    def to_dict(self) -> dict[str, Any]:
        """Return the document's entry."""
        return {"structures": list(self.structures), "gap": self.gap, "why": self.why}


@dataclass(frozen=True)
class DataCheck:
    """The answer of a check."""

    title: str
    """The campaign's."""
    content_hash: str
    """The campaign's."""
    seed: int
    """As asked; nothing in a check is random."""
    records: tuple[RecordCheck, ...]
    """In the campaign's order."""
    findings: tuple[Finding, ...]
    """On the records and on the plan, in words."""
    inseparable: tuple[Inseparable, ...]
    """Pairs of structures."""

    @property
    def passed(self) -> bool:
        """Return whether no finding is an error."""
        return all(f.level != "error" for f in self.findings)

    def to_dict(self) -> dict[str, Any]:
        """Return the document ``check.json``."""
        return {
            **document_header(
                "check", seed=self.seed, title=self.title, content_hash=self.content_hash
            ),
            "passed": self.passed,
            "records": [r.to_dict() for r in self.records],
            "findings": [f.to_dict() for f in self.findings],
            "inseparable": [pair.to_dict() for pair in self.inseparable],
        }

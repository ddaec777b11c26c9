"""What a check of the data found, as a frozen value and as ``check.json``."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from typing import Any

from discover.answer_html import answer_html
from discover.figure_data import PlanFigureData
from discover.header import document_header
from discover.record_checks import Differing, RecordCheck
from discover.records import Finding
from discover.words import counted, listed, percent, quantity, significant


@dataclass(frozen=True)
class Conditioning:
    """How well a plan of tests determines the parameters of one structure."""

    name: str
    """"FOIM", "IOIM-linear", "IOIM-laminar" or "IOIM-turbulent"."""
    terms: tuple[str, ...]
    """Ids of its terms."""
    columns: int
    """Number of its parameters: a coefficient a term, and the order where one is fitted."""
    rank: int
    """Number of combinations of them that the tests can see at their noise."""
    condition: float | None
    """Greatest over least singular value of the whitened columns of unit length; None where a
    column is a mixture of the others."""

    def to_dict(self) -> dict[str, Any]:
        """Return the document's entry."""
        return {
            "name": self.name,
            "terms": list(self.terms),
            "rank": self.rank,
            "columns": self.columns,
            "condition": self.condition,
        }


@dataclass(frozen=True)
class ExpectedGap:
    """By how much the tests would reject one structure if another one were true."""

    truth: str
    """What makes the force."""
    model: str
    """What is fitted to it."""
    nats: float
    """Expected log-likelihood gap."""
    word: str
    """"separable", "inseparable", or "nested" where the model holds the truth as a case."""

    def to_dict(self) -> dict[str, Any]:
        """Return the document's entry."""
        return {
            "truth": self.truth,
            "model": self.model,
            "gap_nats": self.nats,
            "word": self.word,
        }


@dataclass(frozen=True)
class Pair:
    """Two structures, and whether a plan of tests can tell them apart."""

    structures: tuple[str, str]
    """Names of the two."""
    gaps: tuple[ExpectedGap, ExpectedGap]
    """With the first true, with the second true."""
    rank: int
    """Number of combinations of both structures' parameters that the tests can see."""
    columns: int
    """Number of their distinct parameters."""
    separable: bool
    """Whether the gap suffices to rule one of them out at 5 %."""

    @property
    def nats(self) -> float:
        """The lesser gap; of nested structures the one with the larger structure true."""
        return min(g.nats for g in self.gaps if g.word != "nested")

    @property
    def nested(self) -> bool:
        """Whether one structure is a case of the other."""
        return any(g.word == "nested" for g in self.gaps)

    def to_dict(self) -> dict[str, Any]:
        """Return the document's entry."""
        return {
            "structures": list(self.structures),
            "gap_nats": self.nats,
            "separable": self.separable,
            "nested": self.nested,
            "rank": self.rank,
            "columns": self.columns,
            "expected": [g.to_dict() for g in self.gaps],
        }


@dataclass(frozen=True)
class Inseparable:
    """Two structures that the plan can't tell apart at the measured noise."""

    structures: tuple[str, str]
    """Names of the two."""
    gap: float
    """Expected log-likelihood gap, nats."""
    why: str
    """Why these tests can't tell them apart, in words."""

    def to_dict(self) -> dict[str, Any]:
        """Return the document's entry."""
        return {"structures": list(self.structures), "gap": self.gap, "why": self.why}


@dataclass(frozen=True)
class AddedTest:
    """The sine test that would do most for the pair that is hardest to tell apart."""

    frequency_hz: float
    """Frequency, Hz."""
    amplitude_m: float
    """Displacement amplitude, m."""
    structures: tuple[str, str]
    """The pair that is hardest to tell with this test added."""
    nats: float
    """Expected log-likelihood gap of that pair then."""

    def to_dict(self) -> dict[str, Any]:
        """Return the document's entry."""
        return {
            "frequency_hz": self.frequency_hz,
            "amplitude_m": self.amplitude_m,
            "structures": list(self.structures),
            "gap_nats": self.nats,
        }


@dataclass(frozen=True, repr=False)
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
    """On the records and on the plan, in words; errors first."""
    differing: tuple[Differing, ...]
    """Records that do not belong with others."""
    structures: tuple[Conditioning, ...]
    """What the tests determine of each; none where no record may be fitted."""
    pairs: tuple[Pair, ...]
    """Every two structures, and whether these tests can tell them apart."""
    inseparable: tuple[Inseparable, ...]
    """Pairs of structures that these tests can't tell apart."""
    added_test: AddedTest | None
    """What would help; None where every pair is separable, no other test is within limits
    or a unit is in doubt."""
    figure_data: PlanFigureData
    """What the pictures need besides."""

    def __repr__(self) -> str:
        """Return the campaign's title and whether it passed."""
        levels = Counter(f.level for f in self.findings)
        found = [counted(n, level) for level, n in levels.items()]
        told = ", ".join(["passed" if self.passed else "failed", *found])
        return f"<DataCheck of {self.title!r}: {counted(len(self.records), 'record')}, {told}>"

    def _repr_html_(self) -> str:
        """Return the answer as a notebook shows it: what was found, and a row for every record."""
        lines = [f"Check: {'passed' if self.passed else 'failed'}"]
        for f in self.findings:
            lines.append(f"{f.level.capitalize()}: {f'{f.record}: ' if f.record else ''}{f.text}")
        if self.inseparable:
            pairs = listed(" and ".join(pair.structures) for pair in self.inseparable)
            lines.append(f"Plan: these tests can't tell apart {pairs}")
        if (test := self.added_test) is not None:
            lines.append(
                f"Test to add: {significant(test.frequency_hz, 3)} Hz at"
                f" {quantity(test.amplitude_m, 'm')}"
            )
        header = ("record", "kind", "frequency", "amplitude", "samples", "noise of the force")
        rows = [
            [
                r.file,
                r.kind.kind,
                "–" if r.frequency_hz is None else quantity(r.frequency_hz, "Hz"),
                "–" if r.amplitude_m is None else quantity(r.amplitude_m, "m"),
                str(r.samples),
                percent(r.force_noise_percent),
            ]
            for r in self.records
        ]
        return answer_html(self.title, lines, header, rows)

    @property
    def passed(self) -> bool:
        """Whether no finding is an error."""
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
            "belongs_together": not self.differing,
            "differing": [d.to_dict() for d in self.differing],
            "structures": [s.to_dict() for s in self.structures],
            "pairs": [pair.to_dict() for pair in self.pairs],
            "inseparable": [pair.to_dict() for pair in self.inseparable],
            "added_test": self.added_test.to_dict() if self.added_test else None,
        }

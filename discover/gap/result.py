"""The answer of a gap search, and its documents."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from discover.answer_html import answer_html
from discover.document import json_text
from discover.figure_data import GapFigureData
from discover.friction_parts import whole_friction
from discover.gap.verdict import verdict_lines
from discover.gap.where import Place
from discover.header import document_header
from discover.records import Finding
from discover.rows import Unexplained
from discover.words import error_lines, interval, raised, significant, term_name
from models.constitutive import FittedTerm, ForceModel, SegmentedModel

if TYPE_CHECKING:
    import pandas

    from discover.plots.gap_plots import GapPlots

Interval = tuple[float, float]


@dataclass(frozen=True)
class NamedEffect:
    """One round."""

    effect: str
    """Id of the effect that is added."""
    parameters: dict[str, float]
    """Its shape parameters by name, SI."""
    coefficient: float
    """Its size, in `unit`."""
    interval: Interval
    """95 %, of the coefficient."""
    unit: str
    """SI, of the coefficient."""
    probability: float
    """That this is what is missing, from 0 to 1."""
    alternatives: tuple[tuple[str, float], ...]
    """What else it may be, most probable first."""
    indistinguishable: tuple[str, ...]
    """Of these, what the records can't tell from it."""
    gap: tuple[float, float]
    """Percent before and after, fitted records, pooled in N."""
    alike: tuple[float, float]
    """Percent before and after, root mean square of the records' own gaps: all count alike."""
    unseen: tuple[float | None, float | None]
    """Percent before and after, of records that were not fitted; None of one record alone."""
    dropped: tuple[str, ...]
    """Earlier effects that it made superfluous."""
    share_percent: float
    """How much of the misfit beyond noise the effect explains."""
    shape_adequate: bool
    """Whether its formula leaves little beside what it explains."""
    held_out_better: bool | None
    """Whether records that were not fitted are predicted better; None where there are none."""

    def to_dict(self) -> dict[str, Any]:
        """Return the document's entry."""
        return {
            "effect": self.effect,
            "parameters": self.parameters,
            "coefficient": self.coefficient,
            "interval": list(self.interval),
            "unit": self.unit,
            "probability": self.probability,
            "alternatives": [{"effect": e, "probability": p} for e, p in self.alternatives],
            "not_distinguishable_from": list(self.indistinguishable),
            "gap_before_percent": self.gap[0],
            "gap_after_percent": self.gap[1],
            "rms_record_gap_before_percent": self.alike[0],
            "rms_record_gap_after_percent": self.alike[1],
            "held_out_before_percent": self.unseen[0],
            "held_out_after_percent": self.unseen[1],
            "dropped": list(self.dropped),
            "share_percent": self.share_percent,
            "shape_adequate": self.shape_adequate,
            "held_out_better": self.held_out_better,
        }


@dataclass(frozen=True)
class MendedTerm:
    """A term of the mended model."""

    fitted: FittedTerm
    """Coefficient and shape."""
    interval: Interval | None
    """95 %, of the coefficient; None where it was held."""

    def to_dict(self) -> dict[str, Any]:
        """Return the document's entry."""
        interval = {} if self.interval is None else {"interval": list(self.interval)}
        return {**self.fitted.to_dict(), **interval}


@dataclass(frozen=True)
class RecordGap:
    """One record before and after."""

    file: str
    """Name of the record."""
    held_out: bool
    """True where it was never fitted."""
    noise: float
    """Of its force, percent."""
    before: float
    """Gap of the model as it was given, percent of the force."""
    after: float
    """Gap of the mended model, percent of the force."""

    def to_dict(self) -> dict[str, Any]:
        """Return the document's entry."""
        return {
            "file": self.file,
            "held_out": self.held_out,
            "noise_percent": self.noise,
            "gap_before_percent": self.before,
            "gap_after_percent": self.after,
        }


@dataclass(frozen=True, repr=False)
class Gap:
    """The answer of a gap search.

    A notebook shows it as its sentences and a table of the mended model's terms.
    """

    title: str
    """The campaign's."""
    content_hash: str
    """The campaign's."""
    seed: int
    """As asked; nothing in the search is random."""
    baseline: tuple[FittedTerm, ...]
    """The model's terms as it was held against the data."""
    fitted: bool
    """True where the model's coefficients were fitted first."""
    fixed: bool
    """True where the model's coefficients were held throughout."""
    gap_percent: float
    """100 ||F - baseline||/||F|| over all fitted records."""
    held_out_gap_percent: float | None
    """100 ||F - baseline||/||F|| over all records that were not fitted."""
    noise_percent: float
    """100 ||noise||/||F|| over all fitted records."""
    where: tuple[Place, ...]
    """Where the baseline misses, record by record."""
    where_text: str
    """The same in a sentence."""
    rounds: tuple[NamedEffect, ...]
    """Effects that were added, in this order."""
    mended: tuple[MendedTerm, ...]
    """The baseline's terms and the added ones, as last fitted."""
    records: tuple[RecordGap, ...]
    """In the campaign's order."""
    verdict: str
    """"agrees", "closed", "reduced" or "unexplained"."""
    final_gap_percent: float
    """100 ||F - mended model||/||F|| over all fitted records."""
    final_held_out_gap_percent: float | None
    """100 ||F - mended model||/||F|| over all records that were not fitted."""
    unexplained_percent: float
    """What is left above the noise."""
    remainder: Unexplained
    """What no term explains, as rows show it."""
    shape: str
    """What is left, in words; "" where nothing is."""
    last: tuple[tuple[str, float], ...]
    """The contest that ended the search, most probable first."""
    leave_one_out: bool
    """True where no record is marked: each was left out in turn."""
    findings: tuple[Finding, ...]
    """What to know."""
    given: SegmentedModel | ForceModel
    """The baseline as it was given, or fitted first."""
    model: SegmentedModel
    """The mended model."""
    figure_data: GapFigureData
    """For pictures."""

    @property
    def plot(self) -> GapPlots:
        """The search's pictures: ``gap.plot.records()``, ``rounds()``, ``loops()``, ..."""
        # Drawing stands above the values and takes a moment to load.
        from discover.plots.gap_plots import GapPlots

        return GapPlots(self.to_dict(), self.figure_data)

    def __repr__(self) -> str:
        """Return the campaign's title and the verdict."""
        names = ", ".join(r.effect for r in self.rounds) or "nothing named"
        gaps = f"gap {self.gap_percent:.3g} to {self.final_gap_percent:.3g} %"
        return f"<Gap of {self.title!r}: {self.verdict}, {names}, {gaps}>"

    def _repr_html_(self) -> str:
        """Return the answer as a notebook shows it."""
        rows = [
            [
                term_name(m["id"]), significant(m["coefficient"]), interval(m.get("interval"), 4),
                raised(m["unit"]),
            ]
            for m in whole_friction([m.to_dict() for m in self.mended])
        ]
        header = ("term of the mended model", "coefficient", "95 % interval", "unit")
        return answer_html(self.title, self._lines(), header, rows)

    def _lines(self) -> list[str]:
        document = self.to_dict()
        return [*error_lines(document), *verdict_lines(document)]

    def summary(self) -> str:
        """Return the answer in plain sentences, a line each: what ``inerter gap`` prints."""
        return "\n".join(self._lines())

    def to_frame(self) -> pandas.DataFrame:
        """Return the mended model's terms as a table, a row each, in SI.

        Columns are term, added (by a round), coefficient, lower, upper (95 %; missing where it was
        held), unit, and one for every shape parameter that is not at its default.
        """
        import pandas

        named = {r.effect for r in self.rounds}
        rows: list[dict[str, Any]] = [
            {
                "term": m.fitted.id,
                "added": m.fitted.id in named,
                "coefficient": m.fitted.coefficient,
                "lower": None if m.interval is None else m.interval[0],
                "upper": None if m.interval is None else m.interval[1],
                "unit": m.fitted.unit,
                **m.fitted.told_shape,
            }
            for m in self.mended
        ]
        return pandas.DataFrame(rows)

    def save(self, path: str | Path) -> None:
        """Write the document ``gap.json`` to a file; one that is there is replaced.

        Parameters
        ----------
        path : str or Path
            Of the file.
        """
        Path(path).write_text(json_text(self.to_dict()), encoding="utf-8")

    def _header(self, name: str) -> dict[str, Any]:
        return document_header(
            name, seed=self.seed, title=self.title, content_hash=self.content_hash
        )

    def to_dict(self) -> dict[str, Any]:
        """Return the document ``gap.json``."""
        result: dict[str, Any] = {
            **self._header("gap"),
            "baseline": {
                "terms": [t.to_dict() for t in self.baseline],
                "fitted": self.fitted,
                "fixed": self.fixed,
            },
            "gap_percent": self.gap_percent,
            "noise_percent": self.noise_percent,
            "held_out_gap_percent": self.held_out_gap_percent,
            "held_out_by": "each record in turn" if self.leave_one_out else "marked records",
            "where": [p.to_dict() for p in self.where],
            "where_text": self.where_text,
            "rounds": [r.to_dict() for r in self.rounds],
            "mended": [t.to_dict() for t in self.mended],
            "records": [r.to_dict() for r in self.records],
            "verdict": self.verdict,
            "final_gap_percent": self.final_gap_percent,
            "final_held_out_gap_percent": self.final_held_out_gap_percent,
            "unexplained_percent": self.unexplained_percent,
            "remainder_percent": self.remainder.to_dict(),
            "contest": [{"effect": e, "probability": p} for e, p in self.last],
            "findings": [f.to_dict() for f in self.findings],
        }
        if isinstance(self.given, SegmentedModel) and len(self.given.bands) > 1:
            result["baseline"]["convention"] = self.given.convention
            result["baseline"]["bands"] = self.given.to_dict()["bands"]
        if self.shape:
            result["shape"] = self.shape
        return result

    def model_dict(self) -> dict[str, Any]:
        """Return the document ``model.json`` of the mended model."""
        return {**self._header("model"), **self.model.to_dict()}

"""The study as a value, and as the documents ``study.json`` and ``model.json``."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

from discover.answer_html import answer_html
from discover.dean import DeanCheck
from discover.document import json_text
from discover.figure_data import StudyFigureData
from discover.friction_parts import whole_friction
from discover.header import document_header
from discover.next_test import NextTest
from discover.records import Campaign, Finding, Record, checked_campaign
from discover.rows import Unexplained
from discover.simulate import ForceComparison, simulate_forces
from discover.study.verdict import headline, verdict_lines
from discover.words import error_lines, interval, raised, significant, term_name, warning_lines
from models.checks import InputError
from models.constitutive import FittedTerm, SegmentedModel

if TYPE_CHECKING:
    import pandas

    from discover.plots.study_plots import StudyPlots

Interval = tuple[float, float]


@dataclass(frozen=True)
class TermEstimate:
    """A term of a band with its uncertainty."""

    fitted: FittedTerm
    """Coefficient and shape."""
    std_error: float
    """Of the coefficient."""
    interval: Interval
    """95 %, of the coefficient."""
    shape_intervals: dict[str, Interval]
    """95 %, of each fitted shape parameter."""

    def to_dict(self) -> dict[str, Any]:
        """Return the document's entry."""
        result = {
            **self.fitted.to_dict(),
            "std_error": self.std_error,
            "interval": list(self.interval),
        }
        for name, ends in self.shape_intervals.items():
            result[f"{name}_interval"] = list(ends)
        return result


@dataclass(frozen=True)
class Nuisance:
    """A sensor's artefact that matters."""

    id: str
    """Id in the vocabulary."""
    value: float
    """Best value."""
    interval: Interval
    """95 %."""
    unit: str
    """SI."""

    def to_dict(self) -> dict[str, Any]:
        """Return the document's entry."""
        return {
            "id": self.id, "value": self.value, "interval": list(self.interval), "unit": self.unit
        }


@dataclass(frozen=True)
class Extra:
    """What a device has beside its structure."""

    term: TermEstimate
    """With its numbers."""
    probability: float
    """Of its name, beside what else might have taken its place."""
    alternatives: tuple[tuple[str, float], ...]
    """What that is, most probable first."""

    def to_dict(self) -> dict[str, Any]:
        """Return the document's entry."""
        return {
            **self.term.to_dict(),
            "probability": self.probability,
            "alternatives": [{"effect": e, "probability": p} for e, p in self.alternatives],
        }


@dataclass(frozen=True)
class FrictionCurve:
    """How friction reverses."""

    text: str
    """How friction reverses, in words."""
    key: str
    """"presliding_displacement" (m) or "transition_speed" (m/s); "" where it jumps."""
    value: float
    """Of that, by the one curve that fits best."""
    interval: Interval
    """95 %."""
    probability: float
    """That it is a displacement, or a speed, over which friction reverses."""
    differs_by_record: float
    """Standard deviation between records, over the friction or its own deviation, the greater."""

    def to_dict(self) -> dict[str, Any]:
        """Return the document's entry."""
        result: dict[str, Any] = {
            "curve": self.text,
            "probability": self.probability,
            "differs_by_record": self.differs_by_record,
        }
        if self.key:
            result[self.key] = self.value
            result[f"{self.key}_interval"] = list(self.interval)
        return result


@dataclass(frozen=True)
class StudyBand:
    """One band: what holds there, how surely, how well."""

    lower: float | None
    """Lower end of the coordinate; None where open."""
    upper: float | None
    """Upper end of the coordinate; None where open."""
    lower_hz: float
    """Lowest frequency among its records, Hz."""
    upper_hz: float
    """Highest frequency among its records, Hz."""
    records: tuple[str, ...]
    """Files of its fitted records."""
    family: str
    """"fractional", "integer" or "mixed"."""
    structure: str
    """One of the named structures, or "other"."""
    terms: tuple[TermEstimate, ...]
    """Of its model, without what belongs to the measuring chain."""
    error_percent: float
    """Root mean square of e, measured less modelled force, over the force's peak."""
    relative_error_percent: float
    """100 ||e||/||F||, e measured less modelled force, F the measured force."""
    noise_percent: float
    """100 ||noise||/||F||, F the measured force."""
    probability: float
    """Of the structure, from 0 to 1."""
    equivalents: tuple[tuple[str, float], ...]
    """Structures that the data can't rule out, the named one first."""
    extras: tuple[Extra, ...]
    """What the device has beside the structure."""
    remainder: Unexplained
    """What no term explains, beyond noise."""
    friction: FrictionCurve | None
    """How friction reverses; None without friction."""

    def to_dict(self) -> dict[str, Any]:
        """Return the document's entry."""
        return {
            "lower": self.lower,
            "upper": self.upper,
            "lower_hz": self.lower_hz,
            "upper_hz": self.upper_hz,
            "records": list(self.records),
            "family": self.family,
            "structure": self.structure,
            "core": self.structure,
            "extras": [e.to_dict() for e in self.extras],
            "remainder_percent": self.remainder.to_dict(),
            "friction": None if self.friction is None else self.friction.to_dict(),
            "terms": [t.to_dict() for t in self.terms],
            "error_percent": self.error_percent,
            "relative_error_percent": self.relative_error_percent,
            "noise_percent": self.noise_percent,
            "probability": self.probability,
            "equivalents": [{"structure": s, "probability": p} for s, p in self.equivalents],
        }


@dataclass(frozen=True)
class StudyBoundary:
    """Where two bands meet."""

    coordinate: float
    """Where it lies, in the study's coordinate."""
    bracket: Interval
    """Coordinates of the tests on either side of it."""
    interval: Interval
    """95 %, of the coordinate."""
    speed: float | None
    """Speed amplitude, m/s; None where the coordinate is frequency."""
    frequency_hz: float
    """Middle frequency of the tests beside it."""
    dean: float | None
    """Dean number in the study's convention; None without geometry."""
    dean_interval: Interval | None
    """95 %, of the Dean number."""
    width: float | None = None
    """Where gradual: the range of the coordinate's logarithm over which models mix."""

    def to_dict(self) -> dict[str, Any]:
        """Return the document's entry."""
        result: dict[str, Any] = {
            "coordinate": self.coordinate,
            "interval": list(self.interval),
            "speed": self.speed,
            "frequency_hz": self.frequency_hz,
            "bracket": list(self.bracket),
        }
        if self.dean is not None and self.dean_interval is not None:
            result["dean"] = self.dean
            result["dean_interval"] = list(self.dean_interval)
        if self.width is not None:
            result["width"] = self.width
        return result


@dataclass(frozen=True, repr=False)
class Study:
    """The answer of a study.

    A notebook shows it as its sentences, a table of terms and the map of the tests.
    """

    title: str
    """The campaign's."""
    content_hash: str
    """The campaign's."""
    seed: int
    """As asked."""
    coordinate: str
    """What bands are of: "dean" (number), "speed" (m/s, amplitude) or "frequency" (Hz)."""
    relative_error_percent: float
    """100 ||e||/||F|| over all fitted records, e measured less modelled force."""
    held_out_relative_error_percent: float | None
    """100 ||e||/||F|| over all records that were held out; None without any."""
    held_out_with_own_values_percent: float | None
    """The same, where what every test has of its own, an offset say, is taken as these records show
    it; None where there is no such thing."""
    identifiable: bool
    """False where the data leave several structures in a band."""
    findings: tuple[Finding, ...]
    """What a reader should know of the records and of the answer."""
    bands: tuple[StudyBand, ...]
    """What holds in each band, from the lowest coordinate up."""
    nuisance: tuple[Nuisance, ...]
    """What belongs to the measuring chain (delay, gain, offset), where it matters."""
    boundaries: tuple[StudyBoundary, ...]
    """Where two bands meet, from the lowest up."""
    dean_check: DeanCheck
    """Whether the lowest boundary lies where the Dean criterion puts it."""
    next_test: NextTest | None
    """The sine test that would tell most; None where nothing is left to tell."""
    model: SegmentedModel
    """Enough to simulate from."""
    draw: Callable[[], StudyFigureData] = field(repr=False, compare=False)
    """Makes what pictures need; other methods' answers take a second."""

    @cached_property
    def figure_data(self) -> StudyFigureData:
        """For pictures."""
        return self.draw()

    def __repr__(self) -> str:
        """Return the campaign's title and the answer in a sentence."""
        return f"<Study of {self.title!r}: {headline(self.to_dict())}>"

    def _repr_html_(self) -> str:
        """Return the answer as a notebook shows it."""
        rows = [
            [
                str(number), band.structure, term_name(t["id"]),
                significant(t["coefficient"]), interval(t.get("interval"), 4), raised(t["unit"]),
            ]
            for number, band in enumerate(self.bands, start=1)
            for t in whole_friction([t.to_dict() for t in band.terms])
        ]
        header = ("band", "structure", "term", "coefficient", "95 % interval", "unit")
        return answer_html(self.title, self._lines(), header, rows) + self._map()

    def _map(self) -> str:
        """Return the map of the tests, or nothing where there is none to draw."""
        try:
            return self.plot.map()._repr_html_()
        except InputError:  # of a study from a file, or without sine tests
            return ""

    def _lines(self) -> list[str]:
        document = self.to_dict()
        of_records = [f for f in document["findings"] if f.get("record") is not None]
        return [
            *error_lines(document), *verdict_lines(document),
            *warning_lines({"findings": of_records}),
        ]

    @property
    def plot(self) -> StudyPlots:
        """The study's pictures: ``study.plot.loops()``, ``map()``, ``errors()``, ..."""
        # Drawing stands above the values and takes a moment to load.
        from discover.plots.study_plots import StudyPlots

        return StudyPlots(self.to_dict(), self.figure_data)

    def predict(self, other: Campaign | Record) -> ForceComparison:
        """Return the force of the study's model for other motion, beside the measured force.

        Parameters
        ----------
        other : Campaign or Record
            Records of the same device, in SI; a single one stands for a campaign of its own.

        Returns
        -------
        ForceComparison
            ``to_frame()`` has the errors by record (percent), ``forces()`` the samples (N).

        Raises
        ------
        InputError
            Where it is neither, or the model's bands lie on a Dean number and it has no device.
        """
        if isinstance(other, Record):
            other = Campaign(other.file, (other,))
        return simulate_forces(checked_campaign(other), {"study": self.model}, seed=self.seed)

    def summary(self) -> str:
        """Return the answer in plain sentences, a line each: what ``inerter discover`` prints."""
        return "\n".join(self._lines())

    def to_frame(self) -> pandas.DataFrame:
        """Return the bands' terms as a table, a row each, in SI.

        Columns are band (from 1), structure, probability (of the structure), term, coefficient,
        lower, upper (95 %), unit, and one for every shape parameter that is not at its default.
        """
        import pandas

        rows: list[dict[str, Any]] = [
            {
                "band": number,
                "structure": band.structure,
                "probability": band.probability,
                "term": t.fitted.id,
                "coefficient": t.fitted.coefficient,
                "lower": t.interval[0],
                "upper": t.interval[1],
                "unit": t.fitted.unit,
                **t.fitted.told_shape,
            }
            for number, band in enumerate(self.bands, start=1)
            for t in band.terms
        ]
        return pandas.DataFrame(rows)

    def save(self, path: str | Path) -> None:
        """Write the study with its model to a file that `discover.load_study` reads.

        Parameters
        ----------
        path : str or Path
            Of the file, as ``study.json``; one that is there is replaced.
        """
        document = {**self.to_dict(), "model": self.model.to_dict()}
        Path(path).write_text(json_text(document), encoding="utf-8")

    def _header(self, name: str) -> dict[str, Any]:
        return document_header(
            name, seed=self.seed, title=self.title, content_hash=self.content_hash
        )

    def to_dict(self) -> dict[str, Any]:
        """Return the document ``study.json``."""
        result = {
            **self._header("study"),
            "headline": "",  # its place; said below, from the rest
            "coordinate": self.coordinate,
            "relative_error_percent": self.relative_error_percent,
            "identifiable": self.identifiable,
            "findings": [f.to_dict() for f in self.findings],
            "bands": [b.to_dict() for b in self.bands],
            "nuisance": [n.to_dict() for n in self.nuisance],
            "boundaries": [b.to_dict() for b in self.boundaries],
            "dean_check": self.dean_check.to_dict(),
            "next_test": None if self.next_test is None else self.next_test.to_dict(),
        }
        if self.held_out_relative_error_percent is not None:
            result["held_out_relative_error_percent"] = self.held_out_relative_error_percent
        if self.held_out_with_own_values_percent is not None:
            result["held_out_with_own_values_percent"] = self.held_out_with_own_values_percent
        result["headline"] = headline(result)
        return result

    def model_dict(self) -> dict[str, Any]:
        """Return the document ``model.json``."""
        return {**self._header("model"), **self.model.to_dict()}

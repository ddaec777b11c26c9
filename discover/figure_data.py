"""What pictures of a study need beyond its document: decimated curves and the other answers."""

from __future__ import annotations

from dataclasses import dataclass

from discover.residual_data import Response
from discover.words import counted
from models.checks import Array


@dataclass(frozen=True, kw_only=True, repr=False)
class ShownRecord:
    """One record as pictures show it: measured, beside what models say."""

    file: str
    """Name as in the campaign."""
    kind: str
    """Kind of record: "sine", "periodic", "transient" or "trajectory"."""
    held_out: bool
    """Never fitted, only predicted."""
    frequency: float | None
    """Hz; None for a record that is no sine test."""
    amplitude: float | None
    """m, displacement amplitude; None for a record that is no sine test."""
    time: Array
    """(n,) s, two cycles of a sine test, else up to three stretches of a few turns; at most 600."""
    displacement: Array
    """(n,) m."""
    velocity: Array
    """(n,) m/s."""
    force: Array
    """(n,) N, measured."""
    noise_percent: float | None
    """100 ||noise||/||F||."""
    responses: tuple[Response, ...] = ()
    """One for each of the predictions, in their order; empty where not drawn."""

    def __repr__(self) -> str:
        """Return the record's name and how much of it is shown: its curves would fill pages."""
        return f"<{type(self).__name__} of {self.file!r}: {counted(self.force.size, 'sample')}>"

    @property
    def predictions(self) -> tuple[tuple[str, Array], ...]:
        """A name and a force (n,), N, of each model; the one that matters most first."""
        return ()

    @property
    def errors_percent(self) -> tuple[float | None, ...]:
        """100 ||e||/||F|| of each prediction."""
        return ()

    @property
    def part(self) -> str:
        """What the record was for: "fitted" or "held out"."""
        return "held out" if self.held_out else "fitted"


@dataclass(frozen=True, kw_only=True, repr=False)
class RecordCurves(ShownRecord):
    """One record of a study: where it stands in the plan, and measured beside model."""

    band: int | None
    """Index into the study's bands; None where no band holds it."""
    structure: str
    """Structure of that band; "" where there is none."""
    dean_paper: float | None
    """Dean number at the speed amplitude, the paper's convention; None without a device."""
    dean_standard: float | None
    """The same by the standard convention."""
    model_force: Array
    """(n,) N, by the study's model."""
    error_percent: float | None
    """RMSE over the force's peak, percent."""
    relative_error_percent: float | None
    """100 ||e||/||F||."""

    @property
    def predictions(self) -> tuple[tuple[str, Array], ...]:
        """The study's model."""
        return (("model", self.model_force),)

    @property
    def errors_percent(self) -> tuple[float | None, ...]:
        """The study's model's."""
        return (self.relative_error_percent,)


@dataclass(frozen=True, kw_only=True, repr=False)
class SimulatedRecord(ShownRecord):
    """One record of a simulation, beside every model's force."""

    forces: tuple[tuple[str, Array], ...]
    """A name and a force (n,), N, of each model, best first."""
    misses: tuple[float | None, ...]
    """100 ||e||/||F|| of each."""

    @property
    def predictions(self) -> tuple[tuple[str, Array], ...]:
        """The models' forces, best first."""
        return self.forces

    @property
    def errors_percent(self) -> tuple[float | None, ...]:
        """Of each model."""
        return self.misses

    @property
    def part(self) -> str:
        """Models come as they are: "held out" or "other", none was fitted here."""
        return "held out" if self.held_out else "other"


@dataclass(frozen=True)
class BaselineAnswer:
    """What a named sparse-regression method says on the same columns of one band."""

    method: str
    """For instance "STLSQ", "SR3", "SSR"."""
    band: int
    """Index into the study's bands."""
    terms: tuple[tuple[str, float], ...]
    """(label, coefficient in SI) of each term that it keeps, in its own order."""
    relative_error_percent: float | None
    """100 ||e||/||F|| over the band's fitted records; None where it gave no model."""
    seconds: float | None = None
    """Time that it took, s."""


@dataclass(frozen=True)
class StructureProbability:
    """How probable one structure is in one band."""

    band: int
    """Index into the study's bands."""
    structure: str
    """"FOIM", "IOIM-linear", "IOIM-laminar", "IOIM-turbulent" or "other"."""
    probability: float
    """In [0, 1]; over a band's structures they add up to one."""


@dataclass(frozen=True, repr=False)
class StudyFigureData:
    """Everything that the study's pictures need and its document does not carry."""

    records: tuple[RecordCurves, ...]
    """In the campaign's order, held-out ones included."""
    baselines: tuple[BaselineAnswer, ...] = ()
    """Answers of the named methods, band by band."""
    probabilities: tuple[StructureProbability, ...] = ()
    """All structures that were weighed, band by band."""
    dean_per_speed_paper: float | None = None
    """Dean number per m/s of piston speed, the paper's convention; None without a device."""
    dean_per_speed_standard: float | None = None
    """The same by the standard convention."""

    def __repr__(self) -> str:
        """Return how many records there are curves of."""
        return f"<StudyFigureData of {counted(len(self.records), 'record')}>"


@dataclass(frozen=True)
class PlannedTest:
    """One sine test of a plan, or one window of a record that is none."""

    file: str
    """Name of the record as in the campaign."""
    kind: str
    """Kind of record: "sine", "periodic", "transient" or "trajectory"."""
    held_out: bool
    """Never fitted, only predicted."""
    frequency: float
    """Hz; of a window its mean frequency."""
    amplitude: float
    """m, displacement amplitude; of a window root two times its standard deviation."""
    noise_percent: float | None
    """The force's noise over the force, percent; None where it can't be told."""
    level: str
    """Gravest finding on the record: "error", "warning", or "" where there is neither."""


@dataclass(frozen=True)
class PlanFigureData:
    """Everything that the pictures of a plan need and ``check.json`` does not carry."""

    tests: tuple[PlannedTest, ...]
    """In the campaign's order."""
    dean_per_speed_paper: float | None = None
    """Dean number per m/s of piston speed, the paper's convention; None without a device."""
    dean_per_speed_standard: float | None = None
    """The same by the standard convention."""


@dataclass(frozen=True, kw_only=True, repr=False)
class GapCurves(ShownRecord):
    """One record of a gap search: measured, and the model before and after it was mended."""

    before: Array
    """(n,) N, the baseline's force."""
    after: Array
    """(n,) N, the mended model's force."""
    gap_before_percent: float
    """100 ||F - baseline||/||F||."""
    gap_after_percent: float
    """100 ||F - mended model||/||F||."""

    @property
    def predictions(self) -> tuple[tuple[str, Array], ...]:
        """The mended model, then the baseline."""
        return (("after", self.after), ("before", self.before))

    @property
    def errors_percent(self) -> tuple[float | None, ...]:
        """Likewise."""
        return (self.gap_after_percent, self.gap_before_percent)


@dataclass(frozen=True)
class EffectShape:
    """The force that one named effect adds, over what it follows, with its band."""

    round: int
    """Index into the document's rounds."""
    effect: str
    """Its id."""
    abscissa: str
    """What it follows: "velocity", "displacement", "acceleration" or "time"."""
    unit: str
    """SI unit of the abscissa."""
    x: Array
    """(m,) abscissa, SI."""
    force: Array
    """(m,) N, by the fitted effect."""
    lower: Array
    """(m,) N, lower end of its 95 % band."""
    upper: Array
    """(m,) N, upper end."""
    measured_x: Array
    """(k,) abscissa of the misfit that the effect was named from; empty where not shown."""
    measured: Array
    """(k,) N, that misfit: measured force less the rest of the model; empty where not shown."""
    joined: bool = True
    """Whether neighbours make a curve: not where a free motion comes back to a place by other
    ways."""


@dataclass(frozen=True)
class MisfitCell:
    """One cell of the misfit over displacement and velocity, over all records."""

    displacement: float
    """Middle of the cell over the record's displacement amplitude, in [-1, 1]."""
    velocity: float
    """Middle of the cell over the record's velocity amplitude, in [-1, 1]."""
    share: float
    """Mean misfit in the cell, signed, over the records' rms misfit."""


@dataclass(frozen=True, repr=False)
class GapFigureData:
    """Everything that a gap search's pictures need and its document does not carry."""

    records: tuple[GapCurves, ...]
    """In the campaign's order, held-out ones included."""
    shapes: tuple[EffectShape, ...] = ()
    """One for each effect that has a shape to show."""
    surface: tuple[MisfitCell, ...] = ()
    """The baseline's misfit over the cycle; empty where not drawn."""

    def __repr__(self) -> str:
        """Return how many records there are curves of."""
        return f"<GapFigureData of {counted(len(self.records), 'record')}>"

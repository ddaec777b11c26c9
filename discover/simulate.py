"""Forces that models predict for measured motion, beside the measured ones; models ranked."""

from __future__ import annotations

import io
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from discover.figure_data import SimulatedRecord
from discover.header import document_header
from discover.motion_fit import Observation, observe_all
from discover.record_curves import record_view, response
from discover.records import Campaign, Finding, checked_campaign
from discover.rows import (
    Accuracy,
    accuracy,
    compared_with,
    force_at_samples,
    noise_percent,
    pooled_percent,
)
from discover.words import counted, model_names
from models.checks import Array, InputError, shown
from models.constitutive import ForceModel, SegmentedModel
from models.flow import dean_per_speed

if TYPE_CHECKING:
    import pandas

Model = ForceModel | SegmentedModel


@dataclass(frozen=True)
class RecordPrediction:
    """One model's force on one record."""

    accuracy: Accuracy
    """Model and measurement compared."""
    bands: tuple[int, ...]
    """Bands of a segmented model that were used, counted from zero."""

    def to_dict(self) -> dict[str, Any]:
        """Return the entry of ``simulation.json``."""
        a = self.accuracy
        return {
            "file": a.observation.file,
            "held_out": a.observation.held_out,
            "error_percent": a.of_peak_percent,
            "relative_error_percent": a.relative_percent,
            "noise_percent": a.noise_percent,
            "bands": list(self.bands),
        }


@dataclass(frozen=True)
class ModelPrediction:
    """One model on all records."""

    name: str
    """Name of the model, as given."""
    records: tuple[RecordPrediction, ...]
    """In the campaign's order."""
    rank: int
    """From one: by the relative error pooled over held-out records, or over all without any."""

    def relative_percent(self, *, held_out: bool | None = None) -> float | None:
        """Return 100 ||e||/||F|| pooled over held-out, fitted or (None) all records."""
        return _pooled(self.records, held_out=held_out)

    def to_dict(self) -> dict[str, Any]:
        """Return the entry of ``simulation.json``."""
        return {
            "name": self.name,
            "rank": self.rank,
            "relative_error_percent": self.relative_percent(held_out=False),
            "held_out_relative_error_percent": self.relative_percent(held_out=True),
            "records": [r.to_dict() for r in self.records],
        }


@dataclass(frozen=True, repr=False)
class ForceComparison:
    """Models beside a campaign."""

    title: str
    """The campaign's."""
    content_hash: str
    """The campaign's."""
    seed: int
    """As asked; nothing here is random."""
    models: tuple[ModelPrediction, ...]
    """In the order given."""
    findings: tuple[Finding, ...]
    """What a reader should know, in words."""

    @property
    def ranked(self) -> tuple[ModelPrediction, ...]:
        """Models, best first."""
        return tuple(sorted(self.models, key=lambda m: m.rank))

    def __repr__(self) -> str:
        """Return each model's error on all records, the best model first."""
        told = []
        for model in self.ranked:
            error = model.relative_percent()
            told.append(f"{model.name} " + ("no force" if error is None else f"{error:.3g} %"))
        count = counted(len(self.models[0].records), "record")
        return f"<Forces on {count} of {shown(self.title)}, error: {', '.join(told)}>"

    def to_frame(self) -> pandas.DataFrame:
        """Return the errors as a table, a row for every model and record.

        Columns are model, record, held_out, error_percent (root mean square over the force's
        peak), relative_error_percent (100 ||e||/||F||), noise_percent.
        """
        import pandas

        rows = []
        for model in self.models:
            for record in model.records:
                entry = record.to_dict()
                rows.append({
                    "model": model.name, "record": entry["file"], "held_out": entry["held_out"],
                    "error_percent": entry["error_percent"],
                    "relative_error_percent": entry["relative_error_percent"],
                    "noise_percent": entry["noise_percent"],
                })  # fmt: skip
        return pandas.DataFrame(rows)

    def forces(self) -> dict[str, pandas.DataFrame]:
        """Return the samples by record: time, displacement, velocity, force, each model's force.

        Columns are named with their SI units, as ``force [N]``; a model's is its own name.
        """
        import pandas

        return {
            r.accuracy.observation.file: pandas.DataFrame(self._columns(index))
            for index, r in enumerate(self.models[0].records)
        }

    def _columns(self, index: int) -> dict[str, Array]:
        observation = self.models[0].records[index].accuracy.observation
        columns = {
            "time [s]": observation.time,
            "displacement [m]": observation.at_samples(observation.motion.displacement),
            "velocity [m/s]": observation.at_samples(observation.motion.velocity),
            "force [N]": observation.measured,
        }
        for model in self.models:
            columns[f"{model.name} [N]"] = model.records[index].accuracy.model_force
        return columns

    def to_dict(self) -> dict[str, Any]:
        """Return the document ``simulation.json``."""
        accuracies = [r.accuracy for r in self.models[0].records]
        return {
            **document_header(
                "simulation", seed=self.seed, title=self.title, content_hash=self.content_hash
            ),
            "noise_percent": noise_percent(accuracies),
            "ranked_on": "held-out records" if _any_held_out(self.models) else "all records",
            "models": [m.to_dict() for m in self.models],
            "findings": [f.to_dict() for f in self.findings],
        }

    def shown(self) -> tuple[SimulatedRecord, ...]:
        """Return what pictures need of the records, in the campaign's order."""
        drawn = []
        ranked = self.ranked
        names = model_names([m.name for m in ranked])
        for index, first in enumerate(ranked[0].records):
            view = record_view(first.accuracy)
            all_models = [m.records[index].accuracy for m in ranked]
            forces = [a.model_force[view.chosen] for a in all_models]
            drawn.append(
                SimulatedRecord(
                    **view.measured,
                    responses=tuple(response(a) for a in all_models),
                    forces=tuple(zip(names, forces, strict=True)),
                    misses=tuple(a.relative_percent for a in all_models),
                )
            )
        return tuple(drawn)

    def tables(self) -> dict[str, str]:
        """Return one CSV a record, by file name: motion, measured force, each model's force."""
        tables: dict[str, str] = {}
        for index, first in enumerate(self.models[0].records):
            name = _table_name(first.accuracy.observation.file, tables)
            tables[name] = _csv(self._columns(index))
        return tables


def simulate_forces(
    campaign: Campaign, models: Mapping[str, Model], *, seed: int = 0, jobs: int = 1
) -> ForceComparison:
    """Return each model's force for the measured motion of every record.

    Parameters
    ----------
    campaign : Campaign
        Measured records.
    models : mapping of str to ForceModel or SegmentedModel
        By the names that they are to be shown under.
    seed : int
        Kept in the document.
    jobs : int
        Records that are read at a time.

    Returns
    -------
    ForceComparison
        ``to_frame()`` has errors in percent, ``forces()`` the samples (N,) in N.

    Raises
    ------
    InputError
        Without models, or for a segmented model whose coordinate the campaign can't give.

    Examples
    --------
    >>> import discover
    >>> from models.constitutive import ioim_laminar
    >>> campaign = discover.read_campaign("data/hidden-effect")
    >>> found = simulate_forces(campaign, {"laminar": ioim_laminar(campaign.device)})
    >>> found.to_frame().shape
    (15, 6)
    """
    if not models:
        raise InputError("models", expected="at least one", found="none")
    checked_campaign(campaign)
    observations = observe_all(campaign.records, jobs)
    predicted = {
        name: tuple(predict_record(o, model) for o in observations)
        for name, model in models.items()
    }
    held_out = any(o.held_out for o in observations)
    errors: dict[str, float] = {}
    for name, records in predicted.items():
        error = _pooled(records, held_out=True if held_out else None)
        errors[name] = np.inf if error is None else error
    order = sorted(models, key=errors.__getitem__)
    answers = tuple(
        ModelPrediction(name, records, order.index(name) + 1) for name, records in predicted.items()
    )
    return ForceComparison(
        campaign.title, campaign.content_hash, seed, answers, _findings(answers, observations)
    )


def predict_record(observation: Observation, model: Model) -> RecordPrediction:
    """Return a model's force on one record, with the band of a segmented model by window."""
    if isinstance(model, ForceModel):
        return RecordPrediction(accuracy(observation, model), (0,))
    chosen = [_band(model, w.speed, w.frequency) for w in observation.windows]
    if len(set(chosen)) == 1:
        return RecordPrediction(accuracy(observation, model.bands[chosen[0]].model), (chosen[0],))
    forces = {b: force_at_samples(observation, model.bands[b].model) for b in set(chosen)}
    # Windows follow each other; their shares of the duration say where each begins.
    ends = np.cumsum([w.share for w in observation.windows])
    size = observation.measured.size
    at = np.searchsorted(ends[:-1] / ends[-1], (np.arange(size) + 0.5) / size)
    bands = np.array(chosen)[at]
    force = np.zeros(size)
    for band, values in forces.items():
        force[bands == band] = values[bands == band]
    return RecordPrediction(compared_with(observation, force), tuple(sorted(forces)))


def _band(model: SegmentedModel, speed: float, frequency: float) -> int:
    if len(model.bands) == 1:
        return 0
    if model.coordinate == "frequency":
        value = frequency
    elif model.coordinate == "speed":
        value = speed
    elif model.device is None:
        raise InputError(
            "device of a model segmented by Dean number", expected="given", found="nothing",
            where=model.name,
        )  # fmt: skip
    else:
        value = dean_per_speed(model.device, convention=model.convention) * speed
    chosen = model.at(value)
    return next(i for i, band in enumerate(model.bands) if band.model is chosen)


def _pooled(records: Sequence[RecordPrediction], *, held_out: bool | None) -> float | None:
    chosen = [
        r.accuracy
        for r in records
        if held_out is None or r.accuracy.observation.held_out is held_out
    ]
    return pooled_percent(chosen) if chosen else None


def _any_held_out(models: Sequence[ModelPrediction]) -> bool:
    return any(r.accuracy.observation.held_out for r in models[0].records)


def _findings(
    models: Sequence[ModelPrediction], observations: Sequence[Observation]
) -> tuple[Finding, ...]:
    found = []
    if not _any_held_out(models) and len(models) > 1:
        found.append(
            Finding("warning", "No record is held out: the ranking favours models fitted to these.")
        )
    fitted = [o.file for o in observations if o.phase_fitted]
    if fitted:
        found.append(
            Finding(
                "note",
                f"{len(fitted)} of {len(observations)} records have no displacement: their phase"
                " was fitted to the force.",
            )
        )
    noise = noise_percent([r.accuracy for r in models[0].records])
    best = min(models, key=lambda m: m.rank)
    error = best.relative_percent(held_out=True if _any_held_out(models) else None)
    if error is not None and error < 1.1 * noise:
        text = f"The best, {best.name}, predicts to within the noise of the measurement."
        found.append(Finding("note", text))
    return tuple(found)


def _table_name(file: str, taken: Mapping[str, str]) -> str:
    whole = not file.endswith("]")  # else a part of a file, named after it in brackets
    stem = re.sub(r'[\\/:*?"<>|]', "-", file.rsplit(".", 1)[0] if whole else file)
    name, count = f"{stem}.csv", 1
    while name in taken:
        count += 1
        name = f"{stem}-{count}.csv"
    return name


def _csv(columns: Mapping[str, Array]) -> str:
    text = io.StringIO()
    header = ",".join(f'"{name}"' if "," in name else name for name in columns)
    np.savetxt(
        text, np.column_stack(list(columns.values())), fmt="%.9g", delimiter=",", header=header,
        comments="",
    )  # fmt: skip
    return text.getvalue()

"""The page of documents: every key of real ones, with what the values' own fields say of it."""

from __future__ import annotations

import ast
import inspect
import textwrap
from collections.abc import Iterator, Mapping
from functools import cache
from pathlib import Path
from typing import Any

import discover
from discover.compare import comparison_document, side_of_model, side_of_study
from discover.compare.differences import Difference
from discover.compare.side import Side, SideBand
from discover.data_check import result as check_result
from discover.dean import DeanCheck
from discover.gap import result as gap_result
from discover.gap.where import Place
from discover.next_test import NextTest
from discover.record_checks import RecordCheck
from discover.rows import Accuracy, Unexplained
from discover.simulate import ForceComparison, ModelPrediction
from discover.study import result as study_result
from models.constitutive import Band, FittedTerm, SegmentedModel, ioim_laminar
from models.device import Device, Fluid
from models.terms import TERMS

_DATA = Path(__file__).parents[1] / "data"
_HELD_BY = {
    "study": study_result.Study,
    "study.bands[]": study_result.StudyBand,
    "study.bands[].remainder_percent": Unexplained,
    "study.bands[].friction": study_result.FrictionCurve,
    "study.bands[].terms[]": study_result.TermEstimate,
    "study.bands[].extras[]": study_result.Extra,
    "study.boundaries[]": study_result.StudyBoundary,
    "study.nuisance[]": study_result.Nuisance,
    "study.dean_check": DeanCheck,
    "study.next_test": NextTest,
    "gap": gap_result.Gap,
    "gap.where[]": Place,
    "gap.rounds[]": gap_result.NamedEffect,
    "gap.mended[]": gap_result.MendedTerm,
    "gap.records[]": gap_result.RecordGap,
    "gap.remainder_percent": Unexplained,
    "model": SegmentedModel,
    "model.bands[]": Band,
    "model.bands[].terms[]": FittedTerm,
    "model.device": Device,
    "model.device.fluid": Fluid,
    "check": check_result.DataCheck,
    "check.records[]": RecordCheck,
    "check.structures[]": check_result.Conditioning,
    "check.pairs[]": check_result.Pair,
    "check.inseparable[]": check_result.Inseparable,
    "check.added_test": check_result.AddedTest,
    "simulation": ForceComparison,
    "simulation.models[]": ModelPrediction,
    "simulation.models[].records[]": Accuracy,
    "comparison.sides[]": Side,
    "comparison.sides[].bands[]": SideBand,
    "comparison.sides[].bands[].terms[]": study_result.TermEstimate,
    "comparison.quantities[]": Difference,
    "comparison.errors[].models[]": ModelPrediction,
    "comparison.errors[].models[].records[]": Accuracy,
}
"""The value that holds what a place in a document says, by document and place."""

_COMMON = {
    "schema": "Name and number of the document's form.",
    "version": "Of the program.",
    "campaign": "What it is about.",
    "campaign.title": "As given by the user.",
    "campaign.hash": "SHA-256 over `campaign.toml` and the records' bytes.",
    "findings[].level": '"error", "warning" or "note".',
    "findings[].text": "What was found and what to do about it.",
    "findings[].record": "The record that it concerns; absent for the whole campaign.",
}
_EVERYWHERE = {
    "id": "Id in the vocabulary.",
    "unit": "SI, of the coefficient.",
    "coefficient": "In `unit`.",
    "interval": "95 %, of the value or coefficient beside it.",
    "alternatives": "What else it may be, most probable first.",
    "alternatives[].effect": "Id of an effect.",
    "alternatives[].probability": "Of that effect.",
    "expected[].gap_nats": "Nats.",
}
_SAID = {
    "study.headline": "The answer in one sentence.",
    "study.bands[].core": "The structure's name again: without what the device has besides.",
    "study.bands[].remainder_percent": "What no term explains, beyond noise, percent of the force.",
    "study.bands[].remainder_percent.value": "Most probable one, percent.",
    "study.bands[].friction.curve": "How friction reverses, in words.",
    "study.bands[].friction.transition_speed": "m/s, over which friction reverses.",
    "study.bands[].friction.transition_speed_interval": "95 %.",
    "study.bands[].friction.presliding_displacement": "m, over which friction reverses.",
    "study.bands[].friction.presliding_displacement_interval": "95 %.",
    "study.bands[].equivalents[].structure": "Its name.",
    "study.bands[].equivalents[].probability": "Of that structure.",
    "gap.baseline.terms": "With coefficient and shape.",
    "gap.baseline.fitted": "Its coefficients were fitted first.",
    "gap.baseline.fixed": "They were held throughout.",
    "gap.held_out_by": '"marked records", or "each record in turn" where none is marked.',
    "gap.where[].misfit_over_noise": "Misfit over what noise explains; 1 where all is noise.",
    "gap.where[].profile": "What the misfit follows, in words.",
    "gap.where[].near_reversal": "Share of the misfit within 5 % of the stroke around reversal.",
    "gap.where[].odd_harmonics": "Share in odd harmonics; null where it is no sine test.",
    "gap.rounds[].not_distinguishable_from": "Alternatives that the records can't tell from it.",
    "gap.rounds[].gap_before_percent": "Of the fitted records, pooled in N.",
    "gap.rounds[].gap_after_percent": "Likewise, with the effect.",
    "gap.rounds[].rms_record_gap_before_percent": "Root mean square of the records' own gaps.",
    "gap.rounds[].rms_record_gap_after_percent": "Likewise, with the effect.",
    "gap.rounds[].held_out_before_percent": "On records that were not fitted; null for one record.",
    "gap.rounds[].held_out_after_percent": "Likewise, with the effect.",
    "gap.records[].noise_percent": "100 ||noise||/||F||.",
    "gap.records[].gap_before_percent": "100 ||F - baseline||/||F||.",
    "gap.records[].gap_after_percent": "100 ||F - mended model||/||F||.",
    "gap.remainder_percent": "What no term explains, beyond noise, percent of the force.",
    "gap.remainder_percent.value": "Most probable one, percent.",
    "gap.contest": "The contest that ended the search, most probable first.",
    "gap.contest[].effect": "Id of an effect, or none.",
    "gap.contest[].probability": "Of that effect.",
    "model.seed": "Of the run that made it.",
    "model.bands[].name": "The structure's.",
    "model.bands[].coordinate": "The model's, again.",
    "model.bands[].terms": "With coefficient and shape.",
    "check.records[].cycles": "Of a sine test.",
    "check.records[].usable_samples": "Samples without the run-in and the run-out.",
    "check.pairs[].gap_nats": "Expected log-likelihood gap in the case that is harder to tell.",
    "check.pairs[].expected": "With the first true, with the second true.",
    "check.pairs[].expected[].truth": "What makes the force.",
    "check.pairs[].expected[].model": "What is fitted to it.",
    "check.pairs[].expected[].word": '"separable", "inseparable", or "nested" where the model'
    " holds the truth as a case.",
    "check.inseparable[].gap": "Expected log-likelihood gap, nats.",
    "check.added_test.gap_nats": "The expected gap of the pair then.",
    "simulation.noise_percent": "100 ||noise||/||F||, pooled.",
    "simulation.ranked_on": '"held-out records", or "all records" where none is held out.',
    "simulation.models[].relative_error_percent": "Pooled over the fitted records.",
    "simulation.models[].held_out_relative_error_percent": "Pooled over the held-out records.",
    "simulation.models[].records[].file": "Name of the record.",
    "simulation.models[].records[].held_out": "True where it was never fitted.",
    "simulation.models[].records[].error_percent": "RMSE over the model force's peak.",
    "simulation.models[].records[].relative_error_percent": "100 ||e||/||F||.",
    "simulation.models[].records[].bands": "Bands of the model that were used, from 0.",
    "comparison.seed": "Of what was run.",
    "comparison.sides": "The answers, in the order given.",
    "comparison.sides[].bands[].terms[].parts": "Of friction whose curve is a sum, in words.",
    "comparison.sides[].campaign": "What it rests on; empty for a model alone.",
    "comparison.sides[].campaign.title": "As given by the user.",
    "comparison.sides[].campaign.hash": "SHA-256 over `campaign.toml` and the records' bytes.",
    "comparison.same_structures": "Every answer has the same structures in as many bands.",
    "comparison.quantities": "Every number that an answer has, band by band.",
    "comparison.quantities[].values": "In each answer; null where it lacks the term.",
    "comparison.quantities[].values[].value": "In `unit`.",
    "comparison.errors[].models": "Of each answer.",
    "comparison.findings": "What a reader has to know.",
    "comparison.errors": "Of every answer on common records, an entry a campaign.",
    "comparison.errors[].campaign": "Whose records they are.",
    "comparison.errors[].campaign.title": "As given by the user.",
    "comparison.errors[].campaign.hash": "SHA-256 over `campaign.toml` and the records' bytes.",
}
_LIKE = {"comparison.errors[].": "simulation."}
"""Places of one document that hold what another's do."""


def documents_page() -> str:
    """Return the page, from documents that the shipped campaigns give."""
    segmented = discover.read_campaign(_DATA / "segmented")
    hidden = discover.read_campaign(_DATA / "hidden-effect")
    study = discover.run_study(segmented)
    gap = discover.close_gap(
        hidden, "fit:inertia,viscous-damping,coulomb-friction",
        effects=["asymmetric-damping", "quadratic-damping"],
    )  # fmt: skip
    device = segmented.device
    if device is None:
        raise ValueError("the segmented campaign has lost its device")
    laminar = SegmentedModel(
        (Band(None, None, ioim_laminar(device)),), "speed", "paper", device, "laminar"
    )
    sides = [side_of_study("study", study), side_of_model("laminar", laminar)]
    simulated = discover.simulate_forces(segmented, {s.name: s.model for s in sides}).to_dict()
    shown = {
        "study": (study.to_dict(), "the answer of `inerter discover` and `discover.run_study`"),
        "gap": (gap.to_dict(), "the answer of `inerter gap` and `discover.close_gap`"),
        "model": (study.model_dict(), "enough to simulate from; `--model` takes it"),
        "check": (
            discover.check_campaign(hidden).to_dict(),
            "the answer of `inerter check` and `discover.check_campaign`",
        ),
        "simulation": (
            simulated, "the answer of `inerter simulate` and `discover.simulate_forces`"
        ),
        "comparison": (
            comparison_document(sides, [simulated], seed=0), "the answer of `inerter compare`"
        ),
    }
    lines = [
        "# Documents",
        "",
        "Every verb writes its answer as a JSON document. Numbers are SI, finite or null. A key"
        " that is told as `a[].b` stands in every entry of the list `a`. The keys below are those"
        " of the documents that the shipped campaigns give; a key for which there was nothing to"
        " say is left out there, as it is in the documents. A term's shape parameters stand beside"
        " its coefficient by their own names: [terms and effects](terms.md) lists them.",
        "",
    ]
    for name, (document, what) in shown.items():
        lines += [f"## {name}.json", "", f"It is {what}.", "", "| key | meaning |", "|---|---|"]
        for key in _keys(document):
            lines.append(f"| `{key}` | {_meaning(name, key)} |")
        lines.append("")
    lines += [
        "`inerter design`, `reproduce`, `init` and `batch` write `design.json`,"
        " `reproduction.json`, `init.json` and `batch.json` with the same header.",
        "",
    ]
    return "\n".join(lines)


def _keys(document: Mapping[str, Any], above: str = "") -> Iterator[str]:
    """Yield every key, those of lists once over all entries, without shapes of terms."""
    shapes = {p.name for t in TERMS.values() for p in t.parameters} if "id" in document else set()
    for key, value in document.items():
        if key.removesuffix("_interval") in shapes:
            continue
        path = f"{above}{key}"
        yield path
        if isinstance(value, Mapping) and key not in ("parameters", "follows"):
            yield from _keys(value, f"{path}.")
        elif isinstance(value, list) and (entries := [v for v in value if isinstance(v, Mapping)]):
            merged: dict[str, Any] = {}
            for entry in entries:
                for k, v in entry.items():
                    if merged.get(k) in (None, [], {}):
                        merged[k] = v
            yield from _keys(merged, f"{path}[].")


def _meaning(name: str, key: str) -> str:
    """Return what a key means: by its own name here, or by the field that it comes from."""
    if key in _COMMON:
        return _cell(_COMMON[key])
    whole = f"{name}.{key}"
    like = next((whole.replace(a, b, 1) for a, b in _LIKE.items() if whole.startswith(a)), whole)
    if said := _SAID.get(whole) or _SAID.get(like):
        return _cell(said)
    place, _, last = f"{name}.{key}".rpartition(".")
    holder = _HELD_BY.get(place)
    said = {} if holder is None else _fields(holder)
    if last in said:
        return _cell(said[last])
    parts = key.split(".")
    for i in range(len(parts)):
        if (near := ".".join(parts[i:])) in _EVERYWHERE:
            return _cell(_EVERYWHERE[near])
    raise KeyError(f"{name}.json: nothing says what {key} is; say it in docs/page_documents.py")


def _cell(text: str) -> str:
    return text.replace("|", "\\|").replace("*", "\\*").replace("None", "null")


@cache
def _fields(holder: type) -> dict[str, str]:
    """Return what a value's fields and properties say of themselves."""
    (body,) = ast.parse(textwrap.dedent(inspect.getsource(holder))).body
    told: dict[str, str] = {}
    if not isinstance(body, ast.ClassDef):
        return told
    for field, said in zip(body.body, [*body.body[1:], None], strict=True):
        if isinstance(field, ast.FunctionDef) and field.decorator_list:
            told[field.name] = ast.get_docstring(field) or ""
        if not isinstance(field, ast.AnnAssign) or not isinstance(field.target, ast.Name):
            continue
        if isinstance(said, ast.Expr) and isinstance(said.value, ast.Constant):
            told[field.target.id] = " ".join(str(said.value.value).split())
    return told

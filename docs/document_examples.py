"""Documents as the program writes them, whose keys the page of documents tells."""

from __future__ import annotations

import tempfile
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import discover
from discover.batch.answer import Answer
from discover.batch.document import batch_document
from discover.batch.table import table_rows
from discover.compare import comparison_document, side_of_model, side_of_study
from discover.header import document_header
from discover.readers import Answers, draft_campaign, record_files
from discover.report.draft import draft_document
from discover.reproduction import reproduce
from models.constitutive import Band, SegmentedModel, ioim_laminar
from models.design import DesignBounds, minimise_critical_frequency
from models.device import Device

_DATA = Path(__file__).parents[1] / "data"


def examples() -> dict[str, tuple[str, list[Mapping[str, Any]]]]:
    """Return for every document what it is, and some as the shipped campaigns give them."""
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
    return {
        "study": (
            "the answer of `inerter discover` and `discover.run_study`", [study.to_dict()]
        ),
        "gap": ("the answer of `inerter gap` and `discover.close_gap`", [gap.to_dict()]),
        "model": ("enough to simulate from; `--model` takes it", [study.model_dict()]),
        "check": (
            "the answer of `inerter check` and `discover.check_campaign`",
            [discover.check_campaign(hidden).to_dict()],
        ),
        "simulation": (
            "the answer of `inerter simulate` and `discover.simulate_forces`", [simulated]
        ),
        "comparison": (
            "the answer of `inerter compare`",
            [comparison_document(sides, [simulated], seed=0)],
        ),
        "design": ("the answer of `inerter design`", _designs(device)),
        "reproduction": ("the answer of `inerter reproduce`", [reproduce().to_dict()]),
        "init": ("the answer of `inerter init`", [_draft()]),
        "batch": ("the answer of `inerter batch`", [_batch(study.to_dict(), gap.to_dict())]),
    }  # fmt: skip


def _designs(device: Device) -> list[Mapping[str, Any]]:
    """Return a design within a device's own bounds, and one that bounds keep out."""
    possible = DesignBounds.around(device)
    documents = []
    for bounds in (possible, replace(possible, package_length=0.01)):
        found = minimise_critical_frequency(device, bounds=bounds, front=False)
        header = document_header("design", seed=0, title="", content_hash="")
        documents.append({**header, **found.to_dict(), "loop": None})
    return documents


def _draft() -> Mapping[str, Any]:
    """Return what is drafted of records, one with bare headers and one that lacks time."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for record in sorted((_DATA / "hidden-effect").glob("0.3hz-*.csv")):
            _, *samples = record.read_text(encoding="utf-8").splitlines()
            (folder / record.name).write_text("\n".join(["t,x,F", *samples]), encoding="utf-8")
        (folder / "without-time.csv").write_text("load,travel\n1,2\n2,3\n", encoding="utf-8")
        draft = draft_campaign(
            folder, record_files(folder), title="lab", answers=Answers({}, {}, None)
        )
    return draft_document(draft, content_hash="", written="lab/campaign.toml")


def _batch(study: Mapping[str, Any], gap: Mapping[str, Any]) -> Mapping[str, Any]:
    """Return the document of campaigns with the same answer, and of one that failed."""
    answers = [
        Answer("one", "lab/one", study, gap),
        Answer("two", "lab/two", study),
        Answer("three", "lab/three", None, None, "no such file"),
    ]
    return batch_document(answers, table_rows(answers), seed=0, model=None, pool=True)

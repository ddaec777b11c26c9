"""One of the answers that are compared, from a study, a gap search or a model alone."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from discover.friction_parts import whole_friction
from discover.study import Study
from discover.words import listed, short_name
from models.constitutive import SegmentedModel
from models.cores import core_of

Entry = Mapping[str, Any]


@dataclass(frozen=True)
class SideBand:
    """A band of one answer."""

    lower: float | None
    """Lower end of the coordinate; None where open."""
    upper: float | None
    """Upper end of the coordinate; None where open."""
    structure: str
    """Of the paper's, or "other"."""
    probability: float | None
    """Of the structure; None for a model alone."""
    terms: tuple[Entry, ...]
    """As in documents, friction's parts as one; ``interval`` only where it is known."""


@dataclass(frozen=True)
class Side:
    """One answer."""

    name: str
    """As shown, different for each."""
    kind: str
    """"study", "gap" or "model"."""
    title: str
    """Of the campaign that it rests on; "" for a model alone."""
    content_hash: str
    """Of that campaign; "" for a model alone."""
    headline: str
    """The answer in a sentence."""
    coordinate: str
    """"dean", "speed" or "frequency"."""
    bands: tuple[SideBand, ...]
    """In rising coordinate."""
    model: SegmentedModel
    """To predict with."""


def side_of_study(name: str, study: Study) -> Side:
    """Return a study as one side."""
    document = study.to_dict()
    bands = tuple(
        SideBand(
            b["lower"], b["upper"], b["structure"], b["probability"],
            tuple(whole_friction(b["terms"])),
        )
        for b in document["bands"]
    )  # fmt: skip
    campaign = document["campaign"]
    return Side(
        name, "study", campaign["title"], campaign["hash"], document["headline"],
        document["coordinate"], bands, study.model,
    )  # fmt: skip


def side_of_model(name: str, model: SegmentedModel) -> Side:
    """Return a model alone as one side: its coefficients have no intervals."""
    return Side(name, "model", "", "", "", model.coordinate, _bands(model), model)


def side_of_gap(name: str, document: Mapping[str, Any], model: SegmentedModel) -> Side:
    """Return a mended model as one side, with the intervals of ``gap.json`` where it is one band.

    Parameters
    ----------
    name : str
        As shown.
    document : mapping
        ``gap.json``.
    model : SegmentedModel
        The ``model.json`` beside it.
    """
    bands = _bands(model)
    if len(bands) == 1:
        (band,) = bands
        terms = tuple(whole_friction(document["mended"]))
        bands = (SideBand(band.lower, band.upper, band.structure, None, terms),)
    added = [short_name(r["effect"]) for r in document["rounds"]]
    headline = f"{document['verdict']}: " + (f"{listed(added)} added" if added else "as it was")
    campaign = document["campaign"]
    return Side(
        name, "gap", campaign["title"], campaign["hash"], headline, model.coordinate, bands, model
    )


def _bands(model: SegmentedModel) -> tuple[SideBand, ...]:
    return tuple(
        SideBand(
            b.lower, b.upper, core_of([t.id for t in b.model.terms]), None,
            tuple(whole_friction(_terms(b.model.to_dict()))),
        )
        for b in model.bands
    )  # fmt: skip


def _terms(model: Mapping[str, Any]) -> Sequence[Entry]:
    return list(model["terms"])

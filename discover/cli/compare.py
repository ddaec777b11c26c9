"""``inerter compare``: studies, models or campaigns side by side."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from discover.cli import options
from discover.cli.invocation import Invocation
from discover.cli.results import deliver, model_label, result_folder, working
from models.checks import InputError

if TYPE_CHECKING:
    from discover.compare import Side
    from discover.records import Campaign
    from models.constitutive import ForceModel, SegmentedModel
    from models.device import Device


def compare(
    context: typer.Context,
    answers: Annotated[
        list[str],
        typer.Argument(
            metavar="A B…",
            help="Folders of results of discover or gap, study.json, model.json, campaigns (they"
            " are studied first), or models by name.",
        ),
    ],
    on: Annotated[
        list[Path] | None,
        typer.Option(
            "--on",
            metavar="CAMPAIGN",
            help="Predict these records with every answer too; may be given again"
            " [default: the campaigns among the answers].",
            show_default=False,
        ),
    ] = None,
    effect_files: options.EffectFiles = None,
    figures: options.Figures = None,
    out: options.Out = None,
    as_json: options.AsJson = False,
    seed: options.Seed = options.DEFAULT_SEED,
    jobs: options.Jobs = 1,
) -> int:
    """Put answers side by side, and say where they differ.

    Structures, coefficients with intervals, errors on common records. Writes comparison.json and
    a page.
    """
    if len(answers) < 2:
        raise InputError("answers", expected="two or more", found=answers[0], where="compare")
    options.each_once("answers", answers, where="compare")
    formats = options.figure_formats(figures)
    names = _short(answers)
    folder = result_folder("compare", names[0], out, model="-".join(names[1:]))

    # Loaded here: --help and complaints about options need no numerics.
    from discover.cli.own_effects import own_effects
    from discover.compare import comparison_document
    from discover.readers import read_campaign
    from discover.report.comparison import comparison_files, comparison_lines
    from discover.simulate import simulate_forces
    from models.terms import own_terms

    with working("Reading effects"):
        own = own_effects(effect_files)
    context.with_resource(own_terms(*own))
    common: dict[str, Campaign] = {}
    for path in on or ():
        with working(f"Reading {path}"):
            common[str(path)] = read_campaign(path)
    device = next((c.device for c in common.values() if c.device is not None), None)
    sides, studied = _sides(
        dict(zip(names, answers, strict=True)), device, common, seed=seed, jobs=jobs
    )
    if on is None:
        common = studied
    simulations = []
    for shown, records in common.items():
        with working(f"Predicting {shown}"):
            models = {s.name: s.model for s in sides}
            simulations.append(simulate_forces(records, models, seed=seed, jobs=jobs).to_dict())
    document = comparison_document(sides, simulations, seed=seed)
    with working("Drawing"):
        invocation: Invocation = context.obj
        files = comparison_files(document, command=invocation.repeat(seed=seed), formats=formats)
    deliver(
        document,
        name="comparison.json",
        folder=folder,
        files=files,
        summary=comparison_lines(document),
        as_json=as_json,
    )
    return 0


def _sides(
    answers: Mapping[str, str], device: Device | None, common: Mapping[str, Campaign], *,
    seed: int, jobs: int,
) -> tuple[list[Side], dict[str, Campaign]]:
    """Return the answers read, in the order of their names, and the campaigns studied for it.

    Models that are no files come last: they take the device of the others, and are fitted to the
    common records where their coefficients have to be.
    """
    found: dict[str, Side] = {}
    studied: dict[str, Campaign] = {}
    for name, answer in sorted(answers.items(), key=lambda given: not Path(given[1]).exists()):
        with working(f"Reading {answer}"):
            records = next(iter((common or studied).values()), None)
            side, campaign = _side(name, answer, device, records, seed=seed, jobs=jobs)
        found[name] = side
        device = side.model.device if device is None else device
        # A copy of records that are there already would tell the same errors again.
        hashes = {known.content_hash for known in studied.values()}
        if campaign is not None and campaign.content_hash not in hashes:
            studied[answer] = campaign
    return [found[name] for name in answers], studied


def _side(
    name: str, answer: str, device: Device | None, records: Campaign | None, *, seed: int,
    jobs: int,
) -> tuple[Side, Campaign | None]:
    """Return an answer from what was typed, and the campaign where it was studied for this.

    A model whose coefficients have to be fitted first is fitted to `records`.
    """
    from discover.cli.gap_answer import FIT, fitted_first, predicting_model
    from discover.compare import side_of_gap, side_of_model, side_of_study
    from discover.named_model import named_model
    from discover.readers import read_campaign
    from discover.study import StudyOptions, load_study, run_study

    path = Path(answer)
    if path.is_dir():
        if (path / "study.json").is_file():
            return side_of_study(name, load_study(path)), None
        if (path / "gap.json").is_file():
            model = named_model(str(path / "model.json"), None, where=answer)
            return side_of_gap(name, _document(path / "gap.json"), model), None
    if path.suffix == ".json" and path.is_file():
        schema = _document(path).get("schema")
        if schema == "inerter.study/1":
            return side_of_study(name, load_study(path)), None
        return side_of_model(name, named_model(answer, device, where=answer)), None
    if path.exists():
        campaign = read_campaign(path)
        study = run_study(campaign, StudyOptions(seed=seed, jobs=jobs))
        return side_of_study(name, study), campaign
    if answer.startswith(FIT) and records is None:
        raise InputError(
            answer, expected="used with --on CAMPAIGN, which it is fitted to", found="none",
            where="compare",
        )  # fmt: skip
    if records is not None and fitted_first(answer, records.device):
        fitted = predicting_model(records, answer, seed=seed, jobs=jobs)
        return side_of_model(name, _banded(fitted)), None
    return side_of_model(name, named_model(answer, device, where=answer)), None


def _banded(model: ForceModel | SegmentedModel) -> SegmentedModel:
    from models.constitutive import Band, ForceModel, SegmentedModel

    if not isinstance(model, ForceModel):
        return model
    return SegmentedModel((Band(None, None, model),), "speed")


def _document(path: Path) -> dict[str, Any]:
    """Return a JSON document.

    Raises
    ------
    InputError
        Where the file holds none.
    """
    try:
        table = json.loads(path.read_text(encoding="utf-8-sig"))
    except (ValueError, RecursionError) as error:
        raise InputError("not valid JSON", found=str(error), where=str(path)) from None
    if not isinstance(table, dict):
        found = type(table).__name__
        raise InputError("document", expected="a JSON object", found=found, where=str(path))
    return table


def _short(answers: list[str]) -> list[str]:
    """Return a short name for each answer; as typed where two would be alike."""
    short = [_label(a) for a in answers]
    return [s if short.count(s) == 1 else a for s, a in zip(short, answers, strict=True)]


def _label(answer: str) -> str:
    path = Path(answer)
    if path.suffix == ".json":
        named = path.stem not in ("model", "study")
        return path.stem if named else path.resolve().parent.name
    return path.resolve().name if path.exists() else model_label(answer)

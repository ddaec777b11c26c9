"""``inerter discover``: bands, a structure per band, the boundary, the Dean check, a report."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import typer

from discover.cli import options
from discover.cli.invocation import Invocation, to_copy
from discover.cli.reading import read_over
from discover.cli.results import after_reading, deliver, result_folder, shown_path, working
from discover.cli.shipped import HIDDEN, HIDDEN_MODEL, shipped_campaign
from models.checks import number, one_of

if TYPE_CHECKING:
    from discover.records import Finding


def discover(
    context: typer.Context,
    campaign: options.ShippedCampaign = None,
    terms: options.Terms = None,
    orders: options.Orders = None,
    exponents: options.Exponents = None,
    bands: options.Bands = None,
    coordinate: options.Coordinate = None,
    convention: options.Convention = "paper",
    criterion: options.Criterion = 100.0,
    figures: options.Figures = None,
    out: options.Out = None,
    as_json: options.AsJson = False,
    seed: options.Seed = options.DEFAULT_SEED,
    jobs: options.Jobs = 1,
    cluster: options.Cluster = None,
) -> int:
    """Find which structure the records support, and where.

    Bands, boundary, Dean check, how surely, and the test that would tell more. Writes study.json,
    model.json, and a page.
    """
    one_of("convention", convention, ("paper", "standard"), where="--convention")
    if coordinate is not None:
        one_of("coordinate", coordinate, ("dean", "speed", "frequency"), where="--coordinate")
    only = options.identifiers(terms, where="--terms")
    order_grid = options.grid(orders, where="--orders", at_least=-1.0, at_most=2.0)
    exponent_grid = options.grid(exponents, where="--exponents", at_least=0.1, at_most=5.0)
    number("criterion", criterion, above=0.0, at_most=1e6, where="--criterion")
    formats = options.figure_formats(figures)
    source = shipped_campaign() if campaign is None else campaign
    folder = result_folder("discover", source, out)

    # Loaded here: --help and complaints about options need no numerics.
    from discover.document import json_text
    from discover.record_checks import one_direction
    from discover.report.study import study_files
    from discover.study import StudyOptions, run_study
    from discover.study.verdict import verdict_lines
    from discover.words import error_lines, warning_lines

    measured = read_over(source, jobs, cluster)
    with working(f"Studying {len(measured.records)} records"), after_reading(measured):
        study = run_study(
            measured,
            StudyOptions(
                terms=only,
                orders=order_grid,
                exponents=exponent_grid,
                bands=bands,
                coordinate=coordinate,
                convention=convention,
                criterion=criterion,
                seed=seed,
            ),
        )
    with working("Drawing"):
        document = study.to_dict()
        invocation: Invocation = context.obj
        files = study_files(
            document, study.figure_data, command=invocation.repeat(seed=seed), formats=formats
        )
    files["model.json"] = json_text(study.model_dict())
    of_data = about_data(document["findings"], (*measured.findings, *one_direction(measured)))
    deliver(
        document,
        name="study.json",
        folder=folder,
        files=files,
        summary=(
            *error_lines(document),
            *verdict_lines(document),
            *warning_lines({"findings": of_data}),
            next_command(campaign, folder),
        ),
        as_json=as_json,
    )
    return 0


def about_data(
    findings: Sequence[Mapping[str, Any]], read: Sequence[Finding]
) -> list[Mapping[str, Any]]:
    """Return the findings of a study that its verdict does not tell in other words.

    Parameters
    ----------
    findings : sequence of mapping
        Of the study, as in its document.
    read : sequence of Finding
        Of reading the campaign, and of its motion.
    """
    known = [finding.to_dict() for finding in read]
    return [f for f in findings if f.get("record") is not None or f in known]


def next_command(campaign: Path | None, folder: Path) -> str:
    """Return the line to copy: what the model misses, of the shipped campaign another one's effect.

    Parameters
    ----------
    campaign : Path or None
        That was studied; None for the shipped one.
    folder : Path
        Of its results.
    """
    if campaign is None:
        hidden = shown_path(shipped_campaign(HIDDEN))
        return f"Next: {to_copy(['gap', hidden, '--model', HIDDEN_MODEL])}"
    model = str(folder / "model.json")
    return f"Next: {to_copy(['gap', str(campaign), '--model', model])}"

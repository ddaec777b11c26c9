"""``inerter gap``: where a model and the records disagree, what is missing, the model mended."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from discover.cli import options
from discover.cli.invocation import Invocation
from discover.cli.reading import read_over
from discover.cli.results import after_reading, deliver, result_folder, working
from models.checks import one_of


def gap(
    context: typer.Context,
    campaign: Annotated[
        Path,
        typer.Argument(metavar="CAMPAIGN", help="Folder with campaign.toml and its records."),
    ],
    model: Annotated[
        str,
        typer.Option(
            "--model",
            metavar="M",
            help="A model.json, ioim-laminar, ioim-turbulent, foim or sfoim (from the device;"
            " b0 and order are fitted first where the paper has none), or fit:TERM,TERM,…"
            " (coefficients fitted first).",
        ),
    ],
    fixed: Annotated[
        bool, typer.Option("--fixed", help="Hold the model's coefficients throughout.")
    ] = False,
    effects: Annotated[
        str | None,
        typer.Option(
            "--effects",
            metavar="ID,FILE.py,…",
            help="Name only these effects, and those of --effect-file.",
        ),
    ] = None,
    effect_files: options.EffectFiles = None,
    on: Annotated[
        str,
        typer.Option(
            "--on",
            metavar="force|motion",
            help="motion: besides, move the [system] with the model, as it is and mended.",
        ),
    ] = "force",
    figures: options.Figures = None,
    out: options.Out = None,
    as_json: options.AsJson = False,
    seed: options.Seed = options.DEFAULT_SEED,
    jobs: options.Jobs = 1,
    cluster: options.Cluster = None,
) -> int:
    """Find what a model lacks, name it, and add it.

    Says where model and records disagree, and how far before and after. Writes gap.json, the
    mended model.json, and a page.
    """
    one_of("quantity", on, ("force", "motion"), where="--on")
    only = options.identifiers(effects, where="--effects")
    formats = options.figure_formats(figures)
    folder = result_folder("gap", campaign, out, model=model)

    # Loaded here: --help and complaints about options need no numerics.
    from discover.cli.gap_answer import FIT, gap_answer
    from discover.cli.own_effects import asked_effects, listed_effects, own_notes
    from discover.document import json_text
    from discover.gap import term_ids
    from discover.motion_gap import motion_before_and_after, require_system
    from discover.report.gap import gap_files, gap_lines
    from discover.words import warning_lines
    from models.terms import TERMS, own_terms

    with working("Reading effects"):
        named, own = asked_effects(only, effect_files)
    context.with_resource(own_terms(*own))
    for name in named or ():
        one_of("effect", name, sorted(TERMS), where="--effects")
    if model.startswith(FIT):
        term_ids(model)
    measured = read_over(campaign, jobs, cluster)
    if on == "motion":
        require_system(measured)
    with working(f"Comparing {len(measured.records)} records") as tell, after_reading(measured):
        document, found = gap_answer(
            measured, model, fixed=fixed, effects=named, seed=seed, tell=tell
        )
    if named is not None:
        document["effects"] = list(named)
    if own:
        document["own_effects"] = listed_effects(own)
        document["findings"] += own_notes(document["own_effects"])
    if on == "motion":
        with working("Moving the carried system"):
            document["motion"] = motion_before_and_after(measured, found.given, found.model)
    with working("Drawing"):
        invocation: Invocation = context.obj
        files = gap_files(
            document, found.figure_data, command=invocation.repeat(seed=seed), formats=formats
        )
    files["model.json"] = json_text(found.model_dict())
    deliver(
        document,
        name="gap.json",
        folder=folder,
        files=files,
        summary=[*gap_lines(document), *warning_lines(document)],
        as_json=as_json,
    )
    return 0

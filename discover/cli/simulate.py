"""``inerter simulate``: models' forces for the measured motion, ranked on held-out records."""

from __future__ import annotations

from typing import Annotated

import typer

from discover.cli import options
from discover.cli.invocation import Invocation
from discover.cli.results import deliver, result_folder, working
from models.checks import InputError, shown


def simulate(
    context: typer.Context,
    arguments: Annotated[
        list[str],
        typer.Argument(
            metavar="MODEL... CAMPAIGN",
            help="Models (model.json, fit:TERM,TERM,… with coefficients fitted first, or, from"
            " the device, ioim-laminar, ioim-turbulent, foim, sfoim), then the campaign's folder.",
        ),
    ],
    effect_files: options.EffectFiles = None,
    figures: options.Figures = None,
    out: options.Out = None,
    as_json: options.AsJson = False,
    seed: options.Seed = options.DEFAULT_SEED,
    jobs: options.Jobs = 1,
) -> int:
    """Predict each model's force for the measured motion.

    It stands beside the measured force. Several models are ranked on held-out records. Writes
    simulation.json, a page, and one CSV a record.
    """
    *names, campaign = arguments
    if not names:
        raise InputError(
            "arguments", expected="models and then a campaign", found=shown(campaign),
            where="simulate",
        )  # fmt: skip
    options.each_once("models", names, where="simulate")
    formats = options.figure_formats(figures)
    folder = result_folder("simulate", campaign, out)

    # Loaded here: --help and complaints about options need no numerics.
    from discover.cli.gap_answer import FIT, fitted_first, predicting_model
    from discover.cli.own_effects import own_effects
    from discover.gap import term_ids
    from discover.readers import read_campaign
    from discover.report.simulation import simulation_files, simulation_lines
    from discover.simulate import simulate_forces
    from discover.words import listed
    from models.terms import own_terms

    with working("Reading effects"):
        own = own_effects(effect_files)
    context.with_resource(own_terms(*own))
    for name in names:
        if name.startswith(FIT):
            term_ids(name, where=name)
    with working(f"Reading {campaign}"):
        measured = read_campaign(campaign)
    with working(f"Fitting to {campaign}"):
        models = {
            name: predicting_model(measured, name, seed=seed, jobs=jobs) for name in names
        }
    with working(f"Predicting {len(measured.records)} records"):
        answer = simulate_forces(measured, models, seed=seed, jobs=jobs)
        document = answer.to_dict()
    fitted = [n for n in names if fitted_first(n, measured.device)]
    if fitted:
        text = f"Fitted first, to the records that are not held out: {listed(fitted)}."
        document["findings"].append({"level": "note", "text": text})
    with working("Drawing"):
        invocation: Invocation = context.obj
        files = simulation_files(
            document, answer.shown(), command=invocation.repeat(seed=seed), formats=formats
        )
    deliver(
        document,
        name="simulation.json",
        folder=folder,
        files={**files, **answer.tables()},
        summary=simulation_lines(document),
        as_json=as_json,
    )
    return 0

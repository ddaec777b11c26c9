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
            help="Models (model.json, ioim-laminar, ioim-turbulent, foim, sfoim), then the"
            " campaign's folder.",
        ),
    ],
    effect_files: options.EffectFiles = None,
    figures: options.Figures = None,
    out: options.Out = None,
    as_json: options.AsJson = False,
    seed: options.Seed = options.DEFAULT_SEED,
    jobs: options.Jobs = 1,
) -> int:
    """Predict the force of each model for the measured motion, beside the measured force.

    Several models are ranked on held-out records. Writes simulation.json, a page, and one
    CSV a record.
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
    from discover.cli.own_effects import own_effects
    from discover.named_model import named_model
    from discover.readers import read_campaign
    from discover.report.simulation import simulation_files, simulation_lines
    from discover.simulate import simulate_forces
    from models.terms import own_terms

    with working("Reading effects"):
        own = own_effects(effect_files)
    context.with_resource(own_terms(*own))
    with working(f"Reading {campaign}"):
        measured = read_campaign(campaign)
        models = {name: named_model(name, measured.device, where=name) for name in names}
    with working(f"Predicting {len(measured.records)} records"):
        answer = simulate_forces(measured, models, seed=seed, jobs=jobs)
        document = answer.to_dict()
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

"""``inerter reproduce``: the paper's tables, figures and claims beside what its formulas give."""

from __future__ import annotations

import typer

from discover.cli import options
from discover.cli.invocation import Invocation
from discover.cli.results import deliver, result_folder, working

_NOISE = 0.01


def reproduce(
    context: typer.Context,
    out: options.Out = None,
    as_json: options.AsJson = False,
    seed: options.Seed = options.DEFAULT_SEED,
) -> int:
    """Recompute the paper, with a verdict on each claim.

    Tables, figures and identification, printed beside computed.
    """
    folder = result_folder("reproduce", "paper", out)

    # Loaded here: --help and complaints about options need no numerics.
    from discover.cli.stand_ins import rig_stand_ins
    from discover.report.reproduction import (
        reproduction_figures,
        reproduction_lines,
        reproduction_report,
    )
    from discover.reproduction import reproduce as recompute

    with working("Recomputing the paper"):
        result = recompute(rig_stand_ins(noise=_NOISE, seed=seed), seed=seed)
    with working("Drawing"):
        figures = reproduction_figures(result)
        invocation: Invocation = context.obj
        page = reproduction_report(result, figures, command=invocation.repeat(seed=seed))
    files = {"report.html": page}
    files |= {f"figures/{name}.svg": svg for name, svg in figures.items()}
    deliver(
        result.to_dict(),
        name="reproduction.json",
        folder=folder,
        files=files,
        summary=reproduction_lines(result),
        as_json=as_json,
    )
    return 0

"""``inerter check``: the data judged before anything is concluded from it."""

from __future__ import annotations

import shlex
from dataclasses import replace

import typer

from discover.cli import options
from discover.cli.invocation import Invocation
from discover.cli.reading import read_over
from discover.cli.results import after_reading, deliver, result_folder, working
from discover.cli.shipped import shipped_campaign

FAILED = 1


def check(
    context: typer.Context,
    campaign: options.ShippedCampaign = None,
    out: options.Out = None,
    as_json: options.AsJson = False,
    seed: options.Seed = options.DEFAULT_SEED,
    jobs: options.Jobs = 1,
    cluster: options.Cluster = None,
) -> int:
    """Judge the records, and say what their plan can't tell apart.

    Exits 1 where a finding is an error: the campaign should not be studied as it is.
    """
    source = shipped_campaign() if campaign is None else campaign
    folder = result_folder("check", source, out)

    from discover.data_check import check_campaign
    from discover.readers.left_out import left_out_findings
    from discover.report.check import check_figures, check_lines, check_report

    read = read_over(source, jobs, cluster)
    with working(f"Checking {source}"):
        measured = replace(read, findings=(*read.findings, *left_out_findings(source)))
        with after_reading(measured):
            answer = check_campaign(measured, seed=seed)
    with working("Drawing"):
        document = answer.to_dict()
        figures = check_figures(document, answer.figure_data)
        typed = shlex.quote(str(source))
        invocation: Invocation = context.obj
        page = check_report(
            document,
            answer.figure_data,
            figures,
            campaign=typed,
            command=invocation.repeat(seed=seed),
        )
    deliver(
        document,
        name="check.json",
        folder=folder,
        files={"report.html": page, **{f"figures/{n}.svg": svg for n, svg in figures.items()}},
        summary=check_lines(document, campaign=typed),
        as_json=as_json,
    )
    return 0 if answer.passed else FAILED

"""``inerter check``: the data judged before anything is concluded from it."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from discover.cli import options
from discover.cli.results import deliver, result_folder, working

FAILED = 1


def check(
    campaign: Annotated[
        Path, typer.Argument(metavar="CAMPAIGN", help="Folder with campaign.toml and its records.")
    ],
    out: options.Out = None,
    as_json: options.AsJson = False,
    seed: options.Seed = options.DEFAULT_SEED,
    jobs: options.Jobs = 1,
) -> int:
    """Judge the records, and say what their plan can't tell apart.

    Exits 1 where a finding is an error: the campaign should not be studied as it is.
    """
    folder = result_folder("check", campaign, out)

    from discover.data_check import check_campaign
    from discover.readers import read_campaign
    from discover.report.check import check_lines
    from discover.study import StudyOptions

    with working(f"Checking {campaign}"):
        answer = check_campaign(read_campaign(campaign), StudyOptions(seed=seed, jobs=jobs))
        document = answer.to_dict()
    deliver(
        document,
        name="check.json",
        folder=folder,
        files={},
        summary=check_lines(document),
        as_json=as_json,
    )
    return 0 if answer.passed else FAILED

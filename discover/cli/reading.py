"""Reading a campaign for a verb, in this process, in several, or on a cluster."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING

from discover.cli.results import working
from models.checks import LONGEST_LINE, printable

if TYPE_CHECKING:
    from discover.records import Campaign


def read_over(source: str | Path, jobs: int, cluster: str | None) -> Campaign:
    """Return a campaign whose records were read, and compressed, by an executor.

    Raises
    ------
    InputError
        As `discover.read_campaign` and `discover.executor.executor` do.
    """
    from discover.executor import executor
    from discover.readers import read_campaign

    with working(f"Reading {source}") as tell, executor(jobs, cluster, tell=say) as over:
        return read_campaign(source, over=over, tell=tell)


def say(text: str) -> None:
    """Print a line on stderr, above a bar where one is shown: it takes stderr over."""
    print("inerter: " + printable(text, longest=LONGEST_LINE), file=sys.stderr)

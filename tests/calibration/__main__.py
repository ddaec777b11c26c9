"""``make calibration``: random devices, the virtual rig and next tests, their tables kept."""

from __future__ import annotations

import argparse
import datetime
import subprocess
from collections.abc import Sequence
from pathlib import Path

from tests.calibration import proposals, rates, rig, study

KEPT = Path(__file__).parents[1] / "benchmarks" / "RESULTS-calibration.md"
_NEVER_TUNED = 100_000
"""Added to the first seed for the rig and the proposals, so that no two studies share a stream."""


def commit() -> str:
    """Return the commit, and whether the tree holds more."""

    def git(*words: str) -> str:
        return subprocess.run(
            ["git", *words], capture_output=True, text=True, check=False
        ).stdout.strip()

    dirty = git("status", "--porcelain", "--untracked-files=no")
    return git("rev-parse", "--short", "HEAD") + (" + uncommitted" if dirty else "")


def document(
    found: Sequence[study.Outcome],
    campaigns: Sequence[rig.Outcome],
    standings: Sequence[float],
    stamp: str,
) -> str:
    """Return the tables with what they are about, in Markdown."""
    wrong = "\n".join(
        f"- {o.seed}: {o.physics} physics, {o.plan} plan, {o.records} records; {o.structure} at"
        f" {o.probability:.2f}, best {' or '.join(o.truths)}"
        for o in campaigns
        if not o.right and o.probability >= rates.SURE
    )
    return (
        f"# Calibration of structures and boundaries\n\n{stamp}\n\n"
        f"## Exact models\n\n{len(found)} random devices and plans from seed {found[0].seed}, a"
        " fifth of them with a boundary; noise of 1 to 5 %, first-order, power-law, with a"
        " resonance or band-limited. Separable: the nearest rival is ten nats away under the true"
        f" noise covariance.\n\n{rates.table(found)}\n\nNot as they should be:\n\n"
        f"{rates.misses(found)}\n\n"
        f"## Virtual rig\n\n{len({o.seed for o in campaigns})} campaigns from seed"
        f" {campaigns[0].seed}, {len(campaigns)} stated bands. Truth is the structure that, fitted"
        " by least squares of the harness, predicts noise-free new tests in the band best; those"
        f" within {rates_text()} of it predict alike.\n\n"
        f"{rig.table(campaigns)}\n\nStated at {rates.SURE:g} or more and wrong:\n\n"
        f"{wrong or 'none'}\n\n## Next test\n\n{proposals.table(standings)}\n"
    )


def rates_text() -> str:
    """Return what counts as predicting alike, in words."""
    return f"{100.0 * rig.ALIKE:g} % of its error or {100.0 * rig.UNSEEN:g} % of the force"


def main() -> None:
    """Run all three studies and keep their tables."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--cases", type=int, default=200)
    parser.add_argument("--campaigns", type=int, default=40)
    parser.add_argument("--undecided", type=int, default=25)
    parser.add_argument("--first", type=int, default=52000)
    parser.add_argument("--jobs", type=int, default=2)
    given = parser.parse_args()
    stamp = f"{datetime.date.today()}, commit {commit()}."
    found = study.outcomes(range(given.first, given.first + given.cases), given.jobs)
    start = given.first + _NEVER_TUNED
    campaigns = rig.outcomes(range(start, start + given.campaigns), given.jobs)
    standings = proposals.standings(
        range(start, start + 40 * given.undecided), given.undecided, given.jobs
    )
    text = document(found, campaigns, standings, stamp)
    KEPT.write_text(text)
    print(text)


if __name__ == "__main__":
    main()

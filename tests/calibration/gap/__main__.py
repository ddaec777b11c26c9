"""``python -m tests.calibration.gap``: the seeded blind study of naming, its table kept."""

from __future__ import annotations

import argparse
import datetime
import subprocess
from pathlib import Path

from tests.calibration.gap.study import cases, outcomes, table

KEPT = Path(__file__).parents[2] / "benchmarks" / "RESULTS-gap.md"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--devices", type=int, default=10)
    parser.add_argument("--first", type=int, default=100)
    parser.add_argument("--sizes", default="0.2,0.1,0.05")
    parser.add_argument("--clean", type=int, default=200)
    parser.add_argument("--jobs", type=int, default=2)
    given = parser.parse_args()
    sizes = [float(s) for s in given.sizes.split(",")]
    seeds = range(given.first, given.first + given.devices)
    wanted = cases(seeds, sizes)
    wanted += [({}, given.first + 1000 + i) for i in range(given.clean)]
    found = outcomes(wanted, given.jobs)
    commit = subprocess.run(
        ["git", "rev-parse", "--short", "HEAD"], capture_output=True, text=True, check=False
    ).stdout.strip()
    text = (
        "# Naming a missing effect: the blind study\n\n"
        f"{len(found)} campaigns of {given.devices} devices from seed {given.first} on the virtual"
        f" rig (simple physics, 1 % coloured noise), {datetime.date.today()}, commit {commit}.\n\n"
        f"{table(found)}\n"
    )
    KEPT.write_text(text)
    print(text)


if __name__ == "__main__":
    main()

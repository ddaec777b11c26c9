"""``make calibration``: the study on random devices, its table kept beside the benchmarks."""

from __future__ import annotations

import argparse
import datetime
import subprocess
from pathlib import Path

from tests.calibration.study import outcomes, table

KEPT = Path(__file__).parents[1] / "benchmarks" / "RESULTS-calibration.md"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--cases", type=int, default=200)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--jobs", type=int, default=2)
    given = parser.parse_args()
    found = outcomes(range(given.first, given.first + given.cases), given.jobs)
    commit = subprocess.run(
        ["git", "rev-parse", "--short", "HEAD"], capture_output=True, text=True, check=False
    ).stdout.strip()
    wrong = ", ".join(f"{o.seed} ({o.structure})" for o in found if o.separable and not o.first)
    text = (
        "# Calibration of structures and boundaries\n\n"
        f"{given.cases} random devices and plans from seed {given.first} (a fifth of them with a"
        f" boundary; those with fewer than three tests on one side of it are left out: {len(found)}"
        f" remain), {datetime.date.today()}, commit {commit}.\n\n"
        f"{table(found)}\n\nSeparable and not named first: {wrong or 'none'}.\n"
    )
    KEPT.write_text(text)
    print(text)


if __name__ == "__main__":
    main()

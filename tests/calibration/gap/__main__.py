"""``python -m tests.calibration.gap``: the seeded blind study of naming, its table kept."""

from __future__ import annotations

import argparse
import datetime
from pathlib import Path

from tests.calibration.commit import current_commit
from tests.calibration.gap.case import KEPT, SETS, Case, clean_cases, pair_cases, single_cases
from tests.calibration.gap.study import outcomes
from tests.calibration.gap.table import table

ROOT = Path(__file__).parents[3]
TABLE = ROOT / "tests" / "benchmarks" / "RESULTS-gap.md"
ABOUT = {
    "first": "Forms of the rig's catalogue, random devices, 12 sine tests on a grid, 1 % noise"
    " that is half white and half first-order coloured.",
    "second": "Other forms, devices, plans (10 to 16 records off any grid) and noise (1/f, mains"
    " hum, resonant; 1 %). Single answers are not listed: nothing is to be tuned on them.",
    "third": "Further forms, devices, plans (10 to 15 records) and noise (1 %), written after the"
    " engine and looked at only in total.",
}


def main() -> None:
    """Run what is asked for; print the table and write it where it is to be kept."""
    parser = argparse.ArgumentParser(prog="python -m tests.calibration.gap", description=__doc__)
    parser.add_argument(
        "--set", choices=(*SETS, "both"), default="both", dest="kind",
        help="both: the first and second, whose table is kept",
    )
    parser.add_argument("--devices", type=int, default=10)
    parser.add_argument("--first", type=int, default=100, help="seed of the first device")
    parser.add_argument("--sizes", default="0.2,0.1,0.05")
    parser.add_argument("--clean", type=int, default=200)
    parser.add_argument("--pairs", type=int, default=100)
    parser.add_argument("--every", type=int, default=1, help="take every Nth case")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--keep", type=Path, help="outcomes as JSON lines; resumed from there")
    parser.add_argument("--out", type=Path, help=f"file for the table; of both sets {TABLE.name}")
    given = parser.parse_args()
    sizes = [float(s) for s in given.sizes.split(",")]
    commit = current_commit()
    keep = given.keep or ROOT / "build" / f"blind-{commit}.jsonl"
    sections = [
        "# Naming a missing effect: the blind study\n\n"
        f"{datetime.date.today()}, commit {commit.rstrip('+')}"
        f"{' with uncommitted changes' if commit.endswith('+') else ''};"
        f" {given.devices} devices from seed {given.first} on the virtual rig (simple physics)."
        " Made by `make blind`."
    ]
    for kind in KEPT if given.kind == "both" else (given.kind,):
        asked = wanted(kind, given, sizes)[:: given.every]
        found = outcomes(asked, jobs=given.jobs, keep=keep, commit=commit)
        sections.append(
            f"## The {kind} set\n\n{ABOUT[kind]} {len(found)} campaigns.\n\n"
            f"{table(found, list_wrong=kind == 'first')}"
        )
    text = "\n\n".join(sections) + "\n"
    out = given.out or (TABLE if given.kind == "both" else None)
    if out is not None:
        out.write_text(text)
    print(text)


def wanted(kind: str, given: argparse.Namespace, sizes: list[float]) -> list[Case]:
    """Return the cases of one set."""
    first = given.first
    return [
        *single_cases(kind, range(first, first + given.devices), sizes),
        *clean_cases(kind, range(first + 1000, first + 1000 + given.clean)),
        *pair_cases(kind, range(first + 3000, first + 3000 + given.pairs)),
    ]


if __name__ == "__main__":
    main()

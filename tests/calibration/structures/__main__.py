"""``python -m tests.calibration.structures``: the calibration study of structures, its table kept.

Only totals are printed: whoever writes the engine must not tune it on single answers.
"""

from __future__ import annotations

import argparse
import datetime
import sys
from pathlib import Path

from tests.calibration.commit import current_commit
from tests.calibration.structures.run import LIMIT, outcomes
from tests.calibration.structures.sets import SEEDS, SETS, cases
from tests.calibration.structures.table import document

ROOT = Path(__file__).parents[3]
TABLE = ROOT / "tests" / "benchmarks" / "RESULTS-calibration.md"


def main() -> None:
    """Run what is asked for; print the table and write it where it is to be kept."""
    parser = argparse.ArgumentParser(
        prog="python -m tests.calibration.structures", description=__doc__
    )
    parser.add_argument("--set", choices=(*SETS, "all"), default="all", dest="name")
    parser.add_argument("--first", type=int, default=0, help="first seed")
    parser.add_argument("--seeds", type=int, help="their number; else each set's own")
    parser.add_argument("--every", type=int, default=1, help="take every Nth case of each set")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--limit", type=int, default=LIMIT, help="s of processor time; 0: any")
    parser.add_argument("--keep", type=Path, help="outcomes as JSON lines; resumed from there")
    parser.add_argument("--out", type=Path, help=f"file for the table; of all sets {TABLE.name}")
    parser.add_argument("--answers", action="store_true", help="print single answers too")
    given = parser.parse_args()
    commit = current_commit()
    keep = given.keep or ROOT / "build" / f"calibration-{commit}.jsonl"
    wanted = []
    for name in SETS if given.name == "all" else (given.name,):
        seeds = range(given.first, given.first + (given.seeds or SEEDS[name]))
        wanted += cases(name, seeds)[:: given.every]
    found = []
    for one in outcomes(wanted, jobs=given.jobs, keep=keep, commit=commit, limit=given.limit):
        found.append(one)
        if given.answers:
            mark = "right" if one.core_right else "wrong"
            print(f"{one.key}: {mark}: {one.failure or one.answer}", flush=True)
        if sys.stderr.isatty():
            print(f"\r{len(found)} of {len(wanted)}", end="", file=sys.stderr, flush=True)
    text = document(found, f"{datetime.date.today()}, seeds from {given.first}")
    whole = given.name == "all" and given.every == 1 and given.seeds is None
    out = given.out or (TABLE if whole else None)
    if out is not None:
        out.write_text(text)
    print(text)


if __name__ == "__main__":
    main()

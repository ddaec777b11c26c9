"""``python -m tests.calibration.structures``: the calibration study of structures.

Only totals are printed: whoever writes the engine must not tune it on single answers.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from tests.calibration.structures.run import LIMIT, current_commit, outcomes
from tests.calibration.structures.sets import SETS, cases
from tests.calibration.structures.table import table


def main() -> None:
    """Run what is asked for and print the table."""
    parser = argparse.ArgumentParser(
        prog="python -m tests.calibration.structures", description=__doc__
    )
    parser.add_argument("--set", choices=(*SETS, "all"), default="structures", dest="name")
    parser.add_argument("--seeds", default="0:5", help="A:B, from A to B - 1")
    parser.add_argument("--every", type=int, default=1, help="take every Nth case")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--limit", type=int, default=LIMIT, help="s of processor time; 0: any")
    parser.add_argument("--keep", type=Path, help="outcomes as JSON lines; resumed from there")
    parser.add_argument("--out", type=Path, help="file for the table")
    shown = parser.add_mutually_exclusive_group()
    shown.add_argument("--totals-only", action="store_true", help="the default")
    shown.add_argument("--answers", action="store_true", help="print single answers too")
    given = parser.parse_args()
    first, _, last = given.seeds.partition(":")
    seeds = range(int(first), int(last) if last else int(first) + 1)
    names = SETS if given.name == "all" else (given.name,)
    wanted = [case for name in names for case in cases(name, seeds)][:: given.every]
    found = []
    coming = outcomes(
        wanted, jobs=given.jobs, keep=given.keep, commit=current_commit(), limit=given.limit
    )
    for one in coming:
        found.append(one)
        if given.answers:
            mark = "right" if one.core_right else "wrong"
            print(f"{one.key}: {mark}: {one.failure or one.answer}", flush=True)
        if sys.stderr.isatty():
            print(f"\r{len(found)} of {len(wanted)}", end="", file=sys.stderr, flush=True)
    text = table(found) + "\n"
    if given.out is not None:
        given.out.write_text(text)
    print(text)


if __name__ == "__main__":
    main()

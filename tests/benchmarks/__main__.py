"""``python -m tests.benchmarks``: every benchmark in one run, as a table that is kept.

Each ``bench_*.py`` beside this file has ``rows()``: (what, value, unit, beside what). The table
goes to ``results.md`` with the machine, the date and the commit that it was measured on.
"""

from __future__ import annotations

import datetime
import importlib
import os
import platform
import subprocess
import sys
from importlib.metadata import version
from pathlib import Path

HERE = Path(__file__).parent
PACKAGES = ("numpy", "scipy", "numba", "scikit-learn", "pysindy", "pycaputo")


def machine() -> str:
    """Return what the table was measured on, in one line."""
    processor = platform.processor() or platform.machine()
    information = Path("/proc/cpuinfo")
    if information.exists():
        names = [r for r in information.read_text().splitlines() if r.startswith("model name")]
        processor = names[0].partition(":")[2].strip() if names else processor
    versions = ", ".join(f"{name} {version(name)}" for name in PACKAGES)
    return (
        f"{processor}, {os.cpu_count()} cores; {platform.system()} {platform.release()};"
        f" Python {platform.python_version()}, {versions}"
    )


def commit() -> str:
    """Return the commit that is measured, marked where the files differ from it."""
    done = subprocess.run(
        ["git", "describe", "--always", "--dirty"],
        cwd=HERE,
        capture_output=True,
        text=True,
        check=False,
    )
    return done.stdout.strip() or "no commit"


def main(names: list[str]) -> None:
    """Run all benchmarks, or those named, print the table and keep it."""
    chosen = names or sorted(p.stem for p in HERE.glob("bench_*.py"))
    today = datetime.datetime.now(tz=datetime.UTC).date()
    lines = [
        "# Benchmarks",
        "",
        f"Measured on {today} at {commit()}, by `make bench`.",
        f"{machine()}.",
    ]
    for name in chosen:
        module = importlib.import_module(f"tests.benchmarks.{name}")
        title = (module.__doc__ or name).strip().splitlines()[0]
        lines += ["", f"## {title}", "", "| what | value | beside |", "|---|---:|---|"]
        for what, value, unit, beside in module.rows():
            lines.append(f"| {what.replace('|', '¦')} | {value:.3g} {unit} | {beside} |")
            print(f"{what:<84} {value:>10.3g} {unit:<6} {beside}")
    if not names:
        (HERE / "results.md").write_text("\n".join(lines) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main(sys.argv[1:])

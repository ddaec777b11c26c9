"""The table of a benchmark, with what it was run on."""

from __future__ import annotations

import datetime
import os
import platform
import subprocess
from collections.abc import Iterable
from importlib import metadata
from pathlib import Path

Row = tuple[str, float, str, str]
"""What was measured, value, unit, beside what."""

_PACKAGES = ("numpy", "scipy", "numba", "pysindy", "pycaputo", "differint")


def machine() -> list[str]:
    """Say what the figures were measured on: processor, load, versions, commit, date."""
    name = platform.processor() or platform.machine()
    info = Path("/proc/cpuinfo")
    if info.exists():
        models = [row for row in info.read_text().splitlines() if row.startswith("model name")]
        name = models[0].split(":", 1)[1].strip() if models else name
    load = f", load {os.getloadavg()[0]:.1f} before the run" if hasattr(os, "getloadavg") else ""
    versions = []
    for package in _PACKAGES:
        try:
            versions.append(f"{package} {metadata.version(package)}")
        except metadata.PackageNotFoundError:
            versions.append(f"{package} not installed")
    commit = subprocess.run(
        ["git", "rev-parse", "--short", "HEAD"], capture_output=True, text=True, check=False
    ).stdout.strip()
    return [
        f"- {name}, {os.cpu_count()} cores{load}, {platform.system()}",
        f"- Python {platform.python_version()}, " + ", ".join(versions),
        f"- {datetime.date.today().isoformat()}, commit {commit or 'unknown'}",
    ]


def markdown(title: str, rows: Iterable[Row], about: Iterable[str]) -> str:
    """Return the table as Markdown."""
    head = ["| measured | value | unit | beside |", "|---|---|---|---|"]
    lines = [f"# {title}", "", *about, "", *head]
    lines += [f"| {what} | {value:.3g} | {unit} | {beside} |" for what, value, unit, beside in rows]
    return "\n".join(lines) + "\n"

"""Run the benchmarks, print their tables, keep them beside this file and in the docs.

``python -m tests.benchmarks`` runs all; names (``fractional``) run those.
"""

from __future__ import annotations

import importlib
import sys
from pathlib import Path

from tests.benchmarks.page import PAGE, page
from tests.benchmarks.results import machine, markdown

_HERE = Path(__file__).parent


def main(names: list[str]) -> int:
    """Run the benchmarks of these names, or all."""
    known = sorted(path.stem.removeprefix("bench_") for path in _HERE.glob("bench_*.py"))
    unknown = sorted(set(names) - set(known))
    if unknown:
        print(f"benchmark must be one of {', '.join(known)}, got {unknown[0]!r}", file=sys.stderr)
        return 2
    for name in names or known:
        module = importlib.import_module(f"tests.benchmarks.bench_{name}")
        about = machine()
        text = markdown((module.__doc__ or name).splitlines()[0], module.rows(), about)
        print(text)
        (_HERE / f"RESULTS-{name}.md").write_text(text, encoding="utf-8")
    PAGE.write_text(page(), encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))

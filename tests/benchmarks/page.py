"""The page of the documentation with published numbers, of the tables that ``make bench`` keeps."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

_HERE = Path(__file__).parent
PAGE = _HERE.parents[1] / "docs" / "benchmarks.md"
_INTRODUCTION = """\
# Benchmarks

`make bench` runs these and many more, and writes this page and the whole tables in
`tests/benchmarks`. A figure beside another was measured in the same run. A bar is what is aimed
at; where it is not met, the figure says so. Every part was run on the machine, with the versions
and at the load that its table names: other work ran on it too, so ratios count and not seconds.

Sine tests were measured up to 1e9 samples; they are read in pieces. Of other kinds records of more
than a million samples were not measured: they are held whole, and their memory grows with them.

| part | measured | value | unit | beside |
|---|---|---|---|---|
"""
_SHOWN = {
    "fractional": (
        r"order 0\.5, N = 100,000: (time, scheme auto|ratio|one padded)",
        r"order 0\.5, N = 100,000: (pycaputo|this package)",
        r"sine of 4 cycles, starts with velocity, worst of 39 orders.*relative rms",
    ),
    "regression": (
        r"STLSQ, 400,000 x 20",
        r"best subset, 40 neighbouring orders",
        r"exact terms, IOIM-laminar, 2% noise",
    ),
    "simulation": (r"friction and one fractional term, 1e5 steps", r"x'' \+ 0\.4"),
    "speed": (r".*",),
    "long": (r".*",),
    "scale": (r"sine test of", r"[\d,]+ records of"),
    "study": (r"40 records of 20,000 samples", r"search at"),
    "search": (r"16 records of 10,000 samples",),
}


def shown_rows() -> Iterator[tuple[str, str]]:
    """Yield part and row of the kept tables, those that the page shows.

    Raises
    ------
    LookupError
        Where a pattern fits no row any more.
    """
    for part, patterns in _SHOWN.items():
        kept = (_HERE / f"RESULTS-{part}.md").read_text(encoding="utf-8").splitlines()
        rows = [line.removeprefix("| ") for line in kept if line.startswith("| ")][1:]
        for pattern in patterns:
            found = [row for row in rows if re.match(pattern, row)]
            if not found:
                raise LookupError(f"RESULTS-{part}.md: no row fits {pattern!r}")
            yield from ((part, row) for row in found)


def page() -> str:
    """Return the page."""
    return _INTRODUCTION + "".join(f"| {part} | {row}\n" for part, row in shown_rows())

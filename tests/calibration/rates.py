"""How often what was stated is right, with intervals, beside the bars."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np
from scipy.stats import beta

from tests.calibration.study import Outcome

BARS = {
    "structure first, where separable": 0.90,
    "structure first or equivalent, all": 0.97,
    "no boundary where there is none": 0.95,
    "bracket holds the boundary": 0.95,
    "interval holds the boundary": 0.93,
    "boundary at Dean 100 consistent": 0.90,
    "boundary fixed in frequency contradicted": 0.90,
    "one amplitude undetermined": 1.0,
    "order interval holds the order": 0.90,
}
BINS = (0.0, 0.5, 0.8, 0.95, 1.0)
SURE = 0.8
MOST_SHORTFALL = 0.05
"""Of the share that is right below the share stated, where at least `SURE` is stated."""
MOST_EQUIVALENTS = 1.2
MOST_WIDTH = 1.5
MOST_ORDERS = 0.99


def rates(found: Sequence[Outcome]) -> dict[str, tuple[int, int]]:
    """Return (right, asked) for every question with a bar."""

    def count(values: Iterable[bool | None]) -> tuple[int, int]:
        kept = [bool(v) for v in values if v is not None]
        return sum(kept), len(kept)

    def verdicts(name: str) -> tuple[int, int]:
        return count(o.verdict == name for o in found if o.wanted == name)

    return {
        "structure first, where separable": count(o.first for o in found if o.separable),
        "structure first or equivalent, all": count(o.listed for o in found),
        "no boundary where there is none": count(o.no_boundary for o in found),
        "bracket holds the boundary": count(o.bracket for o in found),
        "interval holds the boundary": count(o.interval for o in found),
        "boundary at Dean 100 consistent": verdicts("consistent"),
        "boundary fixed in frequency contradicted": verdicts("contradicted"),
        "one amplitude undetermined": verdicts("undetermined"),
        "order interval holds the order": count(h for o in found for h in o.orders),
    }


def limits(right: int, asked: int) -> tuple[float, float]:
    """Return the 95 % Clopper-Pearson interval of a rate."""
    low = 0.0 if right == 0 else float(beta.ppf(0.025, right, asked - right + 1))
    high = 1.0 if right == asked else float(beta.ppf(0.975, right + 1, asked - right))
    return low, high


def rate(right: int, asked: int) -> str:
    """Return the cells of a rate and its interval."""
    if not asked:
        return "0 / 0 | |"
    low, high = limits(right, asked)
    return f"{right} / {asked} | {right / asked:.3f} ({low:.2f} to {high:.2f}) |"


def reliability(stated: Sequence[tuple[float, bool]]) -> str:
    """Return, by stated probability, how often it is right, as a Markdown table."""
    lines = [
        "| stated probability | right / stated | share right (95 %) | mean stated |",
        "|---|---|---|---|",
    ]
    for low, high in zip(BINS, BINS[1:], strict=False):
        last = high == BINS[-1]
        some = [(p, r) for p, r in stated if low <= p and (p < high or last)]
        mean = f"{np.mean([p for p, _ in some]):.3f}" if some else ""
        lines.append(
            f"| {low:g} to {high:g} | {rate(sum(r for _, r in some), len(some))} {mean} |"
        )
    value, asked = shortfall(stated)
    lines.append(
        f"\nStated {SURE:g} or more in {asked}: right less often than stated by {value:+.3f}"
        f" (at most {MOST_SHORTFALL:g} allowed)."
    )
    return "\n".join(lines)


def shortfall(stated: Sequence[tuple[float, bool]]) -> tuple[float, int]:
    """Return mean stated less share right where much is stated, and in how many."""
    sure = [(p, r) for p, r in stated if p >= SURE]
    if not sure:
        return 0.0, 0
    return float(np.mean([p - r for p, r in sure])), len(sure)


def table(found: Sequence[Outcome]) -> str:
    """Return the rates as Markdown tables."""
    lines = ["| question | right / asked | share (95 %) | bar |", "|---|---|---|---|"]
    for question, (right, asked) in rates(found).items():
        bar = f"{BARS[question]:.2f}"
        if question.startswith("order"):
            bar += f" to {MOST_ORDERS:g}"
        lines.append(f"| {question} | {rate(right, asked)} {bar} |")
    told = [o.equivalents for o in found if o.separable]
    widths = [o.width for o in found if o.width is not None]
    if told:
        lines.append(
            f"| equivalents a band, mean where separable | | {np.mean(told):.2f} |"
            f" {MOST_EQUIVALENTS:.2f} |"
        )
    if widths:
        lines.append(
            f"| interval over bracket, median | | {np.median(widths):.2f} | {MOST_WIDTH:.2f} |"
        )
    return "\n".join([*lines, "", reliability([(o.probability, o.first) for o in found])])


def misses(found: Sequence[Outcome]) -> str:
    """Return the cases that are not as they should be, one a line."""
    lines = [
        f"- {o.seed}: {o.structure}, {o.plan} plan of {o.records} records, {o.gap:.1f} nats from"
        f" the nearest rival; named {' and '.join(o.named)} at {o.probability:.2f}"
        + ("" if o.listed else ", the truth not listed")
        for o in found
        if not o.listed or (o.separable and not o.first) or (o.probability >= SURE and not o.first)
    ]
    return "\n".join(lines or ["none"])

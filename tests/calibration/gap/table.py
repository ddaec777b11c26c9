"""The blind study's rates beside their bars, in Markdown."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from statistics import fmean, median

from scipy.stats import binomtest

from tests.calibration.gap.study import FAILED, IMPOSSIBLE, Outcome

FALL = 0.03
"""By which a rate may fall below the one before: the bars."""


@dataclass(frozen=True)
class Rates:
    """The rates of a set in the run before the engine's rebuilding (commit d379887)."""

    named: Mapping[float, float]
    """Of effects named first, by size."""
    stated: float
    """Of effects first or among the alternatives."""
    agrees: float
    """Of campaigns with nothing hidden."""
    unknown: float
    """Of effects outside the catalogue."""
    sure: float
    """Of effects outside, a name stated above 0.9."""
    both: float
    """Of pairs, both named within three rounds."""
    closed: float
    """Of right answers, the held-out gap within `TIMES_NOISE` of the noise."""


BEFORE = {
    "first": Rates({0.2: 0.977, 0.1: 0.977, 0.05: 0.977}, 0.979, 1.0, 0.972, 0.0, 0.84, 0.944),
    "second": Rates({0.2: 0.982, 0.1: 0.973, 0.05: 0.95}, 0.988, 1.0, 0.989, 0.0, 0.88, 0.919),
}


def bars(kind: str) -> Rates:
    """Return the bars of a set; `sure` is the most. The third set has those of the second."""
    before = BEFORE.get(kind, BEFORE["second"])
    return Rates(
        {size: rate - FALL for size, rate in before.named.items()},
        before.stated - FALL, before.agrees - FALL, before.unknown - FALL, before.sure + FALL,
        before.both - FALL, before.closed - FALL,
    )


MEDIAN_ALTERNATIVES, TIMES_NOISE, RELIABLE = 3, 1.3, 0.1
EDGES = (0.0, 0.3, 0.5, 0.7, 0.8, 0.9, 0.95, 0.99, 1.0)


def interval(right: int, asked: int) -> tuple[float, float]:
    """Return the 95 % Clopper-Pearson interval of a rate."""
    found = binomtest(right, asked).proportion_ci(0.95, method="exact")
    return float(found.low), float(found.high)


def parts(found: Sequence[Outcome]) -> dict[str, list[Outcome]]:
    """Return outcomes by what was asked: "catalogue", "outside", "clean", "pairs"."""
    result: dict[str, list[Outcome]] = {k: [] for k in ("catalogue", "outside", "clean", "pairs")}
    for o in found:
        ids = o.case.ids
        if o.named[0] == IMPOSSIBLE:
            continue
        name = "clean" if not ids else "pairs" if len(ids) > 1 else "catalogue"
        result["outside" if ids == ("outside",) else name].append(o)
    return result


def table(found: Sequence[Outcome], *, list_wrong: bool) -> str:
    """Return rates, reliability and, where `list_wrong`, each wrong answer."""
    part, bar = parts(found), bars(found[0].case.kind)
    single, outside, clean, pairs = part.values()
    done = [*single, *outside, *clean, *pairs]
    lines = ["| asked | campaigns right | 95 % interval | bar | met |", "|---|---|---|---|---|"]
    for size in sorted({o.case.size for o in single}, reverse=True):
        some = [o for o in single if o.case.size == size]
        lines.append(_row(f"named first, {100 * size:g} %", some, _right, bar.named.get(size)))
    right = [o for o in single if o.right and o.expected != ("agrees",)]
    lines += [
        _row("among the stated, all sizes", single, lambda o: o.stated, bar.stated),
        _row("nothing hidden: agrees", clean, _right, bar.agrees),
        _row("outside: unknown, or only like what is named", outside, _right, bar.unknown),
        _row("outside: unknown first", outside, _unknown, None),
        _row("outside: a name above 0.9", outside, _sure, bar.sure, most=True),
        _row("pairs: both within three rounds", pairs, lambda o: o.both, bar.both),
        _row(
            "held-out gap ≤ 1.3 × noise, where right", right,
            lambda o: o.ratio <= TIMES_NOISE, bar.closed,
        ),
    ]
    if single:
        count = median(len(o.alternatives) for o in single)
        met = "yes" if count <= MEDIAN_ALTERNATIVES else "no"
        lines.append(f"| alternatives, median | {count:g} | | ≤ {MEDIAN_ALTERNATIVES} | {met} |")
    lines += ["", *reliability(done), "", *by_effect(single)]
    lines += ["", *notes(found, done)]
    if list_wrong:
        lines += ["", "Wrong first answers:", "", *(_wrong(done) or ["none"])]
    return "\n".join(lines)


def reliability(found: Sequence[Outcome]) -> list[str]:
    """Return the share that is right by stated probability, over all first answers."""
    lines = [
        "| stated probability | mean | campaigns right | 95 % interval | within ± 0.1 |",
        "|---|---|---|---|---|",
    ]
    for low, high in zip(EDGES, EDGES[1:], strict=False):
        last = high == EDGES[-1]
        some = [
            o for o in found
            if not o.named[0].startswith(FAILED)
            and (low <= o.probability < high or (last and o.probability >= high))
        ]
        if some:
            hit, mean = sum(o.right for o in some), fmean(o.probability for o in some)
            ends = _ends(hit, len(some))
            met = "yes" if abs(hit / len(some) - mean) <= RELIABLE else "no"
            lines.append(
                f"| {low:g} to {high:g} | {mean:.2f} | {_share(hit, len(some))} | {ends} | {met} |"
            )
    return lines


def by_effect(single: Sequence[Outcome]) -> list[str]:
    """Return the share named first, by effect and size."""
    sizes = sorted({o.case.size for o in single}, reverse=True)
    head = "".join(f" {100 * s:g} % |" for s in sizes)
    lines = [f"| effect |{head} baseline held | agrees expected |", "|---" * (len(sizes) + 3) + "|"]
    for name in sorted({o.case.ids[0] for o in single}):
        own = [o for o in single if o.case.ids[0] == name]
        cells = ""
        for size in sizes:
            some = [o for o in own if o.case.size == size]
            cells += f" {sum(o.right for o in some)} of {len(some)} |"
        held, absent = sum(o.fixed for o in own), sum(o.expected == ("agrees",) for o in own)
        lines.append(f"| {name} |{cells} {held} | {absent} |")
    return lines


def notes(found: Sequence[Outcome], done: Sequence[Outcome]) -> list[str]:
    """Return what couldn't be hidden, what failed, time and the commits that answered."""
    failed = sum(o.named[0].startswith(FAILED) for o in done)
    commits = Counter(o.commit for o in found)
    named = ", ".join(f"{c or 'unknown'} ({n})" for c, n in commits.most_common())
    seconds = median(o.seconds for o in done) if done else 0.0
    return [
        f"{len(found) - len(done)} could not be hidden at their size; {failed} searches failed,"
        f" counted as wrong; {seconds:.1f} s in the median. Answered by commit {named}; + marks"
        " uncommitted changes."
    ]


def _right(outcome: Outcome) -> bool:
    return outcome.right


def _unknown(outcome: Outcome) -> bool:
    return outcome.named[0] == "unknown"


def _sure(outcome: Outcome) -> bool:
    return not outcome.right and outcome.named[0] != "agrees" and outcome.probability > 0.9


def _row(
    text: str,
    some: Sequence[Outcome],
    hit: Callable[[Outcome], bool],
    bar: float | None,
    *,
    most: bool = False,
) -> str:
    if not some:
        return f"| {text} | – | | | not asked |"
    right = sum(hit(o) for o in some)
    rate = right / len(some)
    ends = _ends(right, len(some))
    if bar is None:
        return f"| {text} | {_share(right, len(some))} | {ends} | | |"
    met = "yes" if (rate <= bar if most else rate >= bar) else "no"
    sign = "≤" if most else "≥"
    return f"| {text} | {_share(right, len(some))} | {ends} | {sign} {100 * bar:.1f} % | {met} |"


def _share(right: int, asked: int) -> str:
    return f"{right} of {asked} ({100.0 * right / asked:.1f} %)"


def _ends(right: int, asked: int) -> str:
    low, high = interval(right, asked)
    return f"{low:.2f} to {high:.2f}"


def _wrong(found: Iterable[Outcome]) -> list[str]:
    return [
        f"- {'+'.join(o.case.hidden) or 'nothing'} {100 * o.case.size:g} %, seed {o.case.seed}"
        f"{', held' if o.fixed else ''}: {o.named[0]} ({o.probability:.2f}), expected"
        f" {' or '.join(o.expected)}"
        for o in found
        if not o.right
    ]

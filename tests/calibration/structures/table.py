"""Rates of the study beside the bars of the issue, in Markdown."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Sequence
from statistics import fmean, median

from scipy.stats import binomtest

from tests.calibration.structures.devices import KINDS
from tests.calibration.structures.scoring import Outcome

EDGES = (0.0, 0.3, 0.5, 0.6, 0.7, 0.8, 0.9, 0.95, 0.99, 1.0)
RELIABLE, ENOUGH = 0.07, 40
"""A bin of at least so many answers is reliable within so much."""
SURE = 0.9
_WHOLE = tuple(k for k in KINDS if k != "SFOIM")

Hit = Callable[[Outcome], bool]


def interval(hits: int, asked: int) -> tuple[float, float]:
    """Return the 95 % Clopper-Pearson interval of a rate."""
    found = binomtest(hits, asked).proportion_ci(0.95, method="exact")
    return float(found.low), float(found.high)


BARS: dict[str, dict[str, float]] = {
    "structures": {
        "first": 0.97, "listed": 0.99, "none": 0.98, "bracket": 0.97, "coordinate": 0.95,
        "error": 1.1, "sure": 0.05,
    },
    "two-boundaries": {"number": 0.90, "brackets": 0.85},
    "one-extra": {"first": 0.93, "extra": 0.90, "none": 0.95},
    "outside": {"first": 0.85, "remainder": 0.90, "none": 0.90},
    "thin": {},
}
"""Bars of issue 31; "sure" is the most. It gives no share for the remainder's size: 0.9 stands."""


ABOUT = {
    "structures": "Devices of five kinds x ten laws of friction; a fifth each of drives with 2 %"
    " of second and third harmonic, forces with even lines, 2.3 cycles a record, and sweeps and"
    " random records in place of sines.",
    "two-boundaries": "Three bands, or two that pass into one another gradually.",
    "one-extra": "One effect of the catalogue at 3 to 10 % of the force in every device.",
    "outside": "One effect at 5 % that the catalogue has no name for.",
    "thin": "3 to 8 records of one amplitude, noise of 2 to 10 %; they may tell nothing.",
}


def document(outcomes: Sequence[Outcome], stamp: str) -> str:
    """Return the whole table with what it is about."""
    return (
        f"# Calibration of structures and boundaries\n\n{stamp}. Made by `make calibration`.\n\n"
        "Devices, friction, plans and noise are drawn by a generator that shares no code with the"
        " engine (`tests/calibration/structures`). Except in the thin set, the nearest rival of"
        " what is asked for is 12 nats away or more. A device is right where all its bands are.\n\n"
        f"{table(outcomes)}\n"
    )


def table(outcomes: Sequence[Outcome]) -> str:
    """Return the rows of every set among the outcomes."""
    parts = []
    for name in BARS:
        some = [o for o in outcomes if o.set == name]
        if some:
            parts.append("\n".join([
                f"## {name}: {len(some)} campaigns", "", ABOUT[name], "", *rows(name, some)
            ]))
    return "\n\n".join(parts)


def rows(name: str, some: Sequence[Outcome]) -> list[str]:
    """Return the lines of one set."""
    lines = ["| asked | right | 95 % interval | bar | met |", "|---|---|---|---|---|"]
    lines += _rates(name, some)
    lines += ["", *reliability(some)]
    for title, key in (
        ("friction", "friction"), ("device", "kind"), ("plan", "twist"), ("hidden", "effect"),
    ):
        if len({getattr(o, key) for o in some}) > 1:
            lines += ["", *by(title, key, some)]
    lines += ["", notes(some)]
    return lines


def _rates(name: str, some: Sequence[Outcome]) -> list[str]:
    bars = BARS[name]
    whole = [o for o in some if o.kind in _WHOLE]
    parted = [o for o in some if o.kind not in _WHOLE]
    sharp = [o for o in parted if o.kind != "gradual"]
    gradual = [o for o in parted if o.kind == "gradual"]
    told = [o for o in parted if o.coordinate_right is not None]
    lines = [
        row("core first", some, lambda o: o.core_right, bars.get("first")),
        row("core listed", some, lambda o: o.core_listed, bars.get("listed")),
        row("no boundary where none", whole, lambda o: o.bands == 1, bars.get("none")),
        row("number of bands, sharp boundaries", sharp, lambda o: o.bands_right,
            bars.get("number")),
        row("bracket holds, all of a device", sharp, lambda o: all(o.brackets),
            bars.get("bracket", bars.get("brackets"))),
        row("coordinate, where told", told, lambda o: bool(o.coordinate_right),
            bars.get("coordinate")),
        row("gradual boundary found as such", gradual, lambda o: bool(o.gradual_right), None),
        row("sharp boundary has no width", sharp, lambda o: bool(o.sharp_right), None),
        row("cores and number of bands", some, lambda o: o.core_right and o.bands_right, None),
        covered("order", [c for o in some for c in o.orders]),
        covered("exponent, where free", [c for o in some for c in o.exponents]),
        covered("inertance", [c for o in some for c in o.inertances], bar=False),
        row("hidden extra named", [o for o in some if o.extra_right is not None],
            lambda o: bool(o.extra_right), bars.get("extra")),
        row("nothing named that isn't there", some,
            lambda o: not o.failure and not o.false_extras, None),
        row("remainder within 1.5", [o for o in some if o.remainder_right is not None],
            lambda o: bool(o.remainder_right), bars.get("remainder")),
        row("remainder's interval holds it", [o for o in some if o.remainder_covers is not None],
            lambda o: bool(o.remainder_covers), None),
    ]
    sure = [o for o in some if o.stated is not None and o.stated > SURE]
    lines.append(
        row("wrong, of those stated above 0.9", sure, lambda o: not o.core_right,
            bars.get("sure"), most=True)
    )
    lines.append(middle("error over true noise, median (not moving records)",
                        [o.error_ratio for o in some], bars.get("error")))
    lines.append(middle("error over stated noise, median", [o.own_ratio for o in some], None))
    return [line for line in lines if line]


def row(
    text: str, asked: Sequence[Outcome], hit: Hit, bar: float | None, *, most: bool = False
) -> str:
    """Return a line of counts; nothing where nothing was asked."""
    if not asked:
        return ""
    hits = sum(hit(o) for o in asked)
    low, high = interval(hits, len(asked))
    share = f"{hits} of {len(asked)} ({100.0 * hits / len(asked):.1f} %)"
    ends = f"{low:.3f} to {high:.3f}"
    if bar is None:
        return f"| {text} | {share} | {ends} | | |"
    rate = hits / len(asked)
    met = "yes" if (rate <= bar if most else rate >= bar) else "no"
    return f"| {text} | {share} | {ends} | {'≤' if most else '≥'} {100 * bar:g} % | {met} |"


def covered(text: str, hits: Sequence[bool], *, bar: bool = True) -> str:
    """Return a line of an interval's coverage."""
    if not hits:
        return ""
    rate = sum(hits) / len(hits)
    low, high = interval(sum(hits), len(hits))
    line = f"| {text}: 95 % interval holds it | {sum(hits)} of {len(hits)} ({100 * rate:.1f} %)"
    line += f" | {low:.3f} to {high:.3f} |"
    if not bar:
        return line + " | |"
    return f"{line} 92 to 98 % | {'yes' if 0.92 <= rate <= 0.98 else 'no'} |"


def middle(text: str, values: Sequence[float | None], bar: float | None) -> str:
    """Return a line of a median."""
    known = [v for v in values if v is not None]
    if not known:
        return ""
    found = median(known)
    if bar is None:
        return f"| {text} | {found:.2f} of {len(known)} | | | |"
    return f"| {text} | {found:.2f} of {len(known)} | | ≤ {bar:g} | {_yes(found <= bar)} |"


def reliability(some: Sequence[Outcome]) -> list[str]:
    """Return how often the core is right by the probability stated for it."""
    lines = [
        "| stated probability of the core | mean | right | 95 % interval | within ± 0.07 |",
        "|---|---|---|---|---|",
    ]
    asked = [o for o in some if o.stated is not None]
    for low, high in zip(EDGES, EDGES[1:], strict=False):
        part = [o for o in asked if low <= o.stated < high or o.stated == high == 1.0]
        if not part:
            continue
        hits, mean = sum(o.core_right for o in part), fmean(o.stated for o in part)
        met = "few"
        if len(part) >= ENOUGH:
            met = _yes(abs(hits / len(part) - mean) <= RELIABLE)
        ends = interval(hits, len(part))
        lines.append(
            f"| {low:g} to {high:g} | {mean:.3f} | {hits} of {len(part)}"
            f" ({100.0 * hits / len(part):.1f} %) | {ends[0]:.3f} to {ends[1]:.3f} | {met} |"
        )
    return lines


def by(title: str, key: str, some: Sequence[Outcome]) -> list[str]:
    """Return counts by one property of the cases."""
    lines = [
        f"| {title} | core first | listed | number of bands | extra or remainder |"
        " error over noise |",
        "|---|---|---|---|---|---|",
    ]
    for value in sorted({str(getattr(o, key)) for o in some}):
        part = [o for o in some if str(getattr(o, key)) == value]
        hidden = [
            bool(o.extra_right or o.remainder_right) for o in part
            if (o.extra_right, o.remainder_right) != (None, None)
        ]
        ratios = [o.error_ratio for o in part if o.error_ratio is not None]
        lines.append(
            f"| {value or 'none'} | {sum(o.core_right for o in part)} of {len(part)}"
            f" | {sum(o.core_listed for o in part)} | {sum(o.bands_right for o in part)}"
            f" | {f'{sum(hidden)} of {len(hidden)}' if hidden else ''}"
            f" | {f'{median(ratios):.2f}' if ratios else ''} |"
        )
    return lines


def notes(some: Sequence[Outcome]) -> str:
    """Return failures, time, and which code answered."""
    failed = Counter(o.failure.partition(":")[0] for o in some if o.failure)
    commits = Counter(o.commit or "unknown" for o in some)
    seconds, worked = [o.seconds for o in some], [o.worked for o in some]
    text = f"{sum(failed.values())} studies failed, counted as wrong"
    if failed:
        text += f" ({', '.join(f'{n} {name}' for name, n in failed.most_common())})"
    absent = sum(o.without_interval for o in some)
    text += f"; {absent} orders without an interval; {median(seconds):.1f} s in the median,"
    text += f" {max(seconds):.1f} s at most; of processor time {median(worked):.1f} s and"
    text += f" {max(worked):.1f} s."
    false = Counter(e for o in some for e in o.false_extras)
    if false:
        text += f" Named and not there: {', '.join(f'{i} {n}' for i, n in false.most_common())}."
    return f"{text} Commits: {', '.join(f'{c} ({n})' for c, n in commits.most_common())}."


def _yes(met: bool) -> str:
    return "yes" if met else "no"

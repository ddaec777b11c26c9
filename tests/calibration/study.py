"""Runs the study on random cases and counts how often what it states is right."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from joblib import Parallel, delayed
from scipy.stats import beta

from discover.study import run_study
from tests.calibration.generator import Case, random_case
from tests.calibration.truth import separable

BARS = {
    "structure first, where separable": 0.90,
    "structure first or equivalent, all": 0.97,
    "stated probability over 0.8 is right, less what it states": -0.05,
    "no boundary where there is none": 0.95,
    "bracket holds the boundary": 0.95,
    "interval holds the boundary": 0.93,
    "boundary at Dean 100 consistent": 0.90,
    "boundary fixed in frequency contradicted": 0.90,
    "one amplitude undetermined": 1.0,
    "order interval holds the order": 0.90,
}


@dataclass(frozen=True)
class Outcome:
    """What one case gave; None where a question does not arise."""

    seed: int
    structure: str
    separable: bool
    first: bool
    listed: bool
    equivalents: float
    probability: float
    no_boundary: bool | None
    bracket: bool | None
    interval: bool | None
    width: float | None
    verdict: str | None
    wanted: str | None
    order: bool | None


def _sides(case: Case) -> int:
    """Return the number of tests on the side of the boundary that has fewer."""
    above = sum(t.upper for t in case.tests)
    return min(above, len(case.tests) - above)


def _divides(case: Case, lower: tuple[str, ...]) -> bool:
    """Return whether the lower band holds just the tests below the true boundary."""
    below = {
        r.file for r, t in zip(case.campaign.records, case.tests, strict=True) if not t.upper
    }
    return set(lower) == below


def judge_case(case: Case) -> Outcome | None:
    """Return a case's outcome; None for a boundary that its tests hardly reach."""
    segmented = case.boundary != "none"
    if segmented and _sides(case) < 3:
        return None
    study = run_study(case.campaign)
    names = [b.structure for b in study.bands]
    wanted_names = ["FOIM", "FOIM"] if segmented else [case.structure]
    told = segmented or separable(case)
    first = names == wanted_names
    truth = wanted_names[0]
    listed = all(truth in {s for s, _ in b.equivalents} for b in study.bands)
    probability = min(b.probability for b in study.bands)
    orders = [
        t.shape_intervals["order"]
        for b in study.bands
        for t in b.terms
        if t.fitted.id == "fractional-derivative" and "order" in t.shape_intervals
    ]
    order = None
    if first and truth == "FOIM":
        laws = (case.lower, case.upper) if segmented else (case.upper,)
        order = all(lo <= law.order <= hi for law, (lo, hi) in zip(laws, orders, strict=True))
    bracket = interval = width = verdict = wanted = None
    if segmented:
        verdict = study.dean_check.verdict
        one = len({round(t.amplitude, 6) for t in case.tests}) == 1
        wanted = "undetermined" if one else {
            "dean": "consistent", "frequency": "contradicted"
        }[case.boundary]
        found = [b for b in study.boundaries if study.coordinate == case.boundary]
        if found:
            bracket = any(b.bracket[0] <= case.place <= b.bracket[1] for b in found)
            interval = any(b.interval[0] <= case.place <= b.interval[1] for b in found)
        else:  # given along the other coordinate: right where it divides the tests rightly
            bracket = interval = len(names) == 2 and _divides(case, study.bands[0].records)
        if found:
            b = found[0]
            spans = [np.log(high / low) for low, high in (b.interval, b.bracket)]
            width = float(spans[0] / spans[1])
    return Outcome(
        case.seed, case.structure, told, first, listed or first,
        float(np.mean([len(b.equivalents) for b in study.bands])), probability,
        None if segmented else not study.boundaries, bracket, interval, width, verdict, wanted,
        order,
    )


def outcomes(seeds, jobs: int = 1) -> list[Outcome]:
    """Return the outcomes of cases, over processes."""
    found = Parallel(n_jobs=jobs)(delayed(_one)(s) for s in seeds)
    return [o for o in found if o is not None]


def _one(seed: int) -> Outcome | None:
    return judge_case(random_case(seed))


def rates(found: list[Outcome]) -> dict[str, tuple[int, int]]:
    """Return (right, asked) for every question with a bar."""

    def count(values):
        kept = [bool(v) for v in values if v is not None]
        return sum(kept), len(kept)

    def verdicts(name):
        asked = [o.verdict == name for o in found if o.wanted == name]
        return sum(asked), len(asked)

    sure = [o.first for o in found if o.probability >= 0.8]
    return {
        "structure first, where separable": count(o.first for o in found if o.separable),
        "structure first or equivalent, all": count(o.listed for o in found),
        "stated probability over 0.8 is right, less what it states": (sum(sure), len(sure)),
        "no boundary where there is none": count(o.no_boundary for o in found),
        "bracket holds the boundary": count(o.bracket for o in found),
        "interval holds the boundary": count(o.interval for o in found),
        "boundary at Dean 100 consistent": verdicts("consistent"),
        "boundary fixed in frequency contradicted": verdicts("contradicted"),
        "one amplitude undetermined": verdicts("undetermined"),
        "order interval holds the order": count(o.order for o in found),
    }


def share(question: str, right: int, asked: int, found: list[Outcome]) -> float:
    """Return the share that a bar is about: right over asked, less the mean stated probability."""
    value = right / max(asked, 1)
    if question.startswith("stated"):
        value -= float(np.mean([o.probability for o in found if o.probability >= 0.8] or [0.0]))
    return value


def upper_limit(right: int, asked: int) -> float:
    """Return the upper end of the 95 % Clopper-Pearson interval of a rate."""
    return 1.0 if right == asked else float(beta.ppf(0.975, right + 1, asked - right))


def table(found: list[Outcome]) -> str:
    """Return the rates as a Markdown table."""
    lines = ["| question | right / asked | share | bar |", "|---|---|---|---|"]
    for question, (right, asked) in rates(found).items():
        value = share(question, right, asked, found)
        lines.append(f"| {question} | {right} / {asked} | {value:.3f} | {BARS[question]:.2f} |")
    told = [o.equivalents for o in found if o.separable]
    widths = [o.width for o in found if o.width is not None]
    lines.append(f"| equivalents a band, mean where separable | | {np.mean(told):.2f} | 1.20 |")
    if widths:
        lines.append(f"| interval over bracket, median | | {np.median(widths):.2f} | 1.50 |")
    return "\n".join(lines)

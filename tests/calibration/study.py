"""Runs the study on random cases: what it answers, beside the truth."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from joblib import Parallel, delayed

from discover.study import run_study
from tests.calibration.generator import Case, random_case
from tests.calibration.truth import TELLING, least_gap


@dataclass(frozen=True)
class Outcome:
    """What one case gave; None where a question does not arise."""

    seed: int
    structure: str
    plan: str
    records: int
    gap: float
    """Nats to the nearest rival."""
    named: tuple[str, ...]
    """Structures, band by band."""
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
    orders: tuple[bool, ...]
    """Whether each order's interval holds it."""

    @property
    def separable(self) -> bool:
        """True where the nearest rival is ten nats away."""
        return self.gap >= TELLING


def _divides(case: Case, lower: tuple[str, ...]) -> bool:
    """Return whether the lower band holds just the tests below the true boundary."""
    below = {
        r.file for r, t in zip(case.campaign.records, case.tests, strict=True) if not t.upper
    }
    return set(lower) == below


def judge_case(case: Case) -> Outcome:
    """Return a case's outcome."""
    segmented = case.boundary != "none"
    study = run_study(case.campaign)
    names = tuple(b.structure for b in study.bands)
    wanted_names = ("FOIM", "FOIM") if segmented else (case.structure,)
    first = names == wanted_names
    truth = wanted_names[0]
    listed = len(names) == len(wanted_names) and all(
        truth in {s for s, _ in b.equivalents} for b in study.bands
    )
    orders = [
        t.shape_intervals["order"]
        for b in study.bands
        for t in b.terms
        if t.fitted.id == "fractional-derivative" and "order" in t.shape_intervals
    ]
    held: tuple[bool, ...] = ()
    if first and truth == "FOIM":
        laws = (case.lower, case.upper) if segmented else (case.upper,)
        held = tuple(
            bool(lo <= law.order <= hi) for law, (lo, hi) in zip(laws, orders, strict=True)
        )
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
            b = found[0]
            spans = [np.log(high / low) for low, high in (b.interval, b.bracket)]
            width = float(spans[0] / spans[1])
        else:  # given along the other coordinate: right where it divides the tests rightly
            bracket = interval = len(names) == 2 and _divides(case, study.bands[0].records)
    return Outcome(
        case.seed, case.structure, case.plan, len(case.tests), least_gap(case), names, first,
        listed or first, float(np.mean([len(b.equivalents) for b in study.bands])),
        min(b.probability for b in study.bands), None if segmented else not study.boundaries,
        bracket, interval, width, verdict, wanted, held,
    )


def outcomes(seeds, jobs: int = 1) -> list[Outcome]:
    """Return the outcomes of cases, over processes."""
    return list(Parallel(n_jobs=jobs)(delayed(_one)(s) for s in seeds))


def _one(seed: int) -> Outcome:
    return judge_case(random_case(seed))

"""Whether the proposed next test tells more than most tests that the rig could do.

What a test tells is judged by closed forms at the true noise: one of the two open structures, as
fitted, makes all records and the new one, and the other's shortfall is compared with and without
the new test.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from joblib import Parallel, delayed

from discover.next_test import admissible_tests, propose
from discover.regression.support import fitted_terms
from discover.study import StudyOptions
from discover.study.bands import find_bands
from discover.study.preparation import prepare
from tests.calibration.generator import Case, Law, Test, random_case
from tests.calibration.rates import rate
from tests.calibration.truth import expected_gaps, whitened_triangle

QUARTER = 0.75

_NAMES = {
    "inertia": "inertance", "viscous-damping": "viscous", "quadratic-damping": "quadratic",
    "power-law-damping": "turbulent", "coulomb-friction": "friction",
    "fractional-derivative": "fractional",
}


def _law(name: str, terms) -> Law | None:
    """Return a fitted model as closed forms; None where it has a term that they lack."""
    values: dict[str, float] = {}
    for term in terms:
        if term.id not in _NAMES or term.shape.get("exponent", 1.75) != 1.75:
            return None
        values[_NAMES[term.id]] = term.coefficient
        if "order" in term.shape:
            values["order"] = term.shape["order"]
    return Law(name, **values)


def _made_by(case: Case, law: Law) -> tuple[list[Test], list[np.ndarray]]:
    """Return the case's tests with a law's force, and their triangles."""
    tests = [
        replace(t, clean=law.force(t.amplitude, 2.0 * np.pi * t.frequency, t.theta))
        for t in case.tests
    ]
    return tests, [whitened_triangle(t) for t in tests]


def _extra(case: Case, law: Law, frequency: float, amplitude: float) -> Test:
    """Return a further test of five cycles, with the noise of the one nearest in frequency."""
    near = min(case.tests, key=lambda t: abs(np.log(t.frequency / frequency)))
    omega = 2.0 * np.pi * frequency
    rate = max(200.0, 60.0 * frequency)
    theta = omega * np.arange(max(int(5.0 / frequency * rate), 2 * near.noise.poles.size)) / rate
    clean = law.force(amplitude, omega, theta)
    share = near.sigma / float(np.sqrt(np.mean(near.clean**2)))
    sigma = share * float(np.sqrt(np.mean(clean**2)))
    return Test(frequency, amplitude, theta, clean, near.noise, sigma, upper=True)


def standing(seed: int, rivals: int = 20) -> float | None:
    """Return the share of random admissible tests that tell less than the proposed one.

    None where nothing is open in the case, or a leading structure has a term without closed form.
    """
    case = random_case(seed)
    if case.boundary != "none":
        return None
    prepared = prepare(case.campaign, StudyOptions())
    bands = find_bands(prepared, case.campaign.device, StudyOptions())
    judgement = bands.judgements[0]
    if len(bands.judgements) > 1 or sum(p >= 0.05 for p in judgement.probabilities.values()) < 2:
        return None
    proposed = propose(judgement, prepared.dictionary, None)
    if proposed is None or "other" in proposed.separates:
        return None
    laws = []
    for name in proposed.separates:
        scored = judgement.contest.best(name)
        law = None if scored is None else _law(
            name, fitted_terms(scored.fit, prepared.dictionary)
        )
        if law is None:
            return None
        laws.append(law)
    rng = np.random.default_rng([77, seed])
    frequencies, amplitudes = admissible_tests(judgement.windows, None)
    chosen = rng.choice(frequencies.size, size=min(rivals, frequencies.size), replace=False)
    candidates = [(proposed.frequency_hz, proposed.amplitude_m)]
    candidates += [(float(frequencies[i]), float(amplitudes[i])) for i in chosen]
    total = np.zeros(len(candidates))
    for law, other in ((laws[0], laws[1].structure), (laws[1], laws[0].structure)):
        tests, triangles = _made_by(case, law)
        before = expected_gaps(tests, [other], triangles)[0]
        for index, (frequency, amplitude) in enumerate(candidates):
            extra = _extra(case, law, frequency, amplitude)
            more = [*triangles, whitened_triangle(extra)]
            total[index] += expected_gaps([*tests, extra], [other], more)[0] - before
    return float(np.mean(total[1:] <= total[0] * (1.0 + 1e-9)))


def standings(seeds, wanted: int, jobs: int = 1) -> list[float]:
    """Return the standing in the first `wanted` undecided cases among seeds, over processes."""
    seeds, found, batch = list(seeds), [], 8 * jobs
    for start in range(0, len(seeds), batch):
        results = Parallel(n_jobs=jobs)(
            delayed(standing)(s) for s in seeds[start : start + batch]
        )
        found += [s for s in results if s is not None]
        if len(found) >= wanted:
            break
    return found[:wanted]


def table(found: Sequence[float]) -> str:
    """Return how often the proposed test is among the best quarter, in Markdown."""
    right = sum(s >= QUARTER for s in found)
    return (
        "| question | right / asked | share (95 %) | bar |\n|---|---|---|---|\n"
        f"| proposed test at or above the 75th percentile | {rate(right, len(found))} 0.75 |\n\n"
        f"Median standing {np.median(found):.2f}."
    )

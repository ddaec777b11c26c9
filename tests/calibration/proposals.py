"""Whether the proposed next test tells more than most tests that the rig could do.

What a test tells is judged by closed forms at the true noise: one of the two open structures, as
fitted, makes all records and the new one, and the other's shortfall is compared with and without
the new test.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from discover.next_test import admissible_tests, propose
from discover.regression.support import fitted_terms
from discover.study import StudyOptions
from discover.study.bands import find_bands
from discover.study.preparation import prepare
from tests.calibration.generator import Case, Law, Test, random_case
from tests.calibration.truth import expected_gap

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


def _made_by(case: Case, law: Law, extra: tuple[float, float] | None) -> Case:
    tests = [
        replace(t, clean=law.force(t.amplitude, 2.0 * np.pi * t.frequency, t.theta))
        for t in case.tests
    ]
    if extra is not None:
        frequency, amplitude = extra
        theta = 2.0 * np.pi * 5.0 * np.arange(500) / 500.0
        clean = law.force(amplitude, 2.0 * np.pi * frequency, theta)
        first = case.tests[0]
        share = first.sigma / float(np.sqrt(np.mean(first.clean**2)))
        sigma = share * float(np.sqrt(np.mean(clean**2)))
        tests.append(
            Test(frequency, amplitude, theta, clean, first.correlation, sigma, upper=True)
        )
    return replace(case, tests=tuple(tests))


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
        before = expected_gap(_made_by(case, law, None), other)
        total += [expected_gap(_made_by(case, law, c), other) - before for c in candidates]
    return float(np.mean(total[1:] <= total[0] * (1.0 + 1e-9)))

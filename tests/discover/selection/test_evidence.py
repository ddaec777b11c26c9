"""Evidence prefers the truth; probabilities are those of the formula."""

import numpy as np
import pytest

from discover.regression.support import ProfiledFit, Support
from discover.selection.evidence import contest, penalty, score
from discover.selection.structures import named_supports
from discover.triangle import triangle_of
from tests.discover.spectra import dictionary, windows

PLAN = [(a, f) for a in (0.005, 0.02) for f in (0.3, 0.7, 1.5, 3.0, 7.0)]
SPACE = dictionary(
    "inertia", "viscous-damping", "quadratic-damping", "coulomb-friction", "stiffness",
    exponents=(0.4, 3.0),
)  # fmt: skip
FRICTION = {"coulomb-friction": 50.0}
TRUTHS = {
    "FOIM": {("order", 1.7): 400.0, **FRICTION},
    "IOIM-linear": {"inertia": 300.0, "viscous-damping": 2000.0, **FRICTION},
    "IOIM-laminar": {
        "inertia": 300.0, "viscous-damping": 1000.0, "quadratic-damping": 5e3, **FRICTION,
    },
    "IOIM-turbulent": {"inertia": 300.0, ("power", 1.75): 6e3, **FRICTION},
}  # fmt: skip


@pytest.mark.parametrize("structure", TRUTHS)
def test_the_true_structure_is_the_most_probable(structure):
    for seed in range(5):
        tests = windows(SPACE, TRUTHS[structure], PLAN, noise=0.01, seed=seed)
        result = contest(triangle_of(tests), SPACE, named_supports(SPACE, ()))
        assert result.scored[0].structure == structure
        assert max(result.probabilities, key=result.probabilities.get) == structure
        assert sum(result.probabilities.values()) == pytest.approx(1.0)


def test_evidence_is_the_gaussian_likelihood_less_half_the_bic_penalty():
    tests = windows(SPACE, TRUTHS["IOIM-linear"], PLAN, noise=0.01)
    support = Support(("inertia", "viscous-damping", "coulomb-friction"))
    (scored,) = score(ProfiledFit(triangle_of(tests), SPACE), [support])
    rows = np.concatenate([w.matrix for w in tests])
    variance = np.concatenate([w.variance[w.block] for w in tests])
    positions = [SPACE.index(i) for i in support.plain]
    x, y = rows[:, positions] / np.sqrt(variance)[:, None], rows[:, -1] / np.sqrt(variance)
    left = y - x @ np.linalg.lstsq(x, y, rcond=None)[0]
    observations = sum(15 for _ in tests)
    logs = sum(np.log(w.variance[0]) + 2.0 * np.log(w.variance[1:]).sum() for w in tests)
    expected = -0.5 * (left @ left + logs) - 1.5 * np.log(observations)
    assert scored.log_evidence == pytest.approx(expected, rel=1e-9)
    assert penalty(3, observations) == pytest.approx(1.5 * np.log(150))


def test_at_one_frequency_nothing_tells_an_order_from_inertance_and_damping():
    """D^q of a sine is a mixture of v and a: the misfits are one and the same."""
    plan = [(a, 2.0) for a in (0.004, 0.01, 0.02)]
    tests = windows(SPACE, TRUTHS["FOIM"], plan, noise=0.01)
    engine = ProfiledFit(triangle_of(tests), SPACE)
    fractional = engine.fit(Support(("coulomb-friction",), free=("fractional-derivative",)))
    integer = engine.fit(Support(("inertia", "viscous-damping", "coulomb-friction")))
    assert fractional.chi2 == pytest.approx(integer.chi2, abs=0.01)


def test_a_term_that_is_not_there_is_rarely_worth_its_parameter():
    """Chance of a chi-square with one degree of freedom above log n, n = 150: 2.5 %."""
    wrong = 0
    base = ("inertia", "viscous-damping", "coulomb-friction")
    for seed in range(60):
        tests = windows(SPACE, TRUTHS["IOIM-linear"], PLAN, noise=0.02, seed=seed)
        supports = [Support(base), Support((*base, "stiffness"))]
        wrong += score(ProfiledFit(triangle_of(tests), SPACE), supports)[0].fit.support.ids != base
    assert wrong <= 6


def test_having_many_variants_does_not_help_a_structure():
    tests = windows(SPACE, TRUTHS["IOIM-linear"], PLAN, noise=0.3)
    fractional = Support(("coulomb-friction",), free=("fractional-derivative",))
    integer = Support(("inertia", "viscous-damping", "coulomb-friction"))
    once = contest(triangle_of(tests), SPACE, [fractional, integer]).probabilities
    often = contest(triangle_of(tests), SPACE, [fractional] * 5 + [integer]).probabilities
    assert often["FOIM"] == pytest.approx(once["FOIM"], rel=1e-9)


def test_an_unphysical_sign_has_no_evidence():
    tests = windows(SPACE, {"inertia": 300.0, "viscous-damping": -300.0}, PLAN, noise=0.01)
    support = Support(("inertia", "viscous-damping"))
    (scored,) = score(ProfiledFit(triangle_of(tests), SPACE), [support])
    assert scored.log_evidence == -np.inf


def test_elastic_terms_name_no_structure_where_they_are_minor():
    for stiffness, name in ((300.0, "IOIM-linear"), (2e5, "other")):
        truth = {**TRUTHS["IOIM-linear"], "stiffness": stiffness}
        tests = windows(SPACE, truth, PLAN, noise=0.01)
        support = Support(("inertia", "viscous-damping", "coulomb-friction", "stiffness"))
        (scored,) = score(ProfiledFit(triangle_of(tests), SPACE), [support])
        assert scored.structure == name

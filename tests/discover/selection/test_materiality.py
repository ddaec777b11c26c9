"""A term is named only if it explains more than remains."""

import numpy as np
import pytest

from discover.regression.support import ProfiledFit, Support
from discover.selection.materiality import (
    Materiality,
    Worth,
    noise_energy,
    record_power,
    relative_triangle,
    replaced,
    without,
)
from tests.discover.spectra import dictionary, windows

PLAN = [(a, f) for a in (0.005, 0.02) for f in (0.3, 1.0, 3.0, 7.0)]
SPACE = dictionary("inertia", "viscous-damping", "quadratic-damping", "coulomb-friction")
LINEAR = Support(("inertia", "viscous-damping", "coulomb-friction"))
TERMS = {"inertia": 300.0, "viscous-damping": 1000.0, "coulomb-friction": 50.0}


def test_noise_energy_is_that_of_repeated_noise():
    found = []
    for seed in range(150):
        clean = windows(SPACE, TERMS, PLAN, noise=0.0)
        noisy = windows(SPACE, TERMS, PLAN, noise=0.05, seed=seed)
        found.append(
            sum(
                np.sum((n.matrix[:, -1] - c.matrix[:, -1]) ** 2) / c.power
                for n, c in zip(noisy, clean, strict=True)
            )
        )
    mean, deviation = noise_energy(windows(SPACE, TERMS, PLAN, noise=0.05))
    assert mean == pytest.approx(np.mean(found), rel=0.03)
    assert deviation == pytest.approx(np.std(found), rel=0.25)


def test_the_relative_triangle_weighs_quiet_records_as_loud_ones():
    tests = windows(SPACE, TERMS, PLAN, noise=0.01)
    triangle = relative_triangle(tests)
    # each record's force has unit mean square up to its noise
    assert triangle.target @ triangle.target == pytest.approx(len(PLAN), rel=0.02)
    assert record_power(tests) == pytest.approx({w.record: w.power for w in tests})


def test_a_term_that_explains_more_than_remains_matters():
    tests = windows(SPACE, {**TERMS, "stiffness": 400.0}, PLAN, noise=0.001)
    rule = Materiality(tests, SPACE)
    assert rule.unexplained(LINEAR) > 0.0
    assert rule.holds(LINEAR)


def test_a_term_that_explains_less_than_remains_does_not():
    """Two parts of the force are outside the dictionary: one loud, one shows as v|v|."""
    space = dictionary("inertia", "viscous-damping", "quadratic-damping", orders=None)
    truth = {
        "inertia": 300.0, "viscous-damping": 1000.0, "quadratic-damping": 60.0,
        "coulomb-friction": 40.0,
    }  # fmt: skip
    rule = Materiality(windows(space, truth, PLAN, noise=0.001), space)
    whole = Support(("inertia", "viscous-damping", "quadratic-damping"))
    identifier, gain = rule.weakest(whole)
    assert identifier == "quadratic-damping"
    assert gain < 1.0
    assert not rule.holds(whole)
    assert rule.holds(Support(("inertia", "viscous-damping")))


def test_where_noise_is_the_limit_the_rule_never_bites():
    tests = windows(SPACE, TERMS, PLAN, noise=0.2)
    rule = Materiality(tests, SPACE)
    assert rule.unexplained(LINEAR) == 0.0
    assert rule.holds(Support((*LINEAR.plain, "quadratic-damping")))


def test_a_shape_at_its_bound_is_not_identified():
    space = dictionary("coulomb-friction", orders=(0.0, 1.5))
    tests = windows(space, {("order", 1.8): 300.0, "coulomb-friction": 50.0}, PLAN, noise=0.001)
    support = Support(("coulomb-friction",), free=("fractional-derivative",))
    assert not Materiality(tests, space).holds(support)


def worth_of(share):
    """Return whether a stiffness of this share of the loudest record's force is worth a name."""
    space = dictionary("inertia", "viscous-damping", "stiffness", orders=None)
    amplitude, frequency = 0.01, 1.0
    omega = 2.0 * np.pi * frequency
    truth = {"inertia": 100.0, "stiffness": share * 100.0 * omega**2}
    # friction-free, at two frequencies, so that the stiffness shows where the inertia can't follow
    plan = [(amplitude, frequency), (amplitude, 30.0)]
    tests = windows(space, truth, plan, noise=1e-6)
    engine = ProfiledFit(relative_triangle(tests), space)
    supports = [Support(("inertia", "stiffness")), Support(("inertia",)), Support(("stiffness",))]
    fits = [engine.fit(s) for s in supports]
    return Worth(tests, fits).all_terms(fits[0])


def test_what_no_load_cell_sees_is_not_worth_a_name():
    assert worth_of(0.02)
    assert not worth_of(2e-4)


def test_support_with_a_term_less_or_replaced():
    support = Support(("inertia",), free=("fractional-derivative",))
    assert without(support, "inertia") == Support((), free=("fractional-derivative",))
    assert replaced(support, "fractional-derivative", "viscous-damping") == Support(
        ("inertia", "viscous-damping")
    )
    assert replaced(support, "fractional-derivative", "inertia") == Support(("inertia",))

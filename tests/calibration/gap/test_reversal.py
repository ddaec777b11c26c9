"""Seals of both sets reverse along curves of their own, apart from those that discovery fits."""

import numpy as np
import pytest
from scipy.optimize import brentq, minimize

from models.rig.reversal import tabulate
from models.rig.reversal_laws import LAWS
from tests.calibration.gap.case import Case, campaign, measure, seal_of
from tests.calibration.gap.second_set import SECOND_LAWS

ALL = (*LAWS, *SECOND_LAWS)
RATIO = np.geomspace(1e-3, 1e4, 500)
APART = 0.01


def hyperbolic(u, m):
    """Return tanh(u^m)^(1/m)."""
    return np.tanh(np.exp(np.minimum(m * np.log(u), 6.0))) ** (1.0 / m)


def algebraic(u, m):
    """Return u/(1 + u^(2m))^(1/(2m)), by logarithms."""
    return np.exp(np.log(u) - np.logaddexp(0.0, 2.0 * m * np.log(u)) / (2.0 * m))


def distance(law, family):
    """Return the least greatest difference of a law from a family, any scale and any m."""
    wanted = law.share(RATIO)

    def worst(place):
        m, scale = np.exp(np.clip(place, -12.0, 12.0))
        return np.max(np.abs(family(RATIO * scale, m) - wanted))

    starts = []
    for m in np.geomspace(0.1, 50.0, 40):
        half = brentq(
            lambda s, m=m: family(np.array([np.exp(s)]), m)[0] - 0.5, -20.0, 12.0
        )
        starts += [(np.log(m), half + off) for off in (-0.3, -0.1, 0.0, 0.1, 0.3)]
    starts.sort(key=worst)
    options = {"xatol": 1e-5, "fatol": 1e-7}
    found = [minimize(worst, s, method="Nelder-Mead", options=options) for s in starts[:4]]
    return min(float(f.fun) for f in found)


def test_the_fit_finds_a_members_own_shape():
    class Member:
        def share(self, ratio):
            return algebraic(1.7 * ratio, 1.3)

    assert distance(Member(), algebraic) < 1e-5
    assert distance(Member(), hyperbolic) > 1e-3


@pytest.mark.parametrize("family", [hyperbolic, algebraic])
@pytest.mark.parametrize("law", ALL, ids=lambda law: law.name)
def test_no_law_is_near_a_family_that_discovery_fits(law, family):
    assert distance(law, family) > APART


@pytest.mark.parametrize("law", ALL, ids=lambda law: law.name)
def test_laws_are_odd_monotone_and_reach_the_limit(law):
    share = law.share(RATIO)
    np.testing.assert_array_equal(law.share(-RATIO), -share)
    assert law.share(np.array([0.0]))[0] == 0.0
    assert np.all(np.diff(share) >= -1e-15)
    assert np.all((share > 0.0) & (share <= 1.0))
    assert law.share(np.array(1.0)) == pytest.approx(0.5, rel=1e-9)
    assert law.share(np.array(1e7)) == pytest.approx(1.0, abs=2e-6)


@pytest.mark.parametrize("law", ALL, ids=lambda law: law.name)
def test_slopes_are_finite_and_those_of_finite_differences(law):
    # Away from the corner that a law has where it meets its limit.
    corner = 1.0 / law.half
    ratio = RATIO[np.abs(RATIO / corner - 1.0) > 1e-3]
    step = 1e-5 * ratio
    numeric = (law.share(ratio + step) - law.share(ratio - step)) / (2.0 * step)
    slope = law.share_slope(ratio)
    np.testing.assert_allclose(slope, numeric, rtol=1e-6, atol=1e-9)
    np.testing.assert_array_equal(law.share_slope(-ratio), slope)
    assert 0.2 < law.share_slope(np.array(0.0)) < 5.0


@pytest.mark.parametrize("law", ALL, ids=lambda law: law.name)
def test_table_follows_its_law(law):
    place = RATIO / (1.0 + RATIO)
    table = tabulate(law)
    found = np.interp(place, np.linspace(0.0, 1.0, table.size), table)
    np.testing.assert_allclose(found, law.share(RATIO), atol=2e-4)


def test_the_sets_share_no_law():
    scales = np.geomspace(0.5, 2.0, 121)
    for one in LAWS:
        for other in SECOND_LAWS:
            least = min(np.max(np.abs(one.share(RATIO * s) - other.share(RATIO))) for s in scales)
            assert least > APART, (one.name, other.name)


@pytest.mark.parametrize(("kind", "laws"), [("first", LAWS), ("second", SECOND_LAWS)])
def test_seeds_draw_every_law_of_their_set_and_no_other(kind, laws):
    seals = [seal_of(Case(kind, (), 0.0, seed)) for seed in range(60)]
    assert {seal.reversal for seal in seals} == set(laws)
    speeds = [seal.half_speed for seal in seals]
    assert 0.8e-4 <= min(speeds) < 0.9e-4
    assert 1.4e-4 < max(speeds) <= 1.6e-4


@pytest.mark.parametrize("kind", ["first", "second"])
def test_plain_friction_follows_the_seal_of_the_case(kind):
    # Any other law of either set leaves 0.3 % or more.
    case = Case(kind, (), 0.0, 61)
    seal = seal_of(case)
    for record in measure(case)[:3]:
        velocity = np.gradient(record.true_displacement, record.time)
        columns = [
            np.gradient(velocity, record.time), velocity, velocity * np.abs(velocity),
            seal.reversal.share(velocity / seal.half_speed),
        ]
        design = np.stack(columns, axis=1)[5:-5]
        found = np.linalg.lstsq(design, record.true_force[5:-5], rcond=None)[0]
        left = record.true_force[5:-5] - design @ found
        assert np.sqrt(np.mean(left**2)) < 0.002 * np.sqrt(np.mean(record.true_force**2))
    assert len(campaign(case, clean=True).records) == len(measure(case))


@pytest.mark.parametrize(
    ("kind", "name"),
    [
        ("first", "stribeck-friction:tustin"),
        ("first", "position-dependent-friction:taper"),
        ("second", "stribeck-friction#1"),
        ("second", "position-dependent-friction#0"),
    ],
)
def test_effects_at_the_seals_reverse_with_them(kind, name):
    case = Case(kind, (name,), 0.1, 61)
    seal, hidden = seal_of(case), measure(case)[0].hidden[0]
    assert hidden.law == seal.reversal.name
    assert hidden.values["reversal"] == seal.half_speed

"""The third set is what it claims to be: it acts, and differs from the first and second."""

from dataclasses import replace

import numpy as np
import pytest

from models.rig import CATALOGUE, FORMS, OUTSIDE, Chain, Plan, RigPhysics, TestPoint, run
from tests.calibration.gap.case import Case, campaign, pair_cases, single_cases
from tests.calibration.gap.second_set import SECOND
from tests.calibration.gap.third_set import (
    THIRD,
    THIRD_LAWS,
    third_device,
    third_noise,
    third_plan,
    third_seal,
)

SIZE = 0.1
ALL = [(key, k) for key in THIRD for k in range(len(THIRD[key]))]
ALIKE = ("inertia", "stiffness", "viscous-damping", "force-offset", "time-delay", "sensor-gain")
RATIO = np.geomspace(1e-3, 1e4, 500)


@pytest.fixture(scope="module")
def device():
    return third_device(np.random.default_rng(3))


@pytest.fixture(scope="module")
def plan(device):
    points = third_plan(device, np.random.default_rng(3))
    return Plan(tuple(replace(p, cycles=3.0) for p in points))


def force(device, plan, hidden):
    physics = replace(RigPhysics.simple(), seal_values=third_seal(device))
    records = run(device, plan, seed=5, hidden=hidden, chain=Chain.ideal(), physics=physics)
    return np.concatenate([r.true_force for r in records])


@pytest.fixture(scope="module")
def plain(device, plan):
    return force(device, plan, {})


@pytest.fixture(scope="module")
def other_changes(device, plan, plain):
    return {
        key: [
            force(device, plan, {form: SIZE}) - plain
            for form in (*FORMS[key].values(), *SECOND[key])
        ]
        for key in CATALOGUE
    }


@pytest.mark.sweep
@pytest.mark.parametrize(("key", "k"), ALL, ids=[f"{key}-{k}" for key, k in ALL])
def test_reaches_its_size_and_is_no_form_of_the_other_sets(
    device, plan, plain, other_changes, key, k
):
    change = force(device, plan, {THIRD[key][k]: SIZE}) - plain
    reached = np.sqrt(np.mean(change**2) / np.mean(plain**2))
    assert reached == pytest.approx(SIZE, rel=0.035)
    # Where physics leaves little choice, forms are nearly alike; they are never the same.
    most = 0.999999 if key in ALIKE else 0.9999
    for other in other_changes.get(key, []) if key != "inertia" else ():  # a mass is a mass
        cosine = change @ other / np.sqrt((change @ change) * (other @ other))
        assert abs(cosine) < most


def test_every_effect_of_the_catalogue_has_a_form():
    assert set(THIRD) == {*CATALOGUE, "outside"}
    assert all(1 <= len(forms) <= 2 for key, forms in THIRD.items() if key != "outside")


def test_six_new_kinds_are_outside_the_catalogue():
    kinds = {effect.id for effect in THIRD["outside"]}
    assert len(kinds) == 6
    assert not kinds & (set(OUTSIDE) | {effect.id for effect in SECOND["outside"]})


@pytest.mark.parametrize("seed", range(12))
def test_plans_hold_ten_to_fifteen_different_records(seed):
    rng = np.random.default_rng([33, seed])
    found = third_plan(third_device(rng), rng)
    assert 10 <= len(found) <= 15
    assert all(100.0 <= p.sampling <= 2400.0 for p in found)


@pytest.mark.parametrize("kind", range(3))
def test_noise_is_one_percent_and_coloured(kind):
    point = TestPoint(1.0, 0.01, cycles=40.0, sampling=500.0)
    t = np.arange(round(point.duration * point.sampling)) / point.sampling
    noise = third_noise(np.sin(t), point.sampling, kind, np.random.default_rng(2))
    power = np.abs(np.fft.rfft(noise)) ** 2
    assert np.sqrt(np.mean(noise**2) / np.mean(np.sin(t) ** 2)) == pytest.approx(0.01)
    bands = np.array([part.sum() for part in np.array_split(power, 40)])
    assert bands.max() / bands.sum() > 0.04


@pytest.mark.parametrize("law", THIRD_LAWS, ids=lambda law: law.name)
def test_laws_are_odd_monotone_and_reach_the_limit(law):
    share = law.share(RATIO)
    np.testing.assert_array_equal(law.share(-RATIO), -share)
    assert law.share(np.array([0.0]))[0] == 0.0
    assert np.all(np.diff(share) >= -1e-15)
    assert law.share(np.array(1.0)) == pytest.approx(0.5, rel=1e-9)
    assert law.share(np.array(1e7)) == pytest.approx(1.0, abs=2e-6)


@pytest.mark.parametrize("law", THIRD_LAWS, ids=lambda law: law.name)
def test_slopes_are_those_of_finite_differences(law):
    place = np.array([0.01, 0.3, 0.9, 2.0, 7.0])
    step = 1e-6
    expected = (law.share(place + step) - law.share(place - step)) / (2.0 * step)
    np.testing.assert_allclose(law.share_slope(place), expected, rtol=1e-5, atol=1e-8)


def test_the_study_can_ask_for_it():
    single = single_cases("third", [4], [0.1])
    assert {c.ids[0] for c in single} == {*CATALOGUE, "outside"}
    assert sum(c.ids == ("outside",) for c in single) == 6
    assert all(len(set(c.ids)) == 2 for c in pair_cases("third", range(5)))
    spring = next(c for c in single if c.ids == ("stiffness",))
    hidden, clean = campaign(spring), campaign(Case("third", (), 0.0, 4))
    assert 10 <= len(hidden.records) <= 15
    assert [r.file for r in hidden.records] == [r.file for r in clean.records]
    off = [h.force - c.force for h, c in zip(hidden.records, clean.records, strict=True)]
    assert any(np.std(o) > 0.02 * np.std(c.force) for o, c in zip(off, clean.records, strict=True))

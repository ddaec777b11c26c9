"""The second set is what it claims to be: it acts, and differs from the first."""

from dataclasses import replace

import numpy as np
import pytest

from models.rig import FORMS, OUTSIDE, Chain, Plan, RigPhysics, TestPoint, run
from tests.calibration.gap.second_set import (
    ONLY_FORM,
    SECOND,
    second_device,
    second_noise,
    second_plan,
)

SIZE = 0.1
NEW = [(key, k) for key in SECOND if key not in ONLY_FORM for k in range(len(SECOND[key]))]


@pytest.fixture(scope="module")
def device():
    return second_device(np.random.default_rng(5))


@pytest.fixture(scope="module")
def plan(device):
    points = second_plan(device, np.random.default_rng(5))
    return Plan(tuple(replace(p, cycles=3.0) for p in points))


def force(device, plan, hidden):
    chain, physics = Chain.ideal(), RigPhysics.simple()
    records = run(device, plan, seed=5, hidden=hidden, chain=chain, physics=physics)
    return np.concatenate([r.true_force for r in records])


@pytest.fixture(scope="module")
def plain(device, plan):
    return force(device, plan, {})


@pytest.fixture(scope="module")
def first_changes(device, plan, plain):
    return {
        key: [force(device, plan, {form: SIZE}) - plain for form in forms.values()]
        for key, forms in FORMS.items()
        if key in SECOND and key not in ONLY_FORM
    }


@pytest.mark.parametrize(("key", "k"), NEW, ids=[f"{key}-{k}" for key, k in NEW])
def test_reaches_its_size_and_is_no_form_of_the_first_set(
    device, plan, plain, first_changes, key, k
):
    change = force(device, plan, {SECOND[key][k]: SIZE}) - plain
    reached = np.sqrt(np.mean(change**2) / np.mean(plain**2))
    assert reached == pytest.approx(SIZE, rel=0.035)
    for other in first_changes.get(key, []):
        cosine = change @ other / np.sqrt((change @ change) * (other @ other))
        assert abs(cosine) < 0.9999


def test_five_new_kinds_are_outside_the_catalogue():
    kinds = {effect.id for effect in SECOND["outside"]}
    assert len(kinds) >= 5
    assert not kinds & set(OUTSIDE)


@pytest.mark.parametrize("seed", range(12))
def test_plans_hold_ten_to_sixteen_different_records(seed):
    rng = np.random.default_rng([31, seed])
    plan = second_plan(second_device(rng), rng)
    assert 10 <= len(plan) <= 16
    assert all(100.0 <= p.sampling <= 2000.0 for p in plan)


@pytest.mark.parametrize("kind", range(3))
def test_noise_is_one_percent_and_coloured(kind):
    point = TestPoint(1.0, 0.01, cycles=40.0, sampling=500.0)
    t = np.arange(round(point.duration * point.sampling)) / point.sampling
    noise = second_noise(np.sin(t), point.sampling, kind, np.random.default_rng(2))
    power = np.abs(np.fft.rfft(noise)) ** 2
    assert np.sqrt(np.mean(noise**2) / np.mean(np.sin(t) ** 2)) == pytest.approx(0.01)
    # White noise has an even spectrum: its strongest twentieth of 20 bands holds about 5 %.
    bands = np.array([part.sum() for part in np.array_split(power, 40)])
    assert bands.max() / bands.sum() > 0.06

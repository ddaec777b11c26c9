"""What a gap search's answer says against itself."""

from dataclasses import replace

import numpy as np
import pytest

from discover.gap import close_gap, prepare_baseline
from discover.gap.findings import findings_of
from discover.gap.search import search
from discover.motion_fit import observe_all
from tests.discover.gap_data import campaign, device

MODEL = "fit:inertia,viscous-damping"


def with_friction(t, x, v, a):
    return device(t, x, v, a) + 40.0 * np.sign(v)


def warnings(found):
    return [f.text for f in found if f.level == "warning"]


@pytest.fixture(scope="module")
def answered():
    """Return a search, its rounds as they are stated, and what it started from."""
    tests = campaign(with_friction)
    baseline = prepare_baseline(observe_all(tests.records, 1), MODEL, fixed=False)
    rounds = close_gap(tests, MODEL, effects=["coulomb-friction"]).rounds
    return baseline, search(baseline, ["coulomb-friction"]), rounds


def told(answered, **changes):
    baseline, found, rounds = answered
    stated = [replace(r, **changes) for r in rounds]
    return warnings(findings_of(baseline, found, stated, "", 1.0))


def test_a_sound_round_warns_of_nothing(answered):
    assert len(answered[2]) == 1
    assert told(answered) == []


def test_a_round_that_raises_the_gap_of_unfitted_records_is_told(answered):
    (only,) = told(answered, unseen=(2.0, 2.2))
    assert "coulomb-friction lowers" in only
    assert "from 2 % to 2.2 %" in only
    assert told(answered, unseen=(2.0, 2.01)) == []
    assert told(answered, unseen=(None, None)) == []


def test_a_round_that_serves_the_quiet_at_the_cost_of_the_loud_is_told(answered):
    raised = {"gap": (17.0, 20.0), "alike": (60.0, 21.0)}
    (only,) = told(answered, unseen=(17.0, 21.0), **raised)
    assert "count alike from 60 % to 21 %, but raises the pooled one from 17 % to 20 %" in only
    assert "records not fitted from 17 % to 21 %" in only
    (only,) = told(answered, unseen=(None, None), **raised)
    assert "records not fitted" not in only


def test_a_coefficient_that_is_not_told_from_zero_is_told(answered):
    (only,) = told(answered, interval=(-3.0, 80.0))
    assert "not told from zero" in only
    assert told(answered, interval=(-80.0, -3.0)) == []


@pytest.mark.parametrize(("count", "warned"), [(3, True), (4, False)])
def test_few_records_are_told(count, warned):
    tests = campaign(with_friction)
    few = replace(tests, records=tests.records[-count:])
    found = close_gap(few, MODEL, effects=["coulomb-friction"])
    assert found.rounds
    assert any("Fewer than 4" in text for text in warnings(found.findings)) is warned


def test_a_force_that_does_not_repeat_is_told():
    quiet = close_gap(campaign(device, noise=0.1), MODEL, effects=["stiffness"])
    assert not any("does not repeat" in text for text in warnings(quiet.findings))
    loud = close_gap(campaign(device, noise=0.4), MODEL, effects=["stiffness"])
    (told,) = [text for text in warnings(loud.findings) if "does not repeat" in text]
    assert "In 8 of 8 records" in told


def with_a_spike(share):
    """Return a device that is hit once a cycle, for a share of it."""
    def law(t, x, v, a):
        near = np.abs(v - 0.5 * v.max()) < share * v.max()
        return device(t, x, v, a) + 30.0 * np.abs(a).max() * (near & (x > 0.0))

    return law


@pytest.mark.parametrize(("share", "warned"), [(0.01, True), (0.15, False)])
def test_what_is_left_in_single_samples_is_told(share, warned):
    """A blow of one sample can't be judged; one that lasts a thirtieth of the cycle can."""
    found = close_gap(campaign(with_a_spike(share)), MODEL, effects=["stiffness"])
    assert found.final_gap_percent > 1.2 * found.noise_percent
    told = [text for text in warnings(found.findings) if "no longer than a sample" in text]
    assert bool(told) is warned


def with_a_stop(t, x, v, a):
    beyond = np.maximum(np.abs(x) - 0.006, 0.0)
    return device(t, x, v, a) + 3e5 * beyond * np.sign(x)


def unmet(found):
    return [
        f for f in found.findings if "met worse" in f.text or "worse when left out" in f.text
    ]


def test_what_only_held_out_records_show_is_told():
    """Where a stop is reached in held-out records only, the fitted ones lack nothing."""
    tests = campaign(with_a_stop)
    deep = [np.ptp(r.displacement) > 0.012 for r in tests.records]
    assert 0 < sum(deep) < len(deep)
    marked = replace(tests, records=tuple(
        replace(r, held_out=far) for r, far in zip(tests.records, deep, strict=True)
    ))
    found = close_gap(marked, MODEL, effects=["stiffness", "end-stop"])
    assert found.verdict == "agrees"
    (told,) = unmet(found)
    assert f"{sum(deep)} of {sum(deep)} records" in told.text
    assert "beyond them in amplitude" in told.text
    assert told.record in {r.file for r, far in zip(tests.records, deep, strict=True) if far}


def test_what_one_record_alone_tells_is_told():
    tests = campaign(with_a_stop)
    deep = [i for i, r in enumerate(tests.records) if np.ptp(r.displacement) > 0.012]
    one = replace(tests, records=tuple(
        r for i, r in enumerate(tests.records) if i not in deep[1:]
    ))
    found = close_gap(one, MODEL, effects=["end-stop"])
    (told,) = unmet(found)
    assert told.record == tests.records[deep[0]].file
    assert "Test near it again" in told.text


def test_records_that_are_met_are_not_told():
    tests = campaign(device)
    marked = replace(tests, records=(
        replace(tests.records[0], held_out=True), *tests.records[1:]
    ))
    assert unmet(close_gap(marked, MODEL, effects=["stiffness"])) == []
    assert unmet(close_gap(tests, MODEL, effects=["stiffness"])) == []

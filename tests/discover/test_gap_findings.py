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

import math

import pytest

from discover.data_check import TELLING
from discover.records import RigLimits
from tests.discover.data_check.plan import SINGLE, WIDE, checked


@pytest.fixture(scope="module")
def single():
    return checked(SINGLE)


@pytest.fixture(scope="module")
def more(single):
    added = single.added_test
    return checked((*SINGLE, (added.frequency_hz, added.amplitude_m)))


def test_running_the_added_test_tells_the_pairs_apart(single, more):
    added = single.added_test
    assert added.nats > TELLING
    assert added.frequency_hz != pytest.approx(2.0, rel=0.1)
    assert more.inseparable == ()
    assert more.added_test is None


def test_the_gap_that_is_promised_is_about_the_gap_that_comes(single, more):
    """Promised for nominal forces at the plan's noise; the new record's force differs from them."""
    came = next(p.nats for p in more.pairs if p.structures == single.added_test.structures)
    assert 0.2 < came / single.added_test.nats < 5.0


def test_no_test_is_added_where_everything_can_be_told():
    assert checked(WIDE).added_test is None


def test_the_added_test_stays_within_the_limits_of_the_rig():
    limits = RigLimits(max_stroke=0.015, max_speed=0.1, max_acceleration=1.0)
    added = checked(SINGLE, rig=limits).added_test
    omega = 2.0 * math.pi * added.frequency_hz
    assert added.amplitude_m <= 0.015
    assert omega * added.amplitude_m <= 0.1001
    assert omega**2 * added.amplitude_m <= 1.001


def test_a_rig_without_force_has_no_test_to_add():
    assert checked(SINGLE, rig=RigLimits(max_force=1e-6)).added_test is None

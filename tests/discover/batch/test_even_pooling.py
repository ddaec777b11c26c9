import numpy as np
import pytest

from discover.batch.even_pooling import evenly_pooled

NAMES = [f"d{i}" for i in range(40)]


def width(told):
    return told.interval[1] - told.interval[0]


def test_devices_tested_by_one_plan_leave_the_same_room():
    """More devices do not tell where between two tests a number lies."""
    found = evenly_pooled(np.full(30, 1.0), np.full(30, 2.0), NAMES[:30]).values
    assert all(0.75 < width(t) <= 0.96 for t in found)


def test_a_device_whose_tests_lie_wide_apart_leans_on_the_others():
    lower, upper = np.array([1.0, 1.1, 0.9, 1.0, 0.0]), np.array([1.5, 1.6, 1.4, 1.5, 4.0])
    found = evenly_pooled(lower, upper, NAMES[:5]).values
    assert width(found[4]) < 0.5 * 4.0
    assert found[4].interval[0] < 1.3 < found[4].interval[1]


def test_what_lies_apart_stays_between_its_own_ends():
    lower, upper = np.array([1.0, 1.1, 0.9, 1.0, 5.0]), np.array([1.5, 1.6, 1.4, 1.5, 5.5])
    found = evenly_pooled(lower, upper, NAMES[:5])
    low, high = found.values[4].interval
    assert 5.0 <= low < 5.1
    assert 5.4 < high <= 5.5
    assert found.spread.value > 1.0


def test_units_and_sign_do_not_matter():
    lower, upper = np.array([1.0, 1.2, 0.0]), np.array([1.5, 1.6, 4.0])
    one = evenly_pooled(lower, upper, list("abc"))
    other = evenly_pooled(-1e3 * upper, -1e3 * lower, list("abc"))
    for a, b in zip(one.values, other.values, strict=True):
        assert -1e3 * a.value == pytest.approx(b.value, rel=1e-3)
        assert 1e3 * width(a) == pytest.approx(width(b), rel=1e-3)
    assert 1e3 * one.spread.value == pytest.approx(other.spread.value, rel=1e-3)


def test_numbers_of_one_device_do_not_tell_each_other():
    lower, upper = np.array([1.0, 1.0, 1.0, 0.0]), np.array([1.2, 1.2, 1.2, 4.0])
    apart = evenly_pooled(lower, upper, ["a", "b", "c", "d"]).values[3]
    own = evenly_pooled(lower, upper, ["d", "d", "c", "d"]).values[3]
    assert width(own) > 1.5 * width(apart)


@pytest.mark.parametrize("shared", [True, False])
def test_intervals_hold_the_truth_as_often_as_they_say(shared):
    """Of 100 fleets of any spread, tested by one plan or each by its own, a third of them wide."""
    generator = np.random.default_rng(11)
    held = []
    for _ in range(100):
        count = int(generator.integers(2, 10))
        start = 0.0 if shared else generator.uniform(0.0, 1.0, count)
        step = np.where(generator.random(count) < 0.3, 4.0, 1.0)
        truth = generator.uniform(-1.0, 1.0) + 10.0 ** generator.uniform(
            -1.0, 1.0
        ) * generator.standard_normal(count)
        lower = start + step * np.floor((truth - start) / step)
        found = evenly_pooled(lower, lower + step, NAMES[:count]).values
        held += [t.interval[0] <= v <= t.interval[1] for t, v in zip(found, truth, strict=True)]
    assert 0.92 <= np.mean(held) <= 0.98

import numpy as np
import pytest

from discover.batch.pooling import far_from_rest, pooled, standard_errors


def test_the_spread_between_devices_is_recovered():
    generator = np.random.default_rng(5)
    errors = generator.uniform(0.5, 1.5, 4000)
    values = 7.0 + 2.0 * generator.standard_normal(4000) + errors * generator.standard_normal(4000)
    found = pooled(values, errors)
    assert found.spread == pytest.approx(2.0, rel=0.05)
    assert found.mean == pytest.approx(7.0, abs=0.12)


def test_the_interval_of_the_mean_holds_it_as_often_as_it_says():
    generator = np.random.default_rng(6)
    errors = np.full(60, 0.4)
    held = 0
    for _ in range(1000):
        values = 1.0 + np.hypot(0.7, 0.4) * generator.standard_normal(60)
        low, high = pooled(values, errors).interval
        held += low <= 1.0 <= high
    assert 0.92 <= held / 1000 <= 0.97


def test_devices_that_do_not_differ_are_averaged_by_their_certainty():
    found = pooled(np.array([1.0, 2.0]), np.array([1.0, 3.0]))
    assert found.mean == pytest.approx((1.0 + 2.0 / 9.0) / (1.0 + 1.0 / 9.0))
    assert found.spread == 0.0


def test_units_do_not_matter():
    generator = np.random.default_rng(7)
    values, errors = generator.normal(5.0, 1.0, 12), generator.uniform(0.1, 0.3, 12)
    one, other = pooled(values, errors), pooled(1e3 * values, 1e3 * errors)
    assert other.mean == pytest.approx(1e3 * one.mean)
    assert other.spread == pytest.approx(1e3 * one.spread)


def test_a_value_that_is_far_and_sure_stands_apart_and_one_that_is_unsure_does_not():
    values = np.array([1.0, 1.1, 0.9, 1.05, 0.95, 4.0, 4.0])
    errors = np.array([0.01, 0.01, 0.01, 0.01, 0.01, 0.01, 2.0])
    assert [place for place, _ in far_from_rest(values, errors)] == [5]


def test_few_devices_have_no_rest_to_be_far_from():
    assert far_from_rest(np.array([1.0, 1.0, 1.0, 9.0]), np.full(4, 0.01)) == []


def test_few_of_a_normal_fleet_stand_apart():
    generator = np.random.default_rng(8)
    counts = [len(far_from_rest(generator.normal(0, 1, 200), np.full(200, 0.1))) for _ in range(50)]
    assert sum(counts) / (50 * 200) < 0.002


def test_standard_errors_are_those_of_the_intervals():
    found = standard_errors(np.array([-1.96]), np.array([1.96]))
    assert found == pytest.approx([1.0], rel=1e-4)

import numpy as np
import pytest
from scipy.integrate import dblquad

from discover.batch.partial_pooling import partly_pooled
from discover.batch.pooling import normals_of

NAMES = [f"d{i}" for i in range(40)]


def width(told):
    return told.interval[1] - told.interval[0]


@pytest.mark.parametrize("spread", [0.0, 0.3, 1.0, 3.0, 10.0])
def test_intervals_hold_the_truth_as_often_as_they_say(spread):
    """Of 150 fleets of 3 to 20 devices, one in four of which is measured four times as badly."""
    generator = np.random.default_rng(17)
    held, narrower = [], []
    for _ in range(150):
        count = int(generator.choice([3, 5, 8, 20]))
        errors = np.exp(0.5 * generator.standard_normal(count))
        errors = errors * np.where(generator.random(count) < 0.25, 4.0, 1.0)
        truth = 5.0 + spread * generator.standard_normal(count)
        values = truth + errors * generator.standard_normal(count)
        found = partly_pooled(values, errors, NAMES[:count]).values
        held += [t.interval[0] <= v <= t.interval[1] for t, v in zip(found, truth, strict=True)]
        narrower += [width(t) / (3.92 * e) for t, e in zip(found, errors, strict=True)]
    # Devices that do not differ at all are told to differ a little: too wide, never too narrow.
    assert 0.93 <= np.mean(held) <= (0.98 if spread >= 1.0 else 1.0)
    assert np.median(narrower) < 1.005


def test_over_fleets_of_any_spread_95_percent_hold_92_to_98():
    generator = np.random.default_rng(18)
    held = []
    for _ in range(500):
        count = int(generator.integers(2, 15))
        errors = np.exp(0.8 * generator.standard_normal(count))
        truth = -2.0 + 10.0 ** generator.uniform(-1.0, 1.0) * generator.standard_normal(count)
        values = truth + errors * generator.standard_normal(count)
        found = partly_pooled(values, errors, NAMES[:count]).values
        held += [t.interval[0] <= v <= t.interval[1] for t, v in zip(found, truth, strict=True)]
    assert 0.92 <= np.mean(held) <= 0.98


def test_it_is_the_integral_over_mean_and_spread():
    values, errors = np.array([1.0, 2.0, 4.0]), np.array([0.5, 0.4, 1.5])

    def weight(mean, log_spread, power):
        spread = np.exp(log_spread)
        prior = np.sqrt(np.sum((spread / (errors**2 + spread**2)) ** 2)) * spread
        wide = errors**2 + spread**2
        density = np.prod(np.exp(-0.5 * (values - mean) ** 2 / wide) / np.sqrt(wide))
        share = spread**2 / wide[2]
        return prior * density * (share * values[2] + (1.0 - share) * mean) ** power

    # Beyond a spread of e^3, 20, next to nothing is left: the tails go as 1 over its square.
    whole, first = (
        dblquad(weight, -8.0, 5.0, lambda s: 2.0 - 9.0 * np.hypot(np.exp(s), 1.0),
                lambda s: 2.0 + 9.0 * np.hypot(np.exp(s), 1.0), args=(power,), epsabs=1e-6)[0]
        for power in (0, 1)
    )  # fmt: skip
    found = partly_pooled(values, errors, list("abc")).values[2]
    assert found.value == pytest.approx(first / whole, rel=2e-3)


def test_a_device_with_thin_data_leans_on_the_others():
    values = np.array([1.0, 1.1, 0.9, 1.05, 2.0])
    errors = np.array([0.02, 0.02, 0.02, 0.02, 0.6])
    found = partly_pooled(values, errors, NAMES[:5])
    assert width(found.values[4]) < 0.4 * 3.92 * 0.6
    assert found.values[4].interval[0] < 1.0 < found.values[4].interval[1] < 2.0
    assert found.values[0].value == pytest.approx(1.0, abs=0.005)


def test_a_device_that_surely_differs_moves_by_no_more_than_the_spread_allows():
    values, errors = np.array([1.0, 1.1, 0.9, 1.05, 4.0]), np.full(5, 0.1)
    found = partly_pooled(values, errors, NAMES[:5])
    moved = values[4] - found.values[4].value
    others = values[:4].mean()
    low, _ = found.spread.interval
    assert found.spread.value > 0.8
    assert 0.0 < moved < errors[4] ** 2 / (errors[4] ** 2 + low**2) * (values[4] - others)
    assert moved < 0.2 * errors[4]


def test_a_device_that_differs_and_hardly_knows_stays_open_between_both():
    values, errors = np.array([1.0, 1.0, 1.0, 1.0, 4.0]), np.array([0.1, 0.1, 0.1, 0.1, 1.0])
    told = partly_pooled(values, errors, NAMES[:5]).values[4]
    assert told.interval[0] < 1.3
    assert told.interval[1] > 2.0


def test_values_of_one_device_do_not_tell_each_other():
    values, errors = np.array([1.0, 1.0, 1.0, 5.0]), np.array([0.1, 0.1, 0.1, 2.0])
    apart = partly_pooled(values, errors, ["a", "b", "c", "d"]).values[3]
    own = partly_pooled(values, errors, ["d", "d", "c", "d"]).values[3]
    assert width(own) > 2.0 * width(apart)


def test_units_and_order_do_not_matter():
    generator = np.random.default_rng(7)
    values, errors = generator.normal(5.0, 1.0, 8), generator.uniform(0.1, 0.9, 8)
    one = partly_pooled(values, errors, NAMES[:8])
    other = partly_pooled(-1e3 * values[::-1], 1e3 * errors[::-1], NAMES[:8])
    assert [-1e3 * t.value for t in one.values] == pytest.approx(
        [t.value for t in other.values[::-1]]
    )
    assert 1e3 * one.spread.value == pytest.approx(other.spread.value)


def test_a_spread_of_many_devices_is_recovered():
    generator = np.random.default_rng(5)
    values = 7.0 + 2.0 * generator.standard_normal(200) + 0.01 * generator.standard_normal(200)
    found = partly_pooled(values, np.full(200, 0.01), [str(i) for i in range(200)])
    assert found.spread.value == pytest.approx(2.0, rel=0.12)
    low, high = found.spread.interval
    assert low < 2.0 < high


def test_inputs_are_not_changed():
    values, errors = np.array([1.0, 2.0]), np.array([0.1, 0.2])
    values.flags.writeable = errors.flags.writeable = False
    partly_pooled(values, errors, ["a", "b"])


def test_an_interval_that_a_bound_cuts_off_is_as_wide_as_on_its_other_side():
    ends = np.array([0.0, 4.0]), np.array([2.06, 6.0])
    means, errors = normals_of(np.array([0.1, 5.0]), *ends, (0.0, np.inf))
    assert means == pytest.approx([0.1, 5.0])
    assert errors == pytest.approx([1.0, 0.5102], rel=1e-3)


def test_a_value_at_one_end_of_its_interval_does_not_make_it_wider():
    ends = np.array([1.0]), np.array([2.0])
    means, errors = normals_of(np.array([1.1]), *ends, (0.0, np.inf))
    assert means == pytest.approx([1.5])
    assert errors == pytest.approx([0.2551], rel=1e-3)

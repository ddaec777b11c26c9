import itertools
import math

import numpy as np
import pytest

from discover.batch.shared_choice import shared_choice


def exact(alone):
    """Sum over all that devices may be, and over agreement: chances (N, K), mean agreement."""
    count, ways = alone.shape
    agreement = (np.arange(1000) + 0.5) / 1000
    chances, agreed = np.zeros(alone.shape), 0.0
    for own in itertools.product(range(ways), repeat=count):
        weight = np.prod([alone[i, k] for i, k in enumerate(own)])
        urn = np.ones(agreement.size)
        for i, k in enumerate(own):
            alpha = 1.0 / agreement - 1.0
            urn = urn * (own[:i].count(k) + alpha / ways) / (i + alpha)
        chances[range(count), own] += weight * urn.sum()
        agreed += weight * float(urn @ agreement)
    whole = chances[0].sum()
    return chances / whole, agreed / whole


@pytest.mark.parametrize(
    "alone",
    [
        [[0.6, 0.4, 0.0], [0.7, 0.3, 0.0], [0.5, 0.3, 0.2], [0.0, 1.0, 0.0], [0.2, 0.8, 0.0]],
        [[0.6, 0.4], [0.6, 0.4], [0.6, 0.4], [0.6, 0.4], [0.6, 0.4], [0.6, 0.4]],
        [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.3, 0.3, 0.4]],
    ],
)
def test_it_is_the_sum_over_all_that_devices_may_be(alone):
    expected, agreement = exact(np.array(alone))
    found = shared_choice(np.array(alone), np.random.default_rng(1))
    assert found.chances == pytest.approx(expected, abs=0.02)
    assert found.agreement == pytest.approx(agreement, abs=0.02)


def test_devices_that_are_sure_and_alike_make_an_unsure_one_surer():
    alone = np.array([[1.0, 0.0]] * 8 + [[0.4, 0.6]])
    found = shared_choice(alone, np.random.default_rng(0))
    assert found.chances[-1, 0] > 0.9
    assert found.agreement > 0.6


def test_a_device_that_is_sure_stays_and_what_is_ruled_out_stays_out():
    alone = np.array([[1.0, 0.0, 0.0]] * 8 + [[0.0, 1.0, 0.0], [0.0, 0.6, 0.3]])
    found = shared_choice(alone, np.random.default_rng(0)).chances
    assert found[-2].tolist() == [0.0, 1.0, 0.0]
    assert found[-1, 0] == 0.0
    assert found[-1].sum() == pytest.approx(0.9)


def test_devices_that_are_all_different_tell_nothing():
    alone = np.array([*np.eye(4), [0.25, 0.25, 0.3, 0.2]])
    found = shared_choice(alone, np.random.default_rng(0))
    assert found.chances[-1] == pytest.approx(alone[-1], abs=0.01)
    assert found.agreement < 0.2


def test_a_seed_makes_it_repeatable():
    alone = np.array([[0.6, 0.4], [0.3, 0.7], [1.0, 0.0]])
    one, two = (shared_choice(alone, np.random.default_rng(3)).chances for _ in range(2))
    assert one.tolist() == two.tolist()


def test_of_those_stated_at_a_probability_as_many_are_right():
    generator = np.random.default_rng(3)
    stated, right = [], []
    for _ in range(100):
        count, agreement = int(generator.choice([3, 5, 10])), generator.uniform(0.01, 0.99)
        shares = generator.dirichlet(np.full(3, (1.0 / agreement - 1.0) / 3) + 1e-9)
        truth = generator.choice(3, count, p=shares)
        # What a device sees of each way is normal, with 1 more for its own: evidence is e^seen.
        seen = generator.standard_normal((count, 3)) + np.eye(3)[truth]
        alone = np.exp(seen) / np.exp(seen).sum(axis=1, keepdims=True)
        chances = shared_choice(alone, generator).chances
        stated += chances.max(axis=1).tolist()
        right += (chances.argmax(axis=1) == truth).tolist()
    stated, right = np.array(stated), np.array(right)
    for low, high in ((0.3, 0.6), (0.6, 0.9), (0.9, 1.01)):
        some = (stated >= low) & (stated < high)
        error = math.sqrt(0.25 / some.sum())
        assert abs(stated[some].mean() - right[some].mean()) < 3.0 * error

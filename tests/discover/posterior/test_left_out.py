"""Which model predicts records that are left out best, and how surely."""

import numpy as np
import pytest

from discover.posterior.left_out import is_less, predicts_best


def test_a_model_that_is_better_in_every_record_is_surer_of_more_records():
    few, many = np.full((2, 2), 1.0), np.full((2, 30), 1.0)
    few[1] = many[1] = 2.0
    assert predicts_best(few, 0)[0] == pytest.approx(5 / 6)
    assert predicts_best(many, 0)[0] > 0.98


def test_models_that_are_better_in_half_of_the_records_are_equally_probable():
    errors = np.array([[1.0, 2.0] * 10, [2.0, 1.0] * 10])
    found = predicts_best(errors, 3)
    assert found == pytest.approx([0.5, 0.5], abs=0.05)
    assert found.sum() == pytest.approx(1.0)
    np.testing.assert_array_equal(found, predicts_best(errors, 3))


def test_errors_are_less_by_more_than_their_standard_error_only():
    was = np.array([1.0, 1.2, 0.9, 1.1])
    assert is_less(was - 0.1, was)
    assert not is_less(was, was)
    assert not is_less(was + [-0.5, 0.4, 0.4, -0.4], was)

"""A part of a study can fail, and how many right answers it takes not to."""

import pytest

from tests.calibration.counting import fewest, holds


@pytest.mark.parametrize(
    ("asked", "bar", "least"),
    [(2, 0.97, 1), (3, 0.9, 2), (5, 0.93, 4), (8, 0.97, 7), (8, 0.99, 7), (10, 0.95, 8)],
)
def test_one_answer_fewer_is_below_the_bar(asked, bar, least):
    assert fewest(asked, bar) == least
    assert holds([True] * least + [False] * (asked - least), bar)
    assert not holds([True] * (least - 1) + [False] * (asked - least + 1), bar)


def test_a_study_at_its_bar_fails_once_in_twenty_at_most():
    # P(less than 4 of 5 at 0.9) = 1 - 5 x 0.9^4 x 0.1 - 0.9^5 = 0.081: three have to pass.
    assert fewest(5, 0.9) == 3


@pytest.mark.parametrize("asked", [0, 1])
def test_a_bar_that_can_t_fail_is_refused(asked):
    with pytest.raises(ValueError, match="too few"):
        holds([True] * asked, 0.9)

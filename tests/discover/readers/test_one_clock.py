"""Times of one sample agree to a twentieth of a step, whatever the step."""

import numpy as np
import pytest

from discover.readers.one_clock import off_clock


@pytest.mark.parametrize("count", [2, 4, 1001])
@pytest.mark.parametrize("step", [1e-6, 0.25, -3.0])
def test_a_time_is_on_the_clock_within_a_twentieth_of_its_step(count, step):
    clock = 7.0 + step * np.arange(count)
    for place in {0, 1, count - 1}:
        for share, off in ((0.049, []), (-0.049, []), (0.052, [place]), (-0.052, [place])):
            times = clock.copy()
            times[place] += share * step
            assert off_clock(clock, times).tolist() == off
    assert off_clock(clock, np.full(count, np.nan)).tolist() == list(range(count))


def test_a_single_time_is_itself_alone():
    assert off_clock(np.array([2.0]), np.array([2.0])).tolist() == []
    assert off_clock(np.array([2.0]), np.array([2.0 + 1e-9])).tolist() == [0]

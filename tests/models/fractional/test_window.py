"""The window against scipy's."""

import pytest
from numpy.testing import assert_allclose
from scipy.signal.windows import kaiser

from models.fractional.window import kaiser_window


@pytest.mark.parametrize("samples", [2, 3, 4, 5, 24, 25, 1000, 99_991])
def test_the_window_is_the_textbook_s_to_rounding(samples: int) -> None:
    assert_allclose(kaiser_window(samples, 18.0), kaiser(samples, 18.0), rtol=0.0, atol=1e-13)

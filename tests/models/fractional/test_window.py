"""Windows against numpy's and scipy's."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.signal.windows import kaiser

from models.fractional.window import hann_window, kaiser_window


@pytest.mark.parametrize("samples", [1, 2, 3, 4, 5, 24, 25, 1000, 99_991])
def test_windows_are_the_textbook_s_to_rounding(samples: int) -> None:
    assert_allclose(hann_window(samples), np.hanning(samples), rtol=0.0, atol=1e-14)
    assert hann_window(samples).min() >= 0.0
    if samples > 1:
        assert_allclose(kaiser_window(samples, 18.0), kaiser(samples, 18.0), rtol=0.0, atol=1e-13)

"""The lowest lines of records against those of the whole transform."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from models.fractional.lowest_lines import lowest_lines


@pytest.mark.parametrize(
    ("size", "count", "in_blocks"),
    [(60_000, 71, True), (60_000, 1500, True), (40_000, 999, True),  # even, many, almost half
     (40_000, 2001, False), (60_013, 50, False), (600, 5, False), (60_000, 1, True)],
)  # fmt: skip
def test_lines_are_those_of_the_whole_transform(size: int, count: int, in_blocks: bool) -> None:
    records = np.random.default_rng(size).standard_normal((2, size)) + 3.0
    records.flags.writeable = False
    wanted = lowest_lines(size, count)
    assert (wanted.block > 0) == in_blocks
    whole = np.fft.rfft(records)
    assert_allclose(wanted.of(records), whole[:, :count], rtol=0.0, atol=1e-14 * whole.real.max())
    whole[:, count:] = 0.0
    series = np.fft.irfft(whole, n=size)[:, : size // 3]
    assert_allclose(wanted.series(whole[:, :count], size // 3), series, rtol=0.0, atol=1e-13)


def test_a_wave_of_the_last_line_has_that_line_alone() -> None:
    wanted = lowest_lines(60_000, 100)
    lines = wanted.of(np.cos(2.0 * np.pi * 99 * np.arange(60_000) / 60_000 + 0.3))
    assert_allclose(lines[99], 30_000 * np.exp(0.3j), rtol=1e-13)
    assert np.abs(lines[:99]).max() < 1e-8

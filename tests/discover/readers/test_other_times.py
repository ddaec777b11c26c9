"""Columns of time beside the one that a record is read by."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from discover.readers import read_campaign
from tests.discover.readers.folder import DISPLACEMENT, FORCE, TIME, campaign, rows


@pytest.mark.parametrize(
    ("other", "told"),
    [(TIME, False), (TIME + 0.1, True), (1.5 * TIME, True), (TIME % 0.5, False), (-TIME, False)],
)
def test_another_time_of_a_table_is_told(tmp_path: Path, other: np.ndarray, told: bool) -> None:
    head = "time [s],force [kN],displacement [mm],Time B [s]\n"
    content = head + rows(TIME, FORCE, DISPLACEMENT, other)
    found = read_campaign(campaign(tmp_path / "c", content))
    text = (
        "column 'Time B [s]' is a time too, but another one: 'time [s]' is taken for all channels"
    )
    assert [(f.level, f.text) for f in found.findings] == [("note", text)] * told


@pytest.mark.parametrize("rate", [200.0, 100.0])
def test_a_rate_that_is_not_that_of_the_times_is_told(tmp_path: Path, rate: float) -> None:
    top = f"Sampling rate: {rate:g} Hz\n"
    content = top + "time [s],force [kN],displacement [mm]\n" + rows(TIME, FORCE, DISPLACEMENT)
    found = read_campaign(campaign(tmp_path / "c", content))
    text = (
        "the file states a sampling interval of 0.01 s, but its times are every 0.005 s: its times"
        " are taken"
    )
    assert [(f.level, f.text) for f in found.findings] == [("note", text)] * (rate == 100.0)

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

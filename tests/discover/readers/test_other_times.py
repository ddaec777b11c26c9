"""Columns of time beside the one that a record is read by."""

from __future__ import annotations

from pathlib import Path

import h5py
import numpy as np
import pytest

from discover.readers import read_campaign
from models.checks import InputError
from tests.discover.readers.folder import DISPLACEMENT, FORCE, TIME, campaign, rows


@pytest.mark.parametrize(
    ("other", "told"),
    [(TIME, False), (TIME + 0.1, True), (1.5 * TIME, True), (TIME % 0.5, False), (-TIME, False)],
)
def test_another_time_of_a_table_is_told(tmp_path: Path, other: np.ndarray, told: bool) -> None:
    head = "time [s],force [kN],Time B [s],displacement [mm]\n"
    content = head + rows(TIME, FORCE, other, DISPLACEMENT)
    found = read_campaign(campaign(tmp_path / "c", content))
    text = (
        "column 'Time B [s]' is a time too, but another one: 'time [s]' is taken for all channels"
    )
    assert [(f.level, f.text) for f in found.findings] == [("note", text)] * told


@pytest.mark.parametrize("late", [0.0, 0.1])
def test_times_of_groups_have_to_agree_whatever_they_are_called(
    tmp_path: Path, late: float
) -> None:
    with h5py.File(tmp_path / "a.h5", "w") as file:
        file["A/t"], file["A/force"] = TIME, 1e3 * FORCE
        file["B/t"], file["B/displacement"] = TIME + late, 1e-3 * DISPLACEMENT
    toml = '[columns]\ntime = "A/t"\n[units]\ntime = "s"\nforce = "N"\ndisplacement = "m"\n'
    (tmp_path / "campaign.toml").write_text(toml + '[[records]]\nfile = "a.h5"\n')
    if late:
        with pytest.raises(InputError, match="B/displacement must be sampled at the times of A/fo"):
            read_campaign(tmp_path)
        return
    (record,) = read_campaign(tmp_path).records
    np.testing.assert_allclose(record.force, 1e3 * FORCE, atol=1e-9)

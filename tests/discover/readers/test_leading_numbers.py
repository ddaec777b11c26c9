"""Numbers above columns without names that are as wide as the samples and none."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import openpyxl
import pytest

from discover.readers import read_campaign
from tests.discover.readers.folder import DISPLACEMENT, FORCE, TIME, campaign, rows

TOML = """[columns]
time = "column 1"
displacement = "column 2"
force = "column 3"
[units]
time = "s"
displacement = "mm"
force = "kN"
[[records]]
file = "{}"
"""


def check(folder: Path, *told: str) -> None:
    found = read_campaign(folder)
    np.testing.assert_allclose(found.records[0].time, TIME, atol=1e-9)
    np.testing.assert_allclose(found.records[0].force, 1e3 * FORCE, atol=1e-5)
    assert [f.text for f in found.findings] == [
        f"{text} is no sample, as the time begins below it" for text in told
    ]


@pytest.mark.parametrize("sep", ["\t", ";", " "])
@pytest.mark.parametrize("above", [[], ["200 2.5 1"], ["-3 500 12.5", "1 2 3"], ["0 1 0"]])
def test_of_a_text(tmp_path: Path, above: list[str], sep: str) -> None:
    top = [line.replace(" ", sep) for line in above]
    content = "".join(line + "\n" for line in top) + rows(TIME, DISPLACEMENT, FORCE, sep=sep)
    folder = campaign(tmp_path / "c", content, toml=TOML.format("a.txt"), file="a.txt")
    check(folder, *(f"line {i} is left out: {line!r}" for i, line in enumerate(top, start=1)))


def test_of_a_sheet(tmp_path: Path) -> None:
    book = openpyxl.Workbook()
    sheet = book.active
    sheet.append([200, 2.5, 1])
    for row in zip(TIME, DISPLACEMENT, FORCE, strict=True):
        sheet.append([float(value) for value in row])
    book.save(tmp_path / "a.xlsx")
    (tmp_path / "campaign.toml").write_text(TOML.format("a.xlsx"))
    check(tmp_path, "row 1 is left out: '200 2.5 1'")


def test_where_no_column_is_time_every_row_is_a_sample(tmp_path: Path) -> None:
    toml = (
        TOML.replace('time = "column 1"\n', "").replace("column 2", "column 1")
        .replace("column 3", "column 2").replace('time = "s"\n', "").format("a.txt")
    )  # fmt: skip
    content = rows(DISPLACEMENT, FORCE, sep="\t")
    folder = campaign(
        tmp_path / "c", content, toml=toml + 'sampling_rate = "200 Hz"\n', file="a.txt"
    )
    found = read_campaign(folder)
    assert found.records[0].force.size == TIME.size
    assert [f.text for f in found.findings] == [
        "no time column is read: the times are made of the sampling rate"
    ]

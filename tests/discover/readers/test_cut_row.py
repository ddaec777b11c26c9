"""A last row that was not written to its end is left out of every kind of text, and told."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from discover.readers import long_record, long_text, read_campaign
from tests.discover.readers.folder import DISPLACEMENT, FORCE, HEADER, TIME, campaign

LVM = """LabVIEW Measurement
Separator\tTab
Decimal_Separator\t.
X_Columns\tOne
***End_of_Header***
Channels\t2
Y_Unit_Label\tmm\tkN
***End_of_Header***
X_Value\tdisplacement\tforce\tComment
"""


def lines(sep: str = ",") -> str:
    columns = (TIME, DISPLACEMENT, FORCE)
    return "".join(sep.join(f"{v:.9f}" for v in row) + "\n" for row in zip(*columns, strict=True))


def check(folder: Path, line: int, text: str) -> None:
    """The record is whole, and the line is told."""
    found = read_campaign(folder)
    np.testing.assert_allclose(found.records[0].force, 1e3 * FORCE, atol=1e-6)
    np.testing.assert_allclose(found.records[0].displacement, 1e-3 * DISPLACEMENT, atol=1e-9)
    told = [f.text for f in found.findings if "whole row" in f.text]
    assert told == [
        f"the last line, {line}, is left out: {text!r} is no whole row, as where the instrument"
        " was stopped; the rest is read"
    ]


@pytest.mark.parametrize("end", ["10.000000000", "10.0\t1.5\n", "10.0\t0.1\t-", "10.0\t0.1\t0.12"])
def test_of_a_labview_file(tmp_path: Path, end: str) -> None:
    toml = '[[records]]\nfile = "a.lvm"\n'
    folder = campaign(tmp_path / "c", LVM + lines("\t") + end, toml=toml, file="a.lvm")
    check(folder, TIME.size + 10, end.rstrip("\n"))


@pytest.mark.parametrize("break_", ["\n", "\r\n"])
@pytest.mark.parametrize("end", ["10.0", "10.0,0.5\n", "10.0,0.1,-", "10.0,0.1,0.12"])
def test_of_a_text_that_is_read_in_pieces(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, end: str, break_: str
) -> None:
    for module in (long_record, long_text):
        monkeypatch.setattr(module, "LONG", 500)
    monkeypatch.setattr(long_record, "FIRST", 1000)
    monkeypatch.setattr(long_text, "_HEAD", 20_000)
    content = (HEADER + "\n" + lines() + end).replace("\n", break_)
    found = read_campaign(campaign(tmp_path / "c", content.encode()))
    (record,) = found.records
    assert record.long is not None
    assert record.long.samples == TIME.size
    force = np.concatenate([piece.force for piece in record.long.pieces()])
    np.testing.assert_allclose(force, 1e3 * FORCE, atol=1e-6)
    told = f"the last line, {TIME.size + 2}, is left out: {end.rstrip()!r} is no whole row"
    assert [f.text for f in found.findings if f.text.startswith(told)]


def test_a_last_number_with_fewer_digits_than_all_others_is_cut(tmp_path: Path) -> None:
    folder = campaign(tmp_path / "c", HEADER + "\n" + lines() + "10.000000000,0.100000000,0.1")
    check(folder, TIME.size + 2, "10.000000000,0.100000000,0.1")


def test_a_last_number_that_is_as_short_as_others_is_whole(tmp_path: Path) -> None:
    columns = zip(TIME, DISPLACEMENT, FORCE, strict=True)
    text = "".join(",".join(f"{v:g}" for v in row) + "\n" for row in columns)
    found = read_campaign(campaign(tmp_path / "c", HEADER + "\n" + text + "10,0.1,0.1"))
    assert found.records[0].force.size == TIME.size + 1
    assert not [f.text for f in found.findings if "whole row" in f.text]

"""All that is wrong with a campaign is told in one run, one line each, of what can be read."""

from __future__ import annotations

import time
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from discover.cli import main
from discover.readers import read_campaign
from models.checks import InputError, InputErrors, nearest
from tests.discover.readers.folder import (
    DISPLACEMENT,
    FORCE,
    HEADER,
    ONE,
    PLAIN,
    TIME,
    campaign,
    rows,
)


def test_every_bad_file_is_told_and_what_to_do(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = campaign(tmp_path / "c")
    (folder / "b.csv").write_text(PLAIN.replace("force", "forse"))
    (folder / "c.csv").write_text("")
    toml = "".join(ONE.replace("a.csv", f"{name}.csv") for name in "abcd")
    (folder / "campaign.toml").write_text(toml)
    with pytest.raises(InputErrors) as caught:
        read_campaign(folder)
    assert len(caught.value.errors) == 3
    assert main(["check", str(folder), "-o", str(tmp_path / "out")]) == 2
    out, err = capsys.readouterr()
    lines = err.splitlines()
    assert out == ""
    assert [line.split(":")[1].strip() for line in lines[:2]] == ["b.csv", "c.csv"]
    assert "file 'd.csv' must be in the campaign folder" in lines[2]
    assert lines[3] == (
        "inerter: 3 of 4 records can't be read: mend them, or take their [[records]] out of"
        " campaign.toml"
    )


def test_every_test_of_a_file_counts_as_a_record(tmp_path: Path) -> None:
    one = {"time [s]": TIME, "weg [mm]": DISPLACEMENT, "force [kN]": FORCE}
    with pd.ExcelWriter(tmp_path / "a.xlsx") as book:
        for sheet in ("one", "two"):
            pd.DataFrame(one).to_excel(book, sheet_name=sheet, index=False)
    (tmp_path / "campaign.toml").write_text('[[records]]\nfile = "a.xlsx"\nsheet = "*"\n')
    with pytest.raises(InputErrors, match="2 of 2 records can't be read"):
        read_campaign(tmp_path)


def test_thousands_of_missing_files_are_told_soon(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """In a few times what it takes to look for names like theirs, on whatever machine."""
    names = [f"run-{i:05}.csv" for i in range(20000)]
    there = [f"test-{index:05}.csv" for index in range(50)]
    folder = campaign(tmp_path / "c", toml="".join(f'[[records]]\nfile = "{n}"\n' for n in names))
    for name in there:
        (folder / name).write_text("")
    began = time.process_time()
    assert any([nearest(name, there) for name in names[:2000]])
    looked = time.process_time()
    assert main(["check", str(folder), "-o", str(tmp_path / "out")]) == 2
    ended = time.process_time()
    lines = capsys.readouterr().err.splitlines()
    assert len(lines) == 21
    assert "20000 of 20000 records can't be read (19980 more than are listed)" in lines[-1]
    assert ended - looked < 60.0 * (looked - began)  # of a tenth; 31 and over 40 were seen


@pytest.mark.parametrize(
    "header",
    ["time" + " " * 50000 + "s", "[" * 30000, "(" * 30000, '"' + "x" * 200000, "x\x1b[2J\x07"],
    ids=["blanks", "brackets", "parentheses", "field", "escapes"],
)
def test_headers_of_any_kind_are_refused_soon_in_a_line(tmp_path: Path, header: str) -> None:
    content = f"{header},displacement [mm],force [kN]\n" + rows(TIME, DISPLACEMENT, FORCE)
    began = time.process_time()
    with pytest.raises(InputError) as caught:
        read_campaign(campaign(tmp_path / "c", content))
    assert time.process_time() - began < 5.0
    assert len(str(caught.value)) < 2000
    assert str(caught.value).isprintable()


def test_parquet_with_counts_of_nanoseconds(tmp_path: Path) -> None:
    stamps = 1_700_000_000_000_000_123 + np.arange(TIME.size) * 5_000_000
    for column in (stamps, pd.to_datetime(stamps)):
        name = "time [ns]" if column is stamps else "time"
        frame = pd.DataFrame({name: column, "displacement [mm]": DISPLACEMENT, "force [kN]": FORCE})
        folder = campaign(tmp_path / "c", toml=ONE.replace("csv", "parquet"))
        frame.to_parquet(folder / "a.parquet")
        found = read_campaign(folder)
        np.testing.assert_allclose(
            found.records[0].time - found.records[0].time[0], TIME, atol=1e-9
        )
        assert found.findings == ()


def test_parquet_with_a_column_twice(tmp_path: Path) -> None:
    import pyarrow as pa
    import pyarrow.parquet as parquet

    names = ["time [s]", "displacement [mm]", "force [kN]"]
    columns = [pa.array(TIME), pa.array(DISPLACEMENT), pa.array(FORCE)]
    folder = campaign(tmp_path / "c", toml=ONE.replace("csv", "parquet"))
    twice = pa.table([*columns, pa.array(2.0 * FORCE)], names=[*names, "force [kN]"])
    parquet.write_table(twice, folder / "a.parquet")
    with pytest.raises(InputError, match=r"force must be one column, got 'force \[kN\]', 'force"):
        read_campaign(folder)
    other = pa.table([columns[0], *columns, pa.array(FORCE)], names=["x", *names, "x"])
    parquet.write_table(other, folder / "a.parquet")
    np.testing.assert_allclose(read_campaign(folder).records[0].force, 1e3 * FORCE)


def test_cells_of_structures_in_a_mat_file(tmp_path: Path) -> None:
    from scipy.io import savemat

    runs = np.empty(2, dtype=object)
    for index in range(2):
        runs[index] = {"time": TIME, "displacement": DISPLACEMENT, "force": (index + 1) * FORCE}
    units = '[units]\ntime = "s"\ndisplacement = "mm"\nforce = "kN"\n'
    folder = campaign(tmp_path / "c", toml=units + '[[records]]\nfile = "a.mat"\ngroup = "runs*"\n')
    savemat(folder / "a.mat", {"runs": runs, "mixed": np.array([1, "x"], dtype=object)})
    first, second = read_campaign(folder).records
    assert (first.file, second.file) == ("a.mat [runs(1)]", "a.mat [runs(2)]")
    np.testing.assert_allclose(second.force, 2.0 * first.force)


@pytest.mark.parametrize(
    ("column", "factor"), [("x", 1e-200), ("F", 1e-200), ("t", 1e-300), ("t", 1e28), ("x", 1e200)]
)
def test_sizes_that_no_number_holds_are_refused(tmp_path: Path, column: str, factor: float) -> None:
    scaled = [v * (factor if c == column else 1.0) for c, v in
              zip("txF", (TIME, DISPLACEMENT, FORCE), strict=True)]  # fmt: skip
    content = HEADER + "\n" + rows(*scaled)
    with pytest.raises(InputError, match="must be") as caught:
        read_campaign(campaign(tmp_path / "c", content))
    assert "got 0 throughout" not in str(caught.value)  # they do vary


@pytest.mark.parametrize(
    "line",
    ['amplitude = "1e-200 mm"', 'frequency = "1e200 Hz"', "frequency = " + "9" * 5000,
     "held_out = 0x" + "f" * 5000, 'sampling_rate = "0 Hz"', 'file = "x\\u001b[2J.csv"',
     'frequency = "1e-300 Hz"'],
)  # fmt: skip
def test_values_of_any_size_in_the_toml_are_one_line(tmp_path: Path, line: str) -> None:
    toml = f"[[records]]\n{line}\n" + ("" if "file" in line else 'file = "a.csv"\n')
    with pytest.raises(InputError) as caught:
        read_campaign(campaign(tmp_path / "c", toml=toml))
    assert str(caught.value).isprintable()
    assert len(str(caught.value)) < 2000

"""Tests that stand below each other in one table."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from scipy.io import savemat

from discover.cli.app import main
from discover.readers import read_campaign
from models.checks import InputError

TIME = np.arange(1200) / 200.0
STROKE = 8.0 * np.sin(2 * np.pi * 1.5 * TIME)  # mm
LOAD = 0.6 * np.cos(2 * np.pi * 1.5 * TIME)  # kN
FACTORS = (1.0, 0.5, 2.0)


def table(*, times: str = "again", count: str = "") -> dict[str, np.ndarray]:
    """Three tests; the time begins again, or goes on after a rest, or there is none."""
    later = 20.0 if times == "later" else 0.0
    columns = {
        "time [s]": np.concatenate([TIME + later * i for i in range(3)]),
        "displacement [mm]": np.concatenate([f * STROKE for f in FACTORS]),
        "force [kN]": np.concatenate([f * LOAD for f in FACTORS]),
    }
    if times == "none":
        del columns["time [s]"]
    if count:
        columns = {count: np.repeat([3.0, 4.0, 7.0], TIME.size), **columns}
    return columns


def write(folder: Path, columns: dict[str, np.ndarray], name: str, top: str = "") -> None:
    folder.mkdir(exist_ok=True)
    frame = pd.DataFrame(columns)
    if name.endswith(".csv"):
        (folder / name).write_text(top + frame.to_csv(index=False, float_format="%.9g"))
    elif name.endswith(".xlsx"):
        frame.to_excel(folder / name, sheet_name="Log", index=False)
    elif name.endswith(".mat"):
        plain = {key.split(" [")[0]: values for key, values in columns.items()}
        savemat(folder / name, {"run": plain, "offset": np.arange(3.0)})
    else:
        frame.to_parquet(folder / name)


def check(folder: Path, *names: str) -> None:
    found = read_campaign(folder)
    assert [record.file for record in found.records] == list(names)
    for record, factor in zip(found.records, FACTORS, strict=True):
        np.testing.assert_allclose(record.time - record.time[0], TIME, atol=1e-9)
        np.testing.assert_allclose(record.displacement, 1e-3 * factor * STROKE, atol=1e-8)
        np.testing.assert_allclose(record.force, 1e3 * factor * LOAD, atol=1e-5)


@pytest.mark.parametrize(
    ("name", "times", "count", "top", "parts"),
    [
        ("a.csv", "again", "", "", "test 1,test 2,test 3"),
        ("a.csv", "again", "Cycle", "", "Cycle 3,Cycle 4,Cycle 7"),
        ("a.csv", "later", "Test No.", "", "Test No. 3,Test No. 4,Test No. 7"),
        ("a.csv", "none", "run", "Sampling rate: 200 Hz\n", "run 3,run 4,run 7"),
        ("a.parquet", "again", "block", "", "block 3,block 4,block 7"),
        ("a.xlsx", "again", "", "", "Log test 1,Log test 2,Log test 3"),
    ],
)
def test_init_drafts_a_record_of_each(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str, times: str, count: str, top: str,
    parts: str,
) -> None:  # fmt: skip
    monkeypatch.chdir(tmp_path)
    write(tmp_path / "lab", table(times=times, count=count), name, top)
    assert main(["init", "lab"]) == 0
    check(tmp_path / "lab", *(f"{name} [{part}]" for part in parts.split(",")))


def test_without_names_too(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "lab").mkdir()
    columns = np.column_stack(list(table().values()))
    np.savetxt(tmp_path / "lab" / "a.txt", columns, fmt="%.9g", delimiter="\t")
    named = ["--column", "displacement=column 2", "--column", "force=column 3"]
    assert main(["init", "lab", "--unit", "force=kN", *named]) == 0
    check(tmp_path / "lab", *(f"a.txt [test {i}]" for i in (1, 2, 3)))


def test_a_rate_in_place_of_the_times(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    write(tmp_path / "lab", table(times="none", count="Versuch"), "a.csv")
    assert main(["init", "lab", "--sampling-rate", "200 Hz"]) == 0
    check(tmp_path / "lab", *(f"a.csv [Versuch {i}]" for i in (3, 4, 7)))


@pytest.mark.parametrize("part", ['"*"', '"test *"'])
@pytest.mark.parametrize("name", ["a.csv", "a.mat"])
def test_a_pattern_takes_all_of_them(tmp_path: Path, name: str, part: str) -> None:
    write(tmp_path, table(), name)
    inside = "run " if name == "a.mat" else ""
    pattern = part.replace("test", f"{inside}test")
    units = '[units]\ndisplacement = "mm"\nforce = "kN"\n' if inside else ""
    toml = f'{units}[[records]]\nfile = "{name}"\ngroup = {pattern}\n'
    (tmp_path / "campaign.toml").write_text(toml)
    check(tmp_path, *(f"{name} [{inside}test {i}]" for i in (1, 2, 3)))


def test_one_is_taken_by_its_number_and_a_missing_one_told(tmp_path: Path) -> None:
    write(tmp_path, table(count="Cycle"), "a.csv")
    toml = '[[records]]\nfile = "a.csv"\ngroup = {}\n'
    (tmp_path / "campaign.toml").write_text(toml.format(2))
    (record,) = read_campaign(tmp_path).records
    assert record.file == "a.csv [Cycle 4]"
    np.testing.assert_allclose(record.force, 500.0 * LOAD, atol=1e-5)
    for part, told in (
        ('"Cycle 5"', "one of 'Cycle 3', 'Cycle 4', 'Cycle 7'"),
        ("4", "from 1 to 3"),
    ):
        (tmp_path / "campaign.toml").write_text(toml.format(part))
        with pytest.raises(InputError, match=f"group must be {told}"):
            read_campaign(tmp_path)


def test_without_a_group_the_error_says_what_to_do(tmp_path: Path) -> None:
    write(tmp_path, table(), "a.csv")
    (tmp_path / "campaign.toml").write_text('[[records]]\nfile = "a.csv"\n')
    with pytest.raises(
        InputError, match=r'line 1202: time .* again, .*: `group = "\*"` in \[\[rec'
    ):
        read_campaign(tmp_path)


def test_times_of_a_rate_do_not_run_through_several_tests(tmp_path: Path) -> None:
    write(tmp_path, table(times="none", count="Run"), "a.csv", "Sampling rate: 200 Hz\n")
    toml = '[[records]]\nfile = "a.csv"\n'
    for more in ("", 'sampling_rate = "200 Hz"\n'):
        (tmp_path / "campaign.toml").write_text(toml + more)
        with pytest.raises(InputError, match=r"group must be given .* 'Run 3', 'Run 4', 'Run"):
            read_campaign(tmp_path)
    (tmp_path / "campaign.toml").write_text(toml + 'range = ": 5.996 s"\n')
    (record,) = read_campaign(tmp_path).records
    np.testing.assert_allclose(record.force, 1e3 * LOAD, atol=1e-5)


def test_columns_of_another_length_are_refused(tmp_path: Path) -> None:
    columns = {key.split(" [")[0]: values for key, values in table().items()}
    savemat(tmp_path / "a.mat", {**columns, "force": columns["force"][:-1]})
    (tmp_path / "campaign.toml").write_text('[[records]]\nfile = "a.mat"\ngroup = "test 3"\n')
    with pytest.raises(InputError, match=r"force must be of the length of time \(3600\), got 3599"):
        read_campaign(tmp_path)


def test_a_bad_value_is_told_with_its_line(tmp_path: Path) -> None:
    write(tmp_path, table(), "a.csv")
    lines = (tmp_path / "a.csv").read_text().splitlines()
    lines[1300] = lines[1300].rpartition(",")[0] + ",OVER"
    (tmp_path / "a.csv").write_text("\n".join(lines) + "\n")
    (tmp_path / "campaign.toml").write_text('[[records]]\nfile = "a.csv"\ngroup = "test 2"\n')
    with pytest.raises(InputError, match=r"a.csv \[test 2\] line 1301: force .* got 'OVER'"):
        read_campaign(tmp_path)


@pytest.mark.parametrize("header", ["cycle", "Test", "Sample"])
def test_a_count_beside_time_that_goes_on_parts_nothing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, header: str
) -> None:
    monkeypatch.chdir(tmp_path)
    count = np.arange(TIME.size) if header == "Sample" else 1.0 + np.floor(1.5 * TIME)
    columns = {
        header: count, "time [s]": TIME, "displacement [mm]": STROKE, "force [kN]": LOAD,
    }  # fmt: skip
    write(tmp_path / "lab", columns, "a.csv")
    assert main(["init", "lab"]) == 0
    (record,) = read_campaign(tmp_path / "lab").records
    assert record.file == "a.csv"
    assert record.force.size == TIME.size

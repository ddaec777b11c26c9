"""Tests whose channels lie in files of their own."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from discover.cli.app import main
from discover.readers import read_campaign
from discover.readers.left_out import left_out_files
from models.checks import InputError
from tests.discover.readers.folder import DISPLACEMENT, FORCE, TIME, rows

BOTH = '[[records]]\nfile = ["a_force.csv", "a_stroke.csv"]\n'
FACTORS = (1.0, 0.5, 2.0)


def text(header: str, *columns: np.ndarray) -> str:
    return (header + "\n" if header else "") + rows(*columns)


def written(folder: Path, force: str, stroke: str, toml: str = BOTH) -> Path:
    (folder / "a_force.csv").write_text(force)
    (folder / "a_stroke.csv").write_text(stroke)
    (folder / "campaign.toml").write_text(toml)
    return folder


def check(folder: Path, *factors: float) -> None:
    found = read_campaign(folder)
    assert len(found.records) == len(factors)
    for record, factor in zip(found.records, factors, strict=True):
        np.testing.assert_allclose(record.time, TIME, atol=1e-9)
        np.testing.assert_allclose(record.force, factor * 1e3 * FORCE, atol=1e-5)
        np.testing.assert_allclose(record.displacement, factor * 1e-3 * DISPLACEMENT, atol=1e-10)


FORCE_FILE = text("time [s],force [kN]", TIME, FORCE)
STROKE_FILE = text("time [s],displacement [mm]", TIME, DISPLACEMENT)


def test_channels_of_two_files_are_one_record(tmp_path: Path) -> None:
    folder = written(tmp_path, FORCE_FILE, STROKE_FILE)
    check(folder, 1.0)
    found = read_campaign(folder)
    assert found.records[0].file == "a_force.csv + a_stroke.csv"
    assert found.findings == ()
    assert left_out_files(folder) == []
    before = found.content_hash
    written(tmp_path, FORCE_FILE, STROKE_FILE + "10,1\n")
    assert read_campaign(folder).content_hash != before


@pytest.mark.parametrize(
    ("force", "stroke", "more"),
    [
        ("Zeit [s],Kraft [kN]", "ms [ms],displacement [mm]", 'channel = "Kraft"\n'),
        ("time [s],value [kN]", "time [s],value [mm]", ""),
        ("time [s],value [kN]", "time [s],value [mm]", 'channel = "force/value"\n'),
    ],
)
def test_headers_may_be_the_same_or_not(tmp_path: Path, force: str, stroke: str, more: str) -> None:
    toml = '[columns]\ntime = "Zeit"\n' if "Zeit" in force else ""
    times = 1e3 * TIME if "ms" in stroke else TIME
    check(
        written(tmp_path, text(force, TIME, FORCE), text(stroke, times, DISPLACEMENT),
                toml + BOTH + more), 1.0,
    )  # fmt: skip


def test_one_file_may_have_the_times_alone(tmp_path: Path) -> None:
    (tmp_path / "a_t.csv").write_text(text("time [s]", TIME))
    toml = BOTH.replace('["', '["a_t.csv", "')
    force, stroke = text("force [kN]", FORCE), text("displacement [mm]", DISPLACEMENT)
    check(written(tmp_path, force, stroke, toml), 1.0)
    short = text("force [kN]", FORCE[:-1])
    with pytest.raises(InputError, match=r"samples must be as many in every file, .* 1999 in a_f"):
        read_campaign(written(tmp_path, short, stroke, toml))


def test_one_column_and_a_rate_in_each(tmp_path: Path) -> None:
    rate = "Sampling rate: 200 Hz\n"
    force, stroke = (
        rate + text(header, values)
        for header, values in (("force [kN]", FORCE), ("displacement [mm]", DISPLACEMENT))
    )
    check(written(tmp_path, force, stroke), 1.0)
    other = stroke.replace("200 Hz", "100 Hz")
    with pytest.raises(
        InputError, match=r"time must be the same in every file of the test, as 0.0"
    ):
        read_campaign(written(tmp_path, force, other))


def test_samples_that_one_file_lacks_are_left_out_and_told(tmp_path: Path) -> None:
    more = np.r_[TIME, 10.0, 10.005]
    stroke = text("time [s],displacement [mm]", more, np.r_[DISPLACEMENT, 1.0, 1.0])
    folder = written(tmp_path, FORCE_FILE, stroke)
    check(folder, 1.0)
    (finding,) = read_campaign(folder).findings
    assert finding.text.startswith("the last 2 samples of a_stroke.csv are left out")


def test_times_that_do_not_agree_are_refused(tmp_path: Path) -> None:
    later = text("time [s],displacement [mm]", TIME + 0.001, DISPLACEMENT)
    message = (
        r"time must be the same .*, as 0 s in a_force.csv, got 0.001 s in sample 1 of a_stroke"
    )
    with pytest.raises(InputError, match=message):
        read_campaign(written(tmp_path, FORCE_FILE, later))


def test_a_bad_value_is_told_with_its_line(tmp_path: Path) -> None:
    lines = STROKE_FILE.splitlines()
    lines[100] = lines[100].split(",")[0] + ",OVER"
    stroke = "\n".join(["by Meier", *lines]) + "\n"
    message = r"line 101 of a_force.csv, line 102 of a_stroke.csv: displacement .* got 'OVER'"
    with pytest.raises(InputError, match=message):
        read_campaign(written(tmp_path, FORCE_FILE, stroke))


@pytest.mark.parametrize(
    ("files", "message"),
    [
        ('["a_force.csv", "a_force.csv"]', "file must be each once, got 'a_force.csv' again"),
        ('["a_force.csv", "*.csv"]', r"must be a name, in a list .* got a pattern"),
        ('["a_force.csv", 3]', "file must be a file's name, or a list"),
        ("[]", "file must be a file's name, or a list"),
        ('["a_force.csv", "b.csv"]', r"file 'b.csv' must be in the campaign folder"),
    ],
)
def test_lists_that_are_wrong(tmp_path: Path, files: str, message: str) -> None:
    with pytest.raises(InputError, match=message):
        read_campaign(written(tmp_path, FORCE_FILE, STROKE_FILE, f"[[records]]\nfile = {files}\n"))


@pytest.mark.parametrize(
    ("force", "stroke", "headers"),
    [
        ("test{}_force.csv", "test{}_disp.csv", ("t [s],F [kN]", "t [s],x [mm]")),
        ("T{}_ch1.csv", "T{}_ch2.csv", ("t [s],F [kN]", "t [s],x [mm]")),
        ("Load {}.txt", "LVDT {}.txt", ("t [s],value [kN]", "t [s],value [mm]")),
        ("load/{}.txt", "stroke/{}.txt", ("t [s],ch 1 [kN]", "t [s],ch 2 [mm]")),
    ],
)
def test_init_drafts_them(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, force: str, stroke: str,
    headers: tuple[str, str],
) -> None:  # fmt: skip
    monkeypatch.chdir(tmp_path)
    for number, factor in enumerate(FACTORS, start=1):
        for name, header, values in zip(
            (force, stroke), headers, (factor * FORCE, factor * DISPLACEMENT), strict=True
        ):
            path = tmp_path / "lab" / name.format(number)
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text(header, TIME, values))
    assert main(["init", "lab"]) == 0
    check(tmp_path / "lab", *FACTORS)


def test_init_leaves_apart_what_is_not_plain(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "test1_force.csv").write_text(FORCE_FILE)
    (tmp_path / "test2_disp.csv").write_text(STROKE_FILE)
    assert main(["init", "."]) == 2
    assert "test1_force.csv: no column for displacement" in capsys.readouterr().err
    (tmp_path / "test2_disp.csv").rename(tmp_path / "test2.csv")
    (tmp_path / "test1_force.csv").rename(tmp_path / "test1.csv")
    assert main(["init", "."]) == 2
    assert "test1.csv: no column for displacement" in capsys.readouterr().err
    (tmp_path / "test1.csv").rename(tmp_path / "test1_force.csv")
    later = text("time [s],displacement [mm]", TIME + 0.001, DISPLACEMENT)
    (tmp_path / "test1_disp.csv").write_text(later)
    assert main(["init", "."]) == 2
    told = capsys.readouterr().err
    assert "test1_disp.csv + test1_force.csv: time must be the same in every file" in told


@pytest.mark.parametrize(
    "names",
    [
        ("Run{}LoadCell", "Run{}LVDT"),
        ("test_0{}_load_cell_A", "test_0{}_stroke"),
        ("20240517_loadcell_run{}", "20240517_run{}_displacement"),
    ],
)
def test_init_joins_names_that_differ_in_several_words(
    tmp_path: Path, names: tuple[str, str]
) -> None:
    for run, factor in enumerate(FACTORS, start=1):
        for name, own in zip(names, (FORCE, 10.0 * DISPLACEMENT), strict=True):
            content = text("time [s],value", TIME, factor * own)
            (tmp_path / f"{name.format(run)}.csv").write_text(content)
    assert main(["init", str(tmp_path), "--unit", "force=kN", "--unit", "displacement=0.1 mm"]) == 0
    check(tmp_path, *FACTORS)


def test_init_does_not_join_the_channels_of_two_tests(tmp_path: Path) -> None:
    (tmp_path / "Run1_force.csv").write_text(FORCE_FILE)
    (tmp_path / "Run2_stroke.csv").write_text(STROKE_FILE)
    assert main(["init", str(tmp_path)]) == 2

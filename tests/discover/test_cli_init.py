"""``inerter init``: from a folder of files to a campaign that ``check`` passes."""

from __future__ import annotations

import json
import os
import re
import shlex
import shutil
import tomllib
from pathlib import Path

import numpy as np
import pytest

from discover.cli import main
from discover.data_check import check_campaign
from discover.readers import read_campaign
from models.checks import InputError
from tests.discover.readers import instruments

REAL = Path(__file__).parents[3] / "shared" / "real-data"
TIME = np.arange(2400) / 400.0


def _test(frequency: float, stroke: float = 8e-3) -> tuple[np.ndarray, np.ndarray]:
    """Displacement, m, and force, N, of 120 kg and 900 N s/m, with the noise of a load cell."""
    w = 2 * np.pi * frequency
    x = stroke * np.sin(w * TIME)
    force = -120.0 * w**2 * x + 900.0 * stroke * w * np.cos(w * TIME)
    rng = np.random.default_rng(int(10 * frequency))
    return x, force + 0.01 * force.std() * rng.standard_normal(TIME.size)


def _csv(path: Path, header: str, frequency: float, *, timed: bool = True) -> None:
    x, force = _test(frequency)
    columns = [TIME, 1e3 * x, 1e-3 * force] if timed else [1e3 * x, 1e-3 * force]
    np.savetxt(
        path, np.column_stack(columns), delimiter=";", header=header, comments="", fmt="%.9g"
    )


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, undrawn: None) -> Path:
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_a_folder_of_tdms_xlsx_and_lvm(here: Path, capsys: pytest.CaptureFixture[str]) -> None:
    from tests.discover.readers.test_instruments import _lvm

    (here / "lab").mkdir()
    (here / "lab" / "monday.tdms").write_bytes(instruments.tdms({"run 1": 1.0, "run 2": 0.5}))
    instruments.workbook(here / "lab" / "tests.xlsx")
    (here / "lab" / "old.lvm").write_text(_lvm("One", 0.7))
    (here / "lab" / "notes.txt").write_text("nothing of interest\n")
    assert main(["init", "lab", "-o", "page"]) == 0
    out, err = capsys.readouterr()
    assert err == ""
    assert out.splitlines()[-2] == "Next: inerter check lab"
    assert "Left out: notes.txt: " in out
    found = read_campaign("lab")
    assert len(found.records) == 5
    assert len(found.held_out) == 1
    speeds = [np.ptp(r.displacement) for r in found.records]
    assert speeds == pytest.approx([8e-3 * 2 * f for f in (1.0, 0.5, 0.7, 1.0, 0.5)], rel=1e-3)
    page = (here / "page" / "report.html").read_text()
    assert page.count("<svg") == 5
    document = json.loads((here / "page" / "init.json").read_text())
    assert document["schema"] == "inerter.init/1"
    assert {r["columns"]["force"]["unit"] for r in document["records"]} == {"kN"}
    assert main(["check", "lab", "-o", "checked"]) == 0


def test_instruments_of_one_folder_may_write_different_units(
    here: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    import h5py
    from scipy.io import savemat

    (here / "lab").mkdir()
    (here / "lab" / "monday.tdms").write_bytes(instruments.tdms({"run 1": 1.0}))  # mm and kN
    x, force = _test(0.7)
    with h5py.File(here / "lab" / "tuesday.h5", "w") as file:
        for name, values, unit in (("time", TIME, "s"), ("disp", x, "m"), ("load", force, "N")):
            file.create_dataset(name, data=values).attrs["units"] = unit
    x, force = _test(0.5)
    savemat(here / "lab" / "wednesday.mat", {"time": TIME, "travel": x, "load": force})
    assert main(["init", "lab", "-o", "page"]) == 0
    assert "Left out" not in capsys.readouterr().out
    monday, *others = read_campaign("lab").records
    assert np.ptp(monday.displacement) == pytest.approx(16e-3, rel=1e-3)
    assert np.ptp(monday.force) == pytest.approx(1200.0, rel=1e-3)
    for record, frequency in zip(others, (0.7, 0.5), strict=True):
        x, force = _test(frequency)
        np.testing.assert_allclose(record.displacement, x, rtol=1e-6, atol=1e-12)
        np.testing.assert_allclose(record.force, force, rtol=1e-6, atol=1e-9)
    assert main(["check", "lab", "-o", "checked"]) == 0


@pytest.mark.parametrize(
    ("header", "sure"),
    [
        ("Zeit [s];Weg [mm];Kraft [kN]", "sure"),
        ("Temps (s);Déplacement (mm);Effort (kN)", "sure"),
        ("t;Axial Displacement;Axial Force\ns;mm;kN", "sure"),
        ("Elapsed Time;LVDT 1;Load cell\nSec;mm;kN", "sure"),
        ("Zeit [s];Signal 1 [mm];Signal 2 [kN]", "likely"),
    ],
)
def test_columns_as_laboratories_call_them(here: Path, header: str, sure: str) -> None:
    for frequency in (1.0, 2.0, 3.0):
        _csv(here / f"run-{frequency}.csv", header, frequency)
    assert main(["init", "."]) == 0
    document = json.loads((here / "inerter-out" / f"init-{here.name}" / "init.json").read_text())
    assert document["doubts"] == []
    assert {r["columns"]["force"]["sure"] for r in document["records"]} == {sure}
    found = read_campaign(here)
    x, force = _test(1.0)
    np.testing.assert_allclose(found.records[0].displacement, x, atol=1e-9)
    np.testing.assert_allclose(found.records[0].force, force, rtol=1e-6, atol=1e-5)
    assert [r.held_out for r in found.records] == [False, True, False]
    assert found.findings == ()


def test_a_command_is_no_measurement(here: Path) -> None:
    x, force = _test(2.0)
    table = np.column_stack([TIME, 1e3 * x + 0.5, 1e3 * x, 1e-3 * force])
    header = "Time (s),Displacement command (mm),Displacement (mm),Force (kN)"
    np.savetxt(here / "a.csv", table, delimiter=",", header=header, comments="", fmt="%.9g")
    assert main(["init", "a.csv"]) == 0
    np.testing.assert_allclose(read_campaign(here).records[0].displacement, x, atol=1e-9)


def test_what_no_file_states_is_told_and_can_be_answered(
    here: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    _csv(here / "a.csv", "t;x;F", 2.0)
    assert main(["init", "."]) == 0
    out = capsys.readouterr().out
    assert "Unsure: the unit of displacement, mm (no file states it; taken by the size" in out
    assert "Unsure: the unit of force, N" in out
    assert "--replace --unit force=kN" in out
    (warning,) = (f.text for f in read_campaign(here).findings if "guessed" in f.text)
    assert "no file states the unit of time and displacement and force" in warning
    assert main(["check", ".", "-o", "checked"]) == 0
    assert "guessed s for time, mm for displacement, N for force" in capsys.readouterr().out
    toml = (here / "campaign.toml").read_text()
    (here / "campaign.toml").write_text(re.sub("guessed = .*", 'guessed = ["force"]', toml))
    (warning,) = (f.text for f in read_campaign(here).findings if "guessed" in f.text)
    assert "no file states the unit of force: `inerter init` guessed N for force by" in warning
    (here / "campaign.toml").write_text(re.sub("guessed = .*", 'guessed = ["mass"]', toml))
    with pytest.raises(InputError, match="guessed must be a list of quantities in .units., as"):
        read_campaign(here)
    assert main(["init", "."]) == 2
    assert "campaign.toml must be new (--replace writes over it)" in capsys.readouterr().err
    units = ["--unit", "force=kN", "--unit", "displacement=mm", "--unit", "time=s"]
    assert main(["init", ".", "--replace", "--device", "device-12", *units]) == 0
    assert "Unsure" not in capsys.readouterr().out
    found = read_campaign(here)
    np.testing.assert_allclose(found.records[0].force, _test(2.0)[1], rtol=1e-6, atol=1e-5)
    assert found.device is not None
    assert found.findings == ()


def test_the_user_s_unit_may_turn_the_sign_of_the_file_s_and_no_more(
    here: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    _csv(here / "a.csv", "Time [s];Stroke [mm];Load [kN]", 2.0)
    assert main(["init", ".", "--unit", "force=-1 kN"]) == 0
    assert "in -1 kN (you said so)" in capsys.readouterr().out
    found = read_campaign(here)
    np.testing.assert_allclose(found.records[0].force, -_test(2.0)[1], rtol=1e-6, atol=1e-5)
    for option, message in (
        (["--unit", "force=N"], "--unit: unit of force must be the one that the files state, kN, or"
         " that with its sign turned, as '-1 kN', got N"),
        (["--unit", "velocity=mm/s"], "velocity must be a column that some file has, as"
         " displacement, force, time, got none"),
        (["--column", "force=Lode"], "column of force must be one that some file has: Time [s],"
         " Stroke [mm], Load [kN], got 'Lode' (did you mean 'load'?)"),
        (["--column", "force=Nope"], "Load [kN], got 'Nope'"),
    ):  # fmt: skip
        assert main(["init", ".", "--replace", *option]) == 2
        err = capsys.readouterr().err
        assert message in err
        assert err.count("\n") == 1


def test_a_channel_that_is_another_in_one_file_is_told(
    here: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    x, force = _test(2.0)
    for name, load in (("a", "Load [kN]"), ("b", "Load [kN]"), ("c", "Load")):
        other = "Force" if name == "c" else "Signal"
        table = np.column_stack([TIME, 1e3 * x, 1e-3 * force, 2e-3 * force])
        header = f"Time [s],Stroke [mm],{load},{other} [kN]"
        np.savetxt(here / f"{name}.csv", table, delimiter=",", header=header, comments="")
    assert main(["init", "."]) == 0
    told = "the column of force, Load (Force [kN] is taken in c.csv, which has Load too, as 2 of 3"
    assert told in capsys.readouterr().out


def test_a_channel_with_its_unit_in_its_name_is_no_other(
    here: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (here / "a.tdms").write_bytes(instruments.tdms({"run 1": 1.0, "run 2": 0.5}, force="Force"))
    (here / "b.tdms").write_bytes(instruments.tdms({"run 3": 0.7}, force="Force (kN)"))
    assert main(["init", "."]) == 0
    assert "Unsure" not in capsys.readouterr().out
    assert len(read_campaign(here).records) == 3


def test_a_header_of_any_length_is_one_short_line(
    here: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    _csv(here / "a.csv", "time" + " " * 5000 + "[s];displacement [mm];force [kN]", 2.0)
    assert main(["init", "."]) == 0
    assert max(map(len, capsys.readouterr().out.splitlines())) < 400


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="Windows has no such files")
def test_a_pipe_is_no_record_and_is_not_waited_for(
    here: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    os.mkfifo(here / "pipe.csv")
    assert main(["init", "pipe.csv"]) == 2
    assert capsys.readouterr().err == "inerter: pipe.csv must be a folder or a file, got a pipe\n"
    _csv(here / "a.csv", "time [s];displacement [mm];force [kN]", 2.0)
    assert main(["init", "."]) == 0


def test_a_unit_at_the_end_of_a_name_is_taken(
    here: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    x, force = _test(2.0)
    table = np.column_stack([1e3 * TIME, 1e3 * x, 1e-3 * force])
    header = "t_ms,disp_mm,force_kN"
    np.savetxt(here / "a.csv", table, delimiter=",", header=header, comments="", fmt="%.9g")
    assert main(["init", "."]) == 0
    out = capsys.readouterr().out
    assert "force is column 'force_kN'" in out
    assert "in kN (by its name)" in out
    assert "Unsure" not in out
    record = read_campaign(here).records[0]
    np.testing.assert_allclose(record.force, force, rtol=1e-6, atol=1e-5)
    np.testing.assert_allclose(record.displacement, x, atol=1e-9)
    np.testing.assert_allclose(record.step, TIME[1] - TIME[0], rtol=1e-6)


def test_days_of_a_spreadsheet_are_told_by_their_size(here: Path) -> None:
    """45292 is the first of January 2024, and a sample of 400 Hz is 2.9e-8 days."""
    x, force = _test(2.0)
    table = np.column_stack([45292.5 + TIME / 86400.0, 1e3 * x, force])
    np.savetxt(here / "a.csv", table, delimiter=",", header="Time,x_mm,F_N", comments="")
    assert main(["init", "."]) == 0
    (record,) = read_campaign(here).records
    assert record.step == pytest.approx(1.0 / 400.0, rel=1e-6)
    np.testing.assert_allclose(record.force, force, rtol=1e-12)


@pytest.mark.parametrize(("unit", "size"), [("s", 1.0), ("ms", 1e3), ("us", 1e6), ("ns", 1e9)])
@pytest.mark.parametrize("origin", [0.0, 1.7e9])
def test_the_unit_of_a_counter_s_time_is_told_by_its_step(
    here: Path, unit: str, size: float, origin: float
) -> None:
    x, force = _test(2.0)
    counts = np.round(size * (TIME + origin), 4 if unit == "s" else 0)
    table = zip(counts, 1e3 * x, force, strict=True)
    lines = "".join(f"{t:.4f},{a:.9g},{b:.9g}\n" for t, a, b in table)
    (here / "a.csv").write_text("timestamp,x_mm,F_N\n" + lines)
    assert main(["init", "."]) == 0
    assert f'time = "{unit}"  # guessed' in (here / "campaign.toml").read_text()


def test_seconds_and_nanoseconds_in_columns_of_their_own_are_no_time(
    here: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    x, force = _test(2.0)
    table = np.column_stack([TIME // 1.0, 1e9 * (TIME % 1.0), 1e3 * x, force])
    header = "stamp.secs,stamp.nsecs,x_mm,F_N"
    np.savetxt(here / "a.csv", table, delimiter=",", header=header, comments="", fmt="%.9g")
    assert main(["init", "."]) == 2
    assert "no column for time among stamp.secs, stamp.nsecs" in capsys.readouterr().err


def test_the_time_of_a_channel_is_not_the_channel(here: Path) -> None:
    x, force = _test(2.0)
    np.savez(here / "a.npz", t_force=TIME, force=force, t_disp=TIME, disp=x)
    assert main(["init", "."]) == 0
    (record,) = read_campaign(here).records
    np.testing.assert_allclose(record.displacement, x, atol=1e-12)
    np.testing.assert_allclose(record.force, force, rtol=1e-12)


def test_a_time_beside_every_channel_is_one(here: Path) -> None:
    x, force = _test(2.0)
    for name, late in (("a.csv", 0.0), ("b.csv", 1e-3)):
        table = np.column_stack([TIME, force, TIME + late, 1e3 * x])
        header = "Time [s];Force [N];Time [s];LVDT [mm]"
        np.savetxt(here / name, table, delimiter=";", header=header, comments="", fmt="%.12g")
    assert main(["init", "a.csv"]) == 0
    (record,) = read_campaign(here).records
    np.testing.assert_allclose(record.displacement, x, atol=1e-12)
    (here / "campaign.toml").write_text(
        '[columns]\ndisplacement = "LVDT"\n[[records]]\nfile = "b.csv"\n'
    )
    found = read_campaign(here)
    assert any("channels have times of their own" in f.text for f in found.findings)


@pytest.mark.parametrize("mark", ["-1.#IND", "#NV", "OVER", "-----", "NaN"])
def test_a_column_without_a_name_that_has_no_number_somewhere_is_told(
    here: Path, capsys: pytest.CaptureFixture[str], mark: str
) -> None:
    x, force = _test(2.0)
    lines = [f"{t:.9g},{a:.9g},{b:.9g}" for t, a, b in zip(TIME, 1e3 * x, force, strict=True)]
    lines[0] = lines[0].rpartition(",")[0] + "," + mark
    (here / "a.txt").write_text("\n".join(lines) + "\n")
    assert main(["init", "."]) == 2
    told = f"among column 1, column 2, column 3; column 3 has '{mark}' in line 1;"
    assert told in capsys.readouterr().err


def test_columns_without_names_are_told_by_what_they_do(
    here: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    x, force = _test(2.0)
    np.savetxt(here / "a.dat", np.column_stack([force, TIME, 1e3 * x]), fmt="%.9g")
    assert main(["init", "a.dat", "--unit", "force=N", "--unit", "displacement=mm"]) == 0
    assert "time is column 'column 2' (likely: it alone rises evenly)" in capsys.readouterr().out
    (record,) = read_campaign(here).records
    np.testing.assert_allclose(record.displacement, x, atol=1e-9)
    named = ["--column", "force=column 3", "--column", "displacement=column 1"]
    assert main(["init", "a.dat", "--replace", *named]) == 0
    assert read_campaign(here).records[0].force[5] == pytest.approx(1e3 * x[5])


def test_files_without_time_take_a_sampling_rate(
    here: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    _csv(here / "a.csv", "displacement [mm];force [kN]", 2.0, timed=False)
    assert main(["init", "."]) == 2
    err = capsys.readouterr().err
    assert "a.csv: no column for time among displacement [mm], force [kN]; --sampling-rate" in err
    assert not (here / "campaign.toml").exists()
    assert main(["init", ".", "--sampling-rate", "0.4 kHz"]) == 0
    np.testing.assert_allclose(read_campaign(here).records[0].time, TIME, atol=1e-9)


def test_a_counter_of_samples_is_no_time(here: Path, capsys: pytest.CaptureFixture[str]) -> None:
    x, force = _test(2.0)
    table = np.column_stack([np.arange(x.size), 1e3 * x, force])
    header = "Sample #,Disp (mm),Force (N)"
    np.savetxt(here / "a.csv", table, delimiter=",", header=header, comments="", fmt="%.9g")
    assert main(["init", "."]) == 2
    assert "no column for time among Sample #, Disp (mm), Force (N)" in capsys.readouterr().err
    assert main(["init", ".", "--sampling-rate", "400 Hz"]) == 0
    assert "Unsure" not in capsys.readouterr().out
    found = read_campaign(here)
    np.testing.assert_allclose(found.records[0].time, TIME, atol=1e-9)
    assert [f.text for f in found.findings] == [
        "no time column is read: the times are made of the sampling rate"
    ]


@pytest.mark.parametrize(
    ("header", "time", "message"),
    [
        ("Time [s],Velocity [mm/s],Force [N]", TIME,
         "no column for displacement among Time [s], Velocity [mm/s], Force [N]; --column"
         " displacement=HEADER names it; velocity or acceleration alone will not do"),
        ("Time [s],LVDT [mm],Oil [degC]", TIME,
         "no column for force among Time [s], LVDT [mm], Oil [degC]; --column force=HEADER names"),
        ("Time [s],LVDT [V],Load [kN]", TIME,
         "LVDT [V] has the unit 'V': if it is the displacement, --column 'displacement=LVDT [V]'"
         " --unit 'displacement=5 mm' say so, and what one of it is"),
        ("Time [s],LVDT [mm],Kraft [kp]", TIME,
         "Kraft [kp] has the unit 'kp': if it is the force, --column 'force=Kraft [kp]'"),
        ("Time [s],LVDT [mm],Cell (lbs)", TIME,
         "no column for force among Time [s], LVDT [mm], Cell (lbs)"),
        ("Time [s],LVDT [mm],Load [kN]", np.floor(TIME),
         "many samples share one time, which is too coarse: give `sampling_rate`"),
    ],
)  # fmt: skip
def test_what_a_file_lacks_comes_with_what_to_do(
    here: Path,
    capsys: pytest.CaptureFixture[str],
    header: str,
    time: np.ndarray,
    message: str,
) -> None:
    x, force = _test(2.0)
    table = np.column_stack([time, 1e3 * x / 5.0, 1e-3 * force])
    np.savetxt(here / "a.csv", table, delimiter=",", header=header, comments="", fmt="%.9g")
    assert main(["init", "."]) == 2
    err = capsys.readouterr().err
    assert message in err
    assert err.count("\n") == 1


def test_the_commanded_motion_is_not_the_measured_one(here: Path) -> None:
    _csv(here / "a.csv", "Zeit (s);Sollweg (mm);Kraft (kN)", 2.0)
    lines = (here / "a.csv").read_text().splitlines()
    twice = [";".join((*line.split(";"), line.split(";")[1])) for line in lines]
    twice[0] = "Zeit (s);Sollweg (mm);Kraft (kN);Istweg (mm)"
    (here / "a.csv").write_text("\n".join(twice))
    assert main(["init", "."]) == 0
    toml = tomllib.loads((here / "campaign.toml").read_text())
    assert toml["columns"]["displacement"] == "Istweg"


def test_a_column_that_rises_evenly_is_no_motion(
    here: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    _, force = _test(2.0)
    rows = "".join(f"{t:.4f},{f:.4f}\n" for t, f in zip(TIME, force, strict=True))
    (here / "scope.csv").write_text("Sampling rate: 400 Hz\n\n" + rows)
    assert main(["init", "."]) == 2
    told = capsys.readouterr().err
    assert "no column for force and displacement among column 1, column 2" in told


def test_a_column_in_volts_takes_its_calibration(
    here: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    x, force = _test(2.0)
    table = np.column_stack([TIME, 1e3 * x / 5.0, force / 2000.0])
    header = "Time [s],CH1 [V],CH2 [V]"
    np.savetxt(here / "a.csv", table, delimiter=",", header=header, comments="", fmt="%.9g")
    columns = ["--column", "displacement=CH1", "--column", "force=CH2"]
    assert main(["init", ".", *columns, "--unit", "displacement=5 mm"]) == 2
    assert "CH2 [V] has the unit 'V': if it is the force" in capsys.readouterr().err
    assert main(["init", ".", *columns, "--unit", "displacement=5 mm", "--unit", "force=2 kN"]) == 0
    found = read_campaign(here)
    np.testing.assert_allclose(found.records[0].displacement, x, atol=1e-9)
    np.testing.assert_allclose(found.records[0].force, force, atol=1e-4)
    assert [f.text for f in found.findings if f.level == "note"] == [
        "one V of 'CH1 [V]' is taken as 5 mm, by [units]",
        "one V of 'CH2 [V]' is taken as 2 kN, by [units]",
    ]


def test_a_calibration_is_a_unit(here: Path) -> None:
    x, force = _test(2.0)
    table = np.column_stack([TIME, 1e3 * x / 5.0, 1e-3 * force])
    header = "Time [s],LVDT,Load [kN]"
    np.savetxt(here / "a.csv", table, delimiter=",", header=header, comments="", fmt="%.9g")
    assert main(["init", ".", "--unit", "displacement=5 mm"]) == 0
    found = read_campaign(here)
    np.testing.assert_allclose(found.records[0].displacement, x, atol=1e-9)
    assert found.findings == ()


def test_files_that_are_left_out_are_kept_in_mind(
    here: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    for name in ("a", "b", "c"):
        _csv(here / f"{name}.csv", "Time [s];Stroke [mm];Load [kN]", 2.0)
    for name in ("d", "e"):
        _csv(here / f"{name}.csv", "Stroke [mm];Load [kN]", 2.0, timed=False)
    lines = (here / "c.csv").read_text().splitlines()
    lines[1200] = lines[1200].rpartition(";")[0]
    (here / "c.csv").write_text("\n".join(lines))
    assert main(["init", "."]) == 0
    out = capsys.readouterr().out
    cut = "number of columns must be 3 as in the header, got 2"
    assert f"Left out: c.csv: line 1201: {cut}" in out
    assert "Left out: d.csv, e.csv: no column for time among Stroke [mm], Load [kN]" in out
    assert f"\n# left out: c.csv: line 1201: {cut}" in (here / "campaign.toml").read_text()


def test_the_commands_that_it_suggests_can_be_copied(
    here: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (here / "my lab").mkdir()
    x, force = _test(2.0)
    table = np.column_stack([TIME, 1e3 * x, 0.9e3 * x, force])
    header = "Time [s],LVDT 1 [mm],LVDT 2 [mm],Force"
    np.savetxt(here / "my lab" / "a.csv", table, delimiter=",", header=header, comments="")
    assert main(["init", "my lab"]) == 0
    commands = re.findall(r"`(inerter init .*)`", capsys.readouterr().out)
    assert len(commands) == 2
    assert all(main(shlex.split(command)[1:]) == 0 for command in commands)
    (record,) = read_campaign("my lab").records
    np.testing.assert_allclose(record.displacement, 0.9 * x, rtol=1e-9, atol=1e-12)
    assert main(shlex.split(commands[0])[1:]) == 0
    (record,) = read_campaign("my lab").records
    np.testing.assert_allclose(record.force, 1e3 * force, rtol=1e-9)


def test_on_a_terminal_it_asks_what_it_cant_know(
    here: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    import io

    class Terminal(io.StringIO):
        def isatty(self) -> bool:
            return True

    x, force = _test(2.0)
    table = np.column_stack([TIME, 1e3 * x, 2e-3 * force, 1e-3 * force])
    header = "Time [s],Displacement [mm],Load 1 [kN],Load 2 [kN]"
    np.savetxt(here / "a.csv", table, delimiter=",", header=header, comments="", fmt="%.9g")
    monkeypatch.setattr("sys.stdin", Terminal("2\n\n"))
    monkeypatch.setattr("discover.cli.questions.at_terminal", lambda: True)
    assert main(["init", "."]) == 0
    err = capsys.readouterr().err
    assert "Which column is the force? " in err
    assert "2  Load 2 [kN]" in err
    assert "Device (device-12, device-10; Enter for none)" in err
    np.testing.assert_allclose(read_campaign(here).records[0].force, force, rtol=1e-6, atol=1e-5)


def test_one_bad_file_does_not_spoil_the_rest(here: Path) -> None:
    for frequency in (1.0, 2.0):
        _csv(here / f"run-{frequency}.csv", "time [s];displacement [mm];force [kN]", frequency)
    text = (here / "run-2.0.csv").read_text().splitlines()
    text[9] = "0.02;overload;1"
    (here / "run-2.0.csv").write_text("\n".join(text))
    assert main(["init", "."]) == 0
    assert len(tomllib.loads((here / "campaign.toml").read_text())["records"]) == 1
    document = json.loads((here / "inerter-out" / f"init-{here.name}" / "init.json").read_text())
    assert "line 10: displacement [mm] must be a number" in document["left_out"][0]["why"]


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["init"], "FOLDER|FILE"),
        (["init", "nowhere"], "nowhere must be a folder or a file"),
        (["init", "."], ".: files must be there that can be read (.asc, .csv,"),
        (["init", ".", "--device", "device-13"], "--device: device must be one of device-12"),
        (["init", ".", "--unit", "force"], "--unit: value must be QUANTITY=UNIT, got 'force'"),
        (["init", ".", "--unit", "force=mm"], "--unit: force must be in a unit of force"),
        (["init", ".", "--column", "forse=F"], "(did you mean 'force'?)"),
        (["init", ".", "--sampling-rate", "fast"], "--sampling-rate: rate must be"),
    ],
)
def test_bad_input_is_one_line(
    here: Path, capsys: pytest.CaptureFixture[str], arguments: list[str], message: str
) -> None:
    assert main(arguments) == 2
    err = capsys.readouterr().err
    assert message in err
    assert err.count("\n") == 1
    assert list(here.iterdir()) == []


def test_check_names_files_that_no_record_is_of(
    here: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    for folder in ("lab", "lab/other rig"):
        (here / folder).mkdir()
        _csv(here / folder / "a.csv", "time [s];displacement [mm];force [kN]", 1.5)
        _csv(here / folder / "b.csv", "time [s];displacement [mm];force [kN]", 3.0)
        assert main(["init", folder, "-o", f"page of {folder.replace('/', ' ')}"]) == 0
    toml = here / "lab" / "campaign.toml"
    assert main(["check", "lab"]) == 0
    assert "no [[records]]" not in capsys.readouterr().out
    _csv(here / "lab" / "c.csv", "time [s];displacement [mm];force [kN]", 5.0)
    (here / "lab" / "notes.pdf").write_bytes(b"no record")
    for campaign in ("lab", str(toml)):
        assert main(["check", campaign, "-o", "checked"]) == 0
        out = capsys.readouterr().out
        assert "Note: 1 file of the folder is in no [[records]]: c.csv" in out


def test_check_takes_one_file(here: Path, capsys: pytest.CaptureFixture[str]) -> None:
    _csv(here / "a.csv", "Zeit [s];Weg [mm];Kraft", 2.0)
    assert main(["check", "a.csv"]) == 0
    out = capsys.readouterr().out
    assert "force is column 'Kraft' (likely: the name says so), in N (guessed)" in out
    assert "the unit of force is a guess, 'N': no file states it" in out
    _csv(here / "b.csv", "time [s];displacement [mm];force [kN]", 2.0)
    assert read_campaign(here / "b.csv").findings == ()
    assert not (here / "campaign.toml").exists()


def test_an_error_comes_with_what_reading_warned_of(
    here: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def refuse(*_: object, **__: object) -> None:
        raise InputError("displacement", expected="motion", found="noise", where="a.csv")

    x, force = _test(2.0)
    table = np.column_stack([TIME, np.clip(1e3 * x, -6.0, 6.0), force])
    header = "time [s],displacement [mm],force [N]"
    np.savetxt(here / "a.csv", table, delimiter=",", header=header, comments="", fmt="%.9g")
    monkeypatch.setattr("discover.data_check.check_campaign", refuse)
    assert main(["check", "a.csv"]) == 2
    lines = capsys.readouterr().err.splitlines()
    assert lines[0] == "inerter: a.csv: displacement must be motion, got noise"
    assert "displacement stays at its largest value 0.006 m" in lines[1]
    assert lines[-1].endswith("it may be why")


@pytest.mark.slow
@pytest.mark.parametrize("name", sorted(p.name for p in REAL.glob("*/")) if REAL.is_dir() else [])
def test_measured_folders_without_their_campaign(here: Path, name: str) -> None:
    shutil.copytree(REAL / name, here / name, copy_function=shutil.copyfile)
    (here / name).chmod(0o755)
    (here / name / "campaign.toml").unlink()
    assert main(["init", name]) == 0
    mine, theirs = read_campaign(name), read_campaign(REAL / name)
    assert {r.file for r in mine.records} == {r.file for r in theirs.records}
    assert check_campaign(mine).passed


def test_tests_of_one_file_have_results_of_their_own(here: Path) -> None:
    instruments.workbook(here / "tests.xlsx")
    toml = '[device]\npreset = "device-12"\n[[records]]\nfile = "tests.xlsx"\nsheet = "*"\n'
    (here / "campaign.toml").write_text(toml)
    assert main(["simulate", "ioim-laminar", ".", "-o", "out"]) == 0
    names = {p.name for p in (here / "out").iterdir()}
    assert {"tests.xlsx [Test 1].csv", "tests.xlsx [Test 2].csv"} <= names


def test_the_command_on_the_page_makes_the_campaign_again(here: Path) -> None:
    (here / "lab").mkdir()
    _csv(here / "lab" / "a.csv", "time [s];displacement [mm];force [kN]", 1.0)
    assert main(["init", "lab", "-o", "page"]) == 0
    written = (here / "lab" / "campaign.toml").read_bytes()
    page = (here / "page" / "report.html").read_text()
    command = re.findall(r"<pre>(inerter .*)</pre>", page)
    assert [main(shlex.split(c)[1:]) for c in command] == [0]
    assert (here / "lab" / "campaign.toml").read_bytes() == written

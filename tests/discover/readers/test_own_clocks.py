"""Channels of one record that have times of their own."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import h5py
import numpy as np
import pandas as pd
import pytest
from asammdf import MDF, Signal
from nptdms import ChannelObject, TdmsWriter

from discover.cli.app import main
from discover.readers import read_campaign
from discover.records import Campaign
from models.checks import InputError

FAST = np.arange(2000) / 200.0
SLOW = 0.05 + np.arange(490) / 50.0
ORIGIN = np.datetime64("2024-05-17T09:30:00.25", "us")


def stroke(time: np.ndarray) -> np.ndarray:
    """Its millimetres at any time, s."""
    return 8.0 * np.sin(2.0 * np.pi * 1.5 * time)


def load(time: np.ndarray) -> np.ndarray:
    """Its kilonewtons at any time, s."""
    return 0.6 * np.cos(2.0 * np.pi * 1.5 * time)


def stamps(time: np.ndarray) -> np.ndarray:
    return ORIGIN + (1e6 * time).round().astype("timedelta64[us]")


def tdms(path: Path, times: tuple[np.ndarray, np.ndarray]) -> None:
    """Waveforms of one group each, whose clocks begin when they began to be written."""
    with TdmsWriter(str(path / "a.tdms")) as writer:
        for group, name, unit, law, own in (
            ("DAQ", "force", "kN", load, times[0]), ("Cam", "displacement", "mm", stroke, times[1])
        ):  # fmt: skip
            wave = {"wf_increment": float(own[1] - own[0]), "wf_start_offset": 0.0,
                    "wf_start_time": stamps(own)[0], "unit_string": unit}  # fmt: skip
            writer.write_segment([ChannelObject(group, name, law(own), wave)])


def stamped_tdms(path: Path, times: tuple[np.ndarray, np.ndarray]) -> None:
    """A channel of time stamps in each group."""
    with TdmsWriter(str(path / "a.tdms")) as writer:
        for group, name, unit, law, own in (
            ("DAQ", "force", "kN", load, times[0]), ("Cam", "displacement", "mm", stroke, times[1])
        ):  # fmt: skip
            writer.write_segment(
                [
                    ChannelObject(group, "Stamp", stamps(own)),
                    ChannelObject(group, name, law(own), {"unit_string": unit}),
                ]
            )


def mdf(path: Path, times: tuple[np.ndarray, np.ndarray]) -> None:
    """A raster for each channel, as a bus and an analogue input have."""
    with MDF(version="4.10") as file:
        file.append([Signal(load(times[0]), times[0], unit="kN", name="force")])
        file.append([Signal(stroke(times[1]), times[1], unit="mm", name="displacement")])
        file.save(path / "a.mf4", overwrite=True)


def hdf5(path: Path, times: tuple[np.ndarray, np.ndarray]) -> None:
    """A group for each device."""
    with h5py.File(path / "a.h5", "w") as file:
        for group, name, unit, law, own in (
            ("A", "force", "kN", load, times[0]), ("B", "displacement", "mm", stroke, times[1])
        ):  # fmt: skip
            file[f"{group}/t"], file[f"{group}/{name}"] = own, law(own)
            file[f"{group}/t"].attrs["units"] = "s"
            file[f"{group}/{name}"].attrs["units"] = unit


def side_by_side(times: tuple[np.ndarray, np.ndarray]) -> pd.DataFrame:
    """A table whose columns end where their clocks do."""
    columns = {
        "Time A [s]": times[0], "force [kN]": load(times[0]),
        "Time B [s]": times[1], "displacement [mm]": stroke(times[1]),
    }  # fmt: skip
    return pd.DataFrame({key: pd.Series(values) for key, values in columns.items()})


def text(path: Path, times: tuple[np.ndarray, np.ndarray]) -> None:
    side_by_side(times).to_csv(path / "a.csv", index=False, float_format="%.9g")


def alike(path: Path, times: tuple[np.ndarray, np.ndarray]) -> None:
    """Columns of time that have the same name."""
    table = side_by_side(times).to_csv(index=False, float_format="%.9g", sep=";")
    (path / "a.csv").write_text(table.replace("Time A", "Time").replace("Time B", "Time"))


def sheet(path: Path, times: tuple[np.ndarray, np.ndarray]) -> None:
    side_by_side(times).to_excel(path / "a.xlsx", index=False)


def parquet(path: Path, times: tuple[np.ndarray, np.ndarray]) -> None:
    """Time stamps of both, as where a logger's channels have the same rate."""
    frame = side_by_side((times[0], times[1]))
    for name, own in (("Time A [s]", times[0]), ("Time B [s]", times[1])):
        frame[name] = pd.Series(stamps(own)).dt.tz_localize("UTC")
    frame.columns = ["Time A", "force [kN]", "Time B", "displacement [mm]"]
    frame.to_parquet(path / "a.parquet")


def labview(path: Path, times: tuple[np.ndarray, np.ndarray]) -> None:
    """X_Columns Multi."""
    lines = [
        "LabVIEW Measurement\t", "Separator\tTab", "Decimal_Separator\t.", "X_Columns\tMulti",
        "***End_of_Header***\t", "", "Channels\t2\t\t", "Y_Unit_Label\tkN\t\tmm",
        "***End_of_Header***\t", "X_Value\tforce\tX_Value\tdisplacement\tComment",
    ]  # fmt: skip
    table = side_by_side(times).to_csv(index=False, header=False, float_format="%.9g", sep="\t")
    (path / "a.lvm").write_text("\n".join(lines) + "\n" + table)


def started(path: Path, times: tuple[np.ndarray, np.ndarray]) -> None:
    """X_Columns No: a start and an increment for each channel."""
    begin, steps = (own[0] for own in times), (own[1] - own[0] for own in times)
    lines = [
        "LabVIEW Measurement\t", "Separator\tTab", "Decimal_Separator\t.", "X_Columns\tNo",
        "***End_of_Header***\t", "", "Channels\t2", "Y_Unit_Label\tkN\tmm",
        "X0\t" + "\t".join(f"{v:.9g}" for v in begin),
        "Delta_X\t" + "\t".join(f"{v:.9g}" for v in steps),
        "***End_of_Header***\t", "X_Value\tforce\tdisplacement\tComment",
    ]  # fmt: skip
    table = side_by_side(times)[["force [kN]", "displacement [mm]"]]
    body = table.to_csv(index=False, header=False, float_format="%.9g", sep="\t")
    body = "".join("\t" + line for line in body.splitlines(keepends=True))
    (path / "a.lvm").write_text("\n".join(lines) + "\n" + body)


FORMATS = (tdms, stamped_tdms, mdf, hdf5, text, alike, sheet, parquet, labview, started)


def read(folder: Path, time: str = "") -> Campaign:
    (file,) = (path.name for path in folder.iterdir() if path.suffix != ".toml")
    toml = f'[columns]\ntime = "{time}"\n' if time else ""
    (folder / "campaign.toml").write_text(toml + f'[[records]]\nfile = "{file}"\n')
    return read_campaign(folder)


def check(found: Campaign, first: float, last: float) -> None:
    (record,) = found.records
    time = record.time - record.time[0] + first
    assert time[-1] == pytest.approx(last)
    np.testing.assert_allclose(np.diff(time), 0.005, rtol=1e-4)
    inside = slice(10, -10)  # a spline's ends are less exact
    for values, law, size in ((record.displacement, stroke, 1e-3), (record.force, load, 1e3)):
        np.testing.assert_allclose(values[inside], size * law(time)[inside], atol=size * 2e-3)
    (told,) = (f for f in found.findings if "times of their own" in f.text)
    assert "resampled to the times of" in told.text
    table = record.file.endswith((".csv", ".xlsx", ".parquet"))
    assert told.level == ("warning" if table else "note")
    assert told.text.endswith("take out the columns of time but one") == table


@pytest.mark.parametrize("write", [f for f in FORMATS if f not in (parquet, labview, started)])
def test_channels_of_two_clocks_are_resampled_and_told(
    tmp_path: Path, write: Callable[..., None]
) -> None:
    write(tmp_path, (FAST, SLOW))
    check(read(tmp_path), 0.05, 9.83)


@pytest.mark.parametrize("write", FORMATS)
def test_channels_that_began_apart_are_aligned(tmp_path: Path, write: Callable[..., None]) -> None:
    late = FAST + 0.1
    write(tmp_path, (FAST, late))
    check(read(tmp_path), 0.1, 9.995)


@pytest.mark.parametrize("write", FORMATS)
def test_clocks_that_do_not_overlap_are_refused(tmp_path: Path, write: Callable[..., None]) -> None:
    write(tmp_path, (FAST, FAST + 60.0))
    with pytest.raises(InputError, match=r"time must be of all channels over .* displacement from"):
        read(tmp_path)


@pytest.mark.parametrize("write", FORMATS)
def test_the_same_times_twice_are_one_clock(tmp_path: Path, write: Callable[..., None]) -> None:
    write(tmp_path, (FAST, FAST))
    times = {"hdf5": "t", "text": "Time A", "sheet": "Time A", "parquet": "Time A", "alike": "Time"}
    found = read(tmp_path, times.get(write.__name__, ""))
    (record,) = found.records
    np.testing.assert_allclose(record.force, 1e3 * load(FAST), atol=1e-5)
    assert not [f.text for f in found.findings if "clock" in f.text]


def test_a_clock_that_is_too_coarse_for_the_motion_is_refused(tmp_path: Path) -> None:
    text(tmp_path, (np.arange(20) / 2.0, FAST))
    with pytest.raises(InputError, match=r"force \[kN\] must be sampled every 0.\d+ s or faster"):
        read(tmp_path)


def test_a_missing_value_between_is_told_with_its_place(tmp_path: Path) -> None:
    table = side_by_side((FAST, SLOW))
    table.loc[99, "displacement [mm]"] = np.nan
    table.to_csv(tmp_path / "a.csv", index=False)
    with pytest.raises(InputError, match=r"line 101: displacement \[mm\] must be a finite number"):
        read(tmp_path)


@pytest.mark.parametrize("write", FORMATS)
def test_init_finds_them(
    tmp_path: Path, write: Callable[..., None], capsys: pytest.CaptureFixture[str]
) -> None:
    write(tmp_path, (FAST, FAST + 0.1))
    assert main(["init", str(tmp_path)]) == 0, capsys.readouterr().err
    check(read_campaign(tmp_path), 0.1, 9.995)


def test_a_temperature_that_rises_is_no_clock(tmp_path: Path) -> None:
    table = side_by_side((FAST, FAST))[["Time A [s]", "force [kN]", "displacement [mm]"]]
    table.insert(2, "T1", 20.0 + FAST)
    table.to_csv(tmp_path / "a.csv", index=False)
    assert read(tmp_path, "Time A").findings == ()

"""Records as instruments write them, read by what ``campaign.toml`` says of them."""

from __future__ import annotations

import datetime
import subprocess
import sys
from pathlib import Path

import lvm_read
import numpy as np
import openpyxl
import pyarrow as pa
import pyarrow.parquet as parquet
import pytest
from nptdms import ChannelObject, TdmsWriter
from scipy.io import savemat

from discover.readers import read_campaign
from discover.readers.lvm import open_lvm
from discover.records import Campaign
from models.checks import InputError
from tests.discover.readers import instruments
from tests.discover.readers.folder import rows
from tests.discover.readers.instruments import LOAD, STROKE, TIME

FORCE_AND_STROKE = '[columns]\nforce = "Dev1/ai0"\ndisplacement = "LVDT"\n'


def _campaign(folder: Path, toml: str) -> Campaign:
    (folder / "campaign.toml").write_text(toml)
    return read_campaign(folder)


def _check(found: Campaign, *factors: float, rtol: float = 1e-9) -> None:
    """The records are the test of `instruments` times the factors, in SI."""
    assert len(found.records) == len(factors)
    for record, factor in zip(found.records, factors, strict=True):
        np.testing.assert_allclose(record.time, TIME, atol=1e-9)
        np.testing.assert_allclose(
            record.displacement, 1e-3 * factor * STROKE, rtol=rtol, atol=1e-9
        )
        np.testing.assert_allclose(record.force, 1e3 * factor * LOAD, rtol=rtol, atol=1e-5)
    assert [f.text for f in found.findings if f.level == "warning"] == []


@pytest.mark.parametrize("waveform", [True, False])
def test_tdms_groups_are_tests_and_channels_carry_their_units(
    tmp_path: Path, waveform: bool
) -> None:
    content = instruments.tdms({"run 1": 1.0, "run 2": 0.5}, waveform=waveform)
    (tmp_path / "a.tdms").write_bytes(content)
    each = FORCE_AND_STROKE + '[[records]]\nfile = "a.tdms"\ngroup = "*"\n'
    found = _campaign(tmp_path, each)
    _check(found, 1.0, 0.5)
    assert [r.file for r in found.records] == ["a.tdms [run 1]", "a.tdms [run 2]"]
    told = "no time column is read: the times are made of the sampling rate"
    assert any(told in f.text for f in found.findings) == waveform
    second = FORCE_AND_STROKE + '[[records]]\nfile = "a.tdms"\ngroup = {}\n'
    for name in ('"run 2"', "2"):
        _check(_campaign(tmp_path, second.format(name)), 0.5)
    with pytest.raises(InputError, match=r"group must be given .*'run 1', 'run 2', or as \"\*\""):
        _campaign(tmp_path, FORCE_AND_STROKE + '[[records]]\nfile = "a.tdms"\n')
    with pytest.raises(InputError, match=r"group must be one of 'run 1', 'run 2', got 'run 3' \(d"):
        _campaign(tmp_path, second.format('"run 3"'))
    with pytest.raises(InputError, match="key 'sheet' must be 'group' for a file of this kind"):
        _campaign(tmp_path, second.replace("group", "sheet").format('"run 1"'))
    with pytest.raises(InputError, match="group must be from 1 to 2, got 3"):
        _campaign(tmp_path, second.format("3"))


def test_one_group_need_not_be_named(tmp_path: Path) -> None:
    (tmp_path / "a.tdms").write_bytes(instruments.tdms({"all": 1.0}))
    found = _campaign(tmp_path, FORCE_AND_STROKE + '[[records]]\nfile = "a.tdms"\n')
    _check(found, 1.0)
    assert found.records[0].file == "a.tdms"


def test_several_channels_of_one_table_are_several_records(tmp_path: Path) -> None:
    (tmp_path / "a.tdms").write_bytes(instruments.tdms({"all": 1.0}))
    one = '[[records]]\nfile = "a.tdms"\nchannel = {{ force = "{}", displacement = "LVDT" }}\n'
    found = _campaign(tmp_path, one.format("Dev1/ai0"))
    _check(found, 1.0)
    with pytest.raises(InputError, match="column 'ai9' for force must be among the headers"):
        _campaign(tmp_path, one.format("ai9"))
    two = '[columns]\ndisplacement = "LVDT"\n[[records]]\nfile = "a.tdms"\nchannel = "Dev1/ai0"\n'
    assert _campaign(tmp_path, two).records[0].file == "a.tdms"
    table = np.column_stack([TIME, STROKE, LOAD, 2.0 * LOAD])
    header = "time [s],displacement [mm],Load 1 [kN],Load 2 [kN]"
    np.savetxt(tmp_path / "a.csv", table, delimiter=",", header=header, comments="")
    both = "".join(f'[[records]]\nfile = "a.csv"\nchannel = "Load {i}"\n' for i in (1, 2))
    first, second = _campaign(tmp_path, both).records
    assert (first.file, second.file) == ("a.csv [Load 1]", "a.csv [Load 2]")
    np.testing.assert_allclose(second.force, 2.0 * first.force)
    with pytest.raises(InputError, match="file must be listed once, got 'a.csv .Load 1.' again"):
        _campaign(tmp_path, both.replace("Load 2", "Load 1"))


def test_a_workbook_with_cover_preamble_and_unit_row(tmp_path: Path) -> None:
    instruments.workbook(tmp_path / "a.xlsx")
    found = _campaign(tmp_path, '[[records]]\nfile = "a.xlsx"\nsheet = "Test *"\n')
    _check(found, 1.0, 0.5)
    cells = '[[records]]\nfile = "a.xlsx"\nsheet = "Test 1"\nrange = "A4:C1205"\n'
    _check(_campaign(tmp_path, cells), 1.0)
    with pytest.raises(InputError, match=r"sheet must be given .* 'Test 1', 'Test 2'"):
        _campaign(tmp_path, '[[records]]\nfile = "a.xlsx"\n')
    with pytest.raises(InputError, match="range must be the cells of one table"):
        _campaign(tmp_path, cells.replace("A4:C1205", "A1:B3"))


def test_a_number_beside_the_row_of_units_is_no_sample(tmp_path: Path) -> None:
    instruments.workbook(tmp_path / "a.xlsx")
    book = openpyxl.load_workbook(tmp_path / "a.xlsx")
    book["Test 1"]["G4"], book["Test 1"]["G5"] = "Peak force", 1.2
    book.save(tmp_path / "a.xlsx")
    _check(_campaign(tmp_path, '[[records]]\nfile = "a.xlsx"\nsheet = "Test 1"\n'), 1.0)


def test_a_header_whose_cells_are_merged_over_two_rows(tmp_path: Path) -> None:
    book = openpyxl.Workbook()
    sheet = book.active
    sheet["A1"], sheet["A2"], sheet["B2"] = "Damper 7", "Time", "Measured"
    sheet["B3"], sheet["C3"] = "Displacement", "Force"
    sheet["A4"], sheet["B4"], sheet["C4"] = "ms", "mm", "kN"
    for cells in ("A1:C1", "A2:A3", "B2:C2"):
        sheet.merge_cells(cells)
    for row in zip(1e3 * TIME, STROKE, LOAD, strict=True):
        sheet.append([float(value) for value in row])
    book.save(tmp_path / "a.xlsx")
    _check(_campaign(tmp_path, '[[records]]\nfile = "a.xlsx"\n'), 1.0)


def test_a_column_without_a_name_is_named_by_its_place(tmp_path: Path) -> None:
    table = rows(np.arange(TIME.size), TIME, STROKE, LOAD)
    (tmp_path / "a.csv").write_text(",time [s],x [mm],force [kN]\n" + table)
    named = '[columns]\ndisplacement = "x"\n'
    _check(_campaign(tmp_path, named + '[[records]]\nfile = "a.csv"\n'), 1.0, rtol=1e-8)
    with pytest.raises(InputError, match=r"got column 1, time \[s\], x \[mm\], force \[kN\]$"):
        _campaign(tmp_path, '[[records]]\nfile = "a.csv"\n')


@pytest.mark.parametrize("decimals", [0, 3])
def test_numbers_as_text_in_a_sheet_keep_their_thousands(tmp_path: Path, decimals: int) -> None:
    """1.030 N is a thousand newtons where another column parts decimals by a comma."""
    book = openpyxl.Workbook()
    sheet = book.active
    sheet.append(["time [s]", "displacement [mm]", "force [N]"])
    force = np.round(4e3 * LOAD, decimals)
    for t, x, f in zip(TIME, STROKE, force, strict=True):
        texts = (f"{t:.3f}", f"{x:.6f}", f"{f:_.{decimals}f}")
        sheet.append([text.replace(".", ",").replace("_", ".") for text in texts])
    book.save(tmp_path / "a.xlsx")
    found = _campaign(tmp_path, '[[records]]\nfile = "a.xlsx"\n')
    np.testing.assert_allclose(found.records[0].force, force, atol=1e-9)
    np.testing.assert_allclose(found.records[0].displacement, 1e-3 * STROKE, atol=1e-9)
    (finding,) = found.findings
    assert finding.text.startswith("column 'force [N]' has thousands separators: '2.400")


def test_texts_of_a_sheet_that_can_be_read_in_two_ways_are_refused(tmp_path: Path) -> None:
    book = openpyxl.Workbook()
    book.active.append(["time [s]", "displacement [mm]", "force [N]"])
    for t, x, f in zip(TIME, STROKE, np.round(4e3 * LOAD), strict=True):
        book.active.append([float(t), float(x), f"{f:_.0f}".replace("_", ".")])
    book.save(tmp_path / "a.xlsx")
    with pytest.raises(InputError, match=r"force \[N\] must be written so that thousands"):
        _campaign(tmp_path, '[[records]]\nfile = "a.xlsx"\n')


def test_units_that_parquet_and_daqmx_keep_beside_a_channel(tmp_path: Path) -> None:
    fields = (("time", "s", TIME), ("displacement", "mm", STROKE), ("force", "kN", LOAD))
    schema = pa.schema([pa.field(n, pa.float64(), metadata={"unit": u}) for n, u, _ in fields])
    parquet.write_table(pa.table([v for *_, v in fields], schema=schema), tmp_path / "a.parquet")
    _check(_campaign(tmp_path, '[[records]]\nfile = "a.parquet"\n'), 1.0)
    with TdmsWriter(str(tmp_path / "a.tdms")) as writer:
        writer.write_segment(
            [ChannelObject("all", n, v, {"NI_UnitDescription": u}) for n, u, v in fields]
        )
    _check(_campaign(tmp_path, '[[records]]\nfile = "a.tdms"\n'), 1.0)


def test_a_wrong_cell_is_named(tmp_path: Path) -> None:
    instruments.workbook(tmp_path / "a.xlsx")
    book = openpyxl.load_workbook(tmp_path / "a.xlsx")
    book["Test 1"]["C9"] = "overload"
    book.save(tmp_path / "a.xlsx")
    with pytest.raises(
        InputError, match=r"\[Test 1\] row 9: Force must be a number, got 'overload'"
    ):
        _campaign(tmp_path, '[[records]]\nfile = "a.xlsx"\nsheet = "Test 1"\n')


def test_matlab_7_3_structures(tmp_path: Path) -> None:
    instruments.matlab_73(tmp_path / "a.mat")
    toml = (
        '[columns]\nforce = "F"\ndisplacement = "x"\n[units]\nforce = "kN"\ndisplacement = "mm"\n'
        '[[records]]\nfile = "a.mat"\ngroup = "run*"\n'
    )
    found = _campaign(tmp_path, toml)
    _check(found, 1.0, 0.5)
    assert [r.file for r in found.records] == ["a.mat [run1]", "a.mat [run2]"]


def test_matlab_structures_that_state_units_and_names(tmp_path: Path) -> None:
    channels = np.zeros(2, dtype=[("Name", "O"), ("Unit", "O"), ("Data", "O")])
    channels[0], channels[1] = ("Displacement", "mm", STROKE), ("Force", "kN", LOAD)
    desk = {"X": {"Name": "Time", "Unit": "s", "Data": TIME}, "Y": channels}
    units = {"time": "s", "displacement": "mm", "force": "kN"}
    plain = {"time": TIME, "displacement": STROKE, "force": LOAD, "units": units, "by": "us"}
    series = {
        f"log{i}": {"Time": TIME, "Data": channels["Data"][i], "Name": channels["Name"][i],
                    "Unit": channels["Unit"][i], "units": {"time": "s"}}
        for i in (0, 1)
    }  # fmt: skip
    scope = np.zeros(2, dtype=[("values", "O"), ("unit", "O"), ("label", "O")])
    scope[0], scope[1] = (STROKE, "mm", "Displacement"), (LOAD, "kN", "Force")
    scoped = {"time": TIME, "signals": scope, "units": {"time": "s"}}
    for content in (desk, plain, series, scoped):
        savemat(tmp_path / "a.mat", {"rec": content})
        _check(_campaign(tmp_path, '[[records]]\nfile = "a.mat"\n'), 1.0)


def test_hdf5_groups_with_units_and_rate_as_attributes(tmp_path: Path) -> None:
    instruments.hdf5(tmp_path / "a.h5")
    found = _campaign(tmp_path, '[[records]]\nfile = "a.h5"\ngroup = "*"\n')
    _check(found, 1.0, 0.5, rtol=1e-6)


@pytest.mark.parametrize("even", [True, False])
def test_universal_files_say_themselves_what_is_force(tmp_path: Path, even: bool) -> None:
    instruments.uff58(tmp_path / "a.uff", even=even)
    _check(_campaign(tmp_path, '[[records]]\nfile = "a.uff"\n'), 1.0, rtol=1e-5)


def test_mdf_channel_groups(tmp_path: Path) -> None:
    instruments.mdf4(tmp_path / "a.mf4")
    names = '[columns]\nforce = "Kraft"\ndisplacement = "Weg"\n'
    toml = names + '[[records]]\nfile = "a.mf4"\ngroup = "*"\n'
    found = _campaign(tmp_path, toml)
    _check(found, 1.0, 0.5)
    assert found.records[1].file == "a.mf4 [fast]"


LVM = """\
LabVIEW Measurement\t
Writer_Version\t2
Reader_Version\t2
Separator\tTab
Decimal_Separator\t{decimal}
Multi_Headings\t{many}
X_Columns\t{style}
Time_Pref\tRelative
Operator\tmeier
Date\t2024/05/17
Time\t12:00:07,284627
***End_of_Header***\t
"""
SEGMENT = """\
\t
Channels\t2{gap}\t\t
Samples\t1200\t{gap}1200\t
Date\t2024/05/17\t{gap}2024/05/17\t
Time\t12:00:07,483999\t{gap}12:00:07,483999\t
Y_Unit_Label\tmm\t{gap}kN\t
X_Dimension\tTime\t{gap}Time\t
X0\t0.0000000000000000E+0\t{gap}0.0000000000000000E+0\t
Delta_X\t0.005000\t{gap}0.005000\t
***End_of_Header***\t\t{gap}\t
"""


def _lvm(style: str, *factors: float, decimal: str = ".") -> str:
    """The test as LabVIEW's Write To Measurement File writes it, by NI's specification."""
    text = LVM.format(style=style, decimal=decimal, many="Yes" if len(factors) > 1 else "No")
    for factor in factors:
        text += SEGMENT.format(gap="\t" if style == "Multi" else "")
        second = "X_Value\t" if style == "Multi" else ""
        text += f"X_Value\tWeg\t{second}Kraft\tComment\n"
        for t, x, force in zip(TIME, factor * STROKE, factor * LOAD, strict=True):
            first = "" if style == "No" else f"{t:.6f}"
            second = f"{t:.6f}\t" if style == "Multi" else ""
            text += f"{first}\t{x:.6f}\t{second}{force:.9f}\n".replace(".", decimal)
    return text


NAMED = '[columns]\ndisplacement = "Weg"\nforce = "Kraft"\n'


@pytest.mark.parametrize("style", ["No", "One", "Multi"])
@pytest.mark.parametrize("decimal", [".", ","])
def test_labview_files(tmp_path: Path, style: str, decimal: str) -> None:
    for name in ("a.lvm", "a.txt"):
        (tmp_path / name).write_text(_lvm(style, 1.0, decimal=decimal), newline="\r\n")
        _check(_campaign(tmp_path, NAMED + f'[[records]]\nfile = "{name}"\n'), 1.0, rtol=2e-4)


@pytest.mark.parametrize("style", ["No", "One", "Multi"])
def test_labview_channels_have_the_units_that_are_stated(style: str) -> None:
    text = _lvm(style, 1.0)
    timed = int(style != "No")
    for force, stated in (("kN", {timed: "mm", 1 + timed: "kN"}), ("", {timed: "mm"})):
        (source,) = open_lvm(text.replace("\tkN\t", f"\t{force}\t").encode(), "a.lvm").parts
        assert source.headers[timed:] == ("Weg", "Kraft")
        assert source.units == {**({0: "s"} if timed else {}), **stated}
        assert source.step == (None if timed else 0.005)


def test_labview_segments_are_tests_and_a_library_reads_the_same(tmp_path: Path) -> None:
    (tmp_path / "a.lvm").write_text(_lvm("One", 1.0, 0.5))
    found = _campaign(tmp_path, NAMED + '[[records]]\nfile = "a.lvm"\ngroup = "*"\n')
    _check(found, 1.0, 0.5, rtol=2e-4)
    oracle = lvm_read.read(str(tmp_path / "a.lvm"), read_from_pickle=False, dump_file=False)
    for index, record in enumerate(found.records):
        data = oracle[index]["data"]
        np.testing.assert_allclose(record.displacement, 1e-3 * data[:, 1], rtol=1e-12, atol=1e-12)
        np.testing.assert_allclose(record.force, 1e3 * data[:, 2], rtol=1e-12, atol=1e-12)


def test_a_labview_row_that_lacks_its_last_field_is_told_with_its_line(tmp_path: Path) -> None:
    rows = _lvm("One", 1.0).splitlines(keepends=True)
    rows[400] = rows[400].rpartition("\t")[0] + "\n"
    (tmp_path / "a.lvm").write_text("".join(rows))
    with pytest.raises(InputError, match=r"a\.lvm line 401: Kraft must be a finite number"):
        _campaign(tmp_path, NAMED + '[[records]]\nfile = "a.lvm"\n')


def test_labview_segments_that_go_on_in_time_are_one_test(tmp_path: Path) -> None:
    """LabVIEW writes a segment each time that it appends to the file."""
    head, rest = _lvm("One", 1.0).split("X_Value")
    names, *samples = rest.splitlines(keepends=True)
    begin = head[head.index("\t\nChannels") :]
    parts = [samples[:400], samples[400:800], samples[800:]]
    text = head.removesuffix(begin) + "".join(
        begin + "X_Value" + names + "".join(part) for part in parts
    )
    (tmp_path / "a.lvm").write_text(text)
    found = _campaign(tmp_path, NAMED + '[[records]]\nfile = "a.lvm"\n')
    _check(found, 1.0, rtol=2e-4)
    assert found.records[0].file == "a.lvm"


def _table(
    header: str, *, sep: str, decimal: str = ".", end: str = "\n", timed: bool = True,
    before: str = "", more: str = "",
) -> str:  # fmt: skip
    columns = [*([TIME] if timed else []), STROKE, LOAD]
    lines = [
        before + sep.join(f"{v:.9f}" for v in row) + more for row in zip(*columns, strict=True)
    ]
    return header + end + end.join(lines).replace(".", decimal) + end


ONE = '[[records]]\nfile = "a.csv"\n'
TEXTS = {
    "preamble and unit row, German": (
        "Prüfbericht;Dämpfer 7;;\nPrüfer;Meier;;\nDatum;17.05.2024;;\nProben;1200;3;\n\n"
        + _table("Zeit;Weg;Kraft\ns;mm;kN", sep=";", decimal=",", end="\n"),
        '[columns]\ntime = "Zeit"\ndisplacement = "Weg"\nforce = "Kraft"\n' + ONE,
    ),
    "units in brackets below, French": (
        "Essai : amortisseur\nOpérateur : Léa\n"
        + _table("Temps\tDéplacement\tEffort\n[s]\t[mm]\t[kN]", sep="\t", decimal=","),
        '[columns]\ntime = "Temps"\ndisplacement = "Déplacement"\nforce = "Effort"\n' + ONE,
    ),
    "a rate in the preamble": (
        "Data file\nSampling rate;200 Hz\nChannels;2\n"
        + _table("Displacement (mm);Force (kN)", sep=";", timed=False),
        ONE,
    ),
    "an interval in a comment": (
        "# dt = 5 ms\n" + _table("displacement [mm],force [kN]", sep=",", timed=False), ONE,
    ),
    "a header that is a comment": (_table("# time [s] displacement [mm] force [kN]", sep=" "), ONE),
    "a header that is a comment, Matlab": (
        _table("% time [s],displacement [mm],force [kN]", sep=","), ONE
    ),
    "blanks between columns": (
        _table("  Time (s)   Displacement (mm)   Force (kN)", sep="    "), ONE
    ),
    "comments between samples": (
        _table("time [s],displacement [mm],force [kN]", sep=",").replace(
            "\n1.0", "\n# pump switched on\n1.0", 1
        ),
        ONE,
    ),
    "a footer": (_table("time [s],displacement [mm],force [kN]", sep=",") + "End of file\n", ONE),
    "no header": (
        _table("", sep=",").lstrip(),
        '[columns]\ntime = "column 1"\ndisplacement = "column 2"\nforce = "column 3"\n'
        '[units]\ntime = "s"\ndisplacement = "mm"\nforce = "kN"\n' + ONE,
    ),
    "a rate in the campaign": (
        _table("displacement [mm],force [kN]", sep=",", timed=False),
        ONE + 'sampling_rate = "200 Hz"\n',
    ),
    "MTS": (
        "MTS793|BTW|ENU|1|2|.|/|:|1|0|0|A\n\nData Acquisition: Timed\nStation Name: 100 kN\n"
        + _table("Time\tAxial Displacement\tAxial Force\nSec\tmm\tkN", sep="\t"),
        '[columns]\ndisplacement = "Axial Displacement"\nforce = "Axial Force"\n' + ONE,
    ),
    "a unit that is none, a blank before the first": (
        _table(
            "Running Time\tAxial Displacement\tAxial Force\tAxial Count\n s\tmm\tkN\tsegments",
            sep="\t", more="\t7",
        ),
        '[columns]\ntime = "Running Time"\ndisplacement = "Axial Displacement"\n'
        'force = "Axial Force"\n' + ONE,
    ),
    "names and units as comments": (
        _table("% time displacement force\n% s mm kN", sep=" "), ONE
    ),
    "quantity over unit": (
        _table("t / s;s / mm;F / kN", sep=";", decimal=","),
        '[columns]\ntime = "t / s"\ndisplacement = "s / mm"\nforce = "F"\n' + ONE,
    ),
    "quantity over unit without blanks": (
        _table("Zeit/s;Weg/mm;Kraft/kN", sep=";", decimal=","),
        '[columns]\ntime = "Zeit"\ndisplacement = "Weg"\nforce = "Kraft"\n' + ONE,
    ),
    "a preamble of as many words above names that are units too": (
        _table("Operator;Meier;Lab\nt;x;F", sep=";"),
        '[columns]\ntime = "t"\ndisplacement = "x"\nforce = "F"\n'
        '[units]\ntime = "s"\ndisplacement = "mm"\nforce = "kN"\n' + ONE,
    ),
    "catman, sensors and rates below the names": (
        "HBM_CATMAN_DATAFILE_60\nKommentar=\tDämpfer 7\nAnzahl Kanäle= 3\n\n"
        + _table(
            "Zeit  1 - Standardmessrate [s]\tMX840 CH 1 Weg [mm]\tMX840 CH 2 Kraft [kN]\n"
            "CH=0\tCH=1\tCH=2\nSR=200 Hz\tSR=200 Hz\tSR=200 Hz\nTyp=Zeit\tTyp=WA100\tTyp=U9C 1kN",
            sep="\t", decimal=",",
        ),
        '[columns]\ntime = "Zeit  1 - Standardmessrate"\n'
        'displacement = "MX840 CH 1 Weg"\nforce = "MX840 CH 2 Kraft"\n' + ONE,
    ),
    "DIAdem, types below the units": (
        _table("Time;LVDT;Load\ns;mm;kN\nDOUBLE;DOUBLE;DOUBLE", sep=";"),
        '[columns]\ndisplacement = "LVDT"\nforce = "Load"\n' + ONE,
    ),
    "names that stand twice, by their places": (
        _table("time [s],A [mm],A [kN]", sep=",").replace("A [kN]", "A [mm]"),
        '[columns]\ndisplacement = "column 2"\nforce = "column 3"\n[units]\nforce = "kN"\n' + ONE,
    ),
    "oscilloscope, channels by number": (
        _table("x-axis,1,2\nsecond,Volt,Volt", sep=","),
        '[columns]\ntime = "x-axis"\ndisplacement = "1"\nforce = "2"\n'
        '[units]\ndisplacement = "mm"\nforce = "kN"\n' + ONE,
    ),
    "oscilloscope, the increment beside the units": (
        _table("CH1,CH2,Start,Increment,\nVolt,Volt,-2.0e+00,5.0e-03", sep=",", timed=False,
               more=","),
        '[columns]\ndisplacement = "CH1"\nforce = "CH2"\n'
        '[units]\ndisplacement = "mm"\nforce = "kN"\n' + ONE,
    ),
    "oscilloscope, units in the preamble": (
        "Model,MSO24\nHorizontal Units,s,\nSample Interval,0.005,\nVertical Units,V,V\n"
        + _table("Vertical Offset,0,0\n,,\n,,\nLabel,Stroke,Load\nTIME,CH1,CH2", sep=","),
        '[columns]\ndisplacement = "CH1"\nforce = "CH2"\n'
        '[units]\ntime = "s"\ndisplacement = "mm"\nforce = "kN"\n' + ONE,
    ),
    "ControlDesk, labels in the first column": (
        "descriptor;;;\n;XAxis=\"Time\";;\n\ntrace_settings;;;\n"
        'path;"Model Root/Time";"Model Root/Out1";"Model Root/Out2"\n'
        'name;"Time";"x_mm";"F_N"\nunit;"s";"mm";"kN"\n'
        + _table("trace_values;;;", sep=";", before=";"),
        '[columns]\ndisplacement = "x_mm"\nforce = "F_N"\n' + ONE,
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", TEXTS)
def test_text_as_loggers_write_it(tmp_path: Path, name: str) -> None:
    content, toml = TEXTS[name]
    (tmp_path / "a.csv").write_text(content, encoding="utf-8")
    _check(_campaign(tmp_path, toml), 1.0)


EACH = list(zip(TIME, STROKE, LOAD, strict=True))


def _german(text: str) -> str:
    return text.replace(",", "_").replace(".", ",").replace("_", ".")


THOUSANDS = {
    "quoted": (
        "Time [s],Displacement [mm],Force [N]",
        lambda t, x, f: f'{t:.5f},{x:.5f},"{f:,.4f}"',
    ),
    "tabs, forces without decimals": (
        "Time [s]\tDisplacement [mm]\tForce [N]",
        lambda t, x, f: f"{t:.5f}\t{x:.4f}\t{f:,.0f}",
    ),
    "blanks": ("Time [s] Displacement [mm] Force [N]", lambda t, x, f: f"{t} {x:.4f} {f:,.1f}"),
    "German, forces without decimals": (
        "Time [s];Displacement [mm];Force [N]",
        lambda t, x, f: _german(f"{t:.5f};{x:.4f};{f:,.0f}"),
    ),
    "German": (
        "Time [s];Displacement [µm];Force [N]",
        lambda t, x, f: _german(f"{t:.5f};{1e3 * x:,.2f};{f:,.3f}"),
    ),
    "millions": (
        "Time [s];Displacement [mm];Force [mN]",
        lambda t, x, f: f"{t:.5f};{x:.4f};{1e3 * f:,.0f}",
    ),
}


@pytest.mark.parametrize("name", THOUSANDS)
def test_thousands_separators_are_taken_out(tmp_path: Path, name: str) -> None:
    header, write = THOUSANDS[name]
    rows = [write(t, x, 3e4 * f) for t, x, f in EACH]
    (tmp_path / "a.csv").write_text("\n".join([header, *rows]) + "\n", encoding="utf-8")
    found = _campaign(tmp_path, ONE)
    (record,) = found.records
    np.testing.assert_allclose(record.time, TIME, atol=1e-9)
    np.testing.assert_allclose(record.displacement, 1e-3 * STROKE, atol=1e-7)
    np.testing.assert_allclose(record.force, 3e4 * LOAD, atol=0.51)
    assert any("has thousands separators: '" in f.text for f in found.findings)


def test_decimals_of_another_mark_in_each_column_are_no_thousands(tmp_path: Path) -> None:
    rows = [f"{t:.3f};{x:.3f};{_german(f'{f:.3f}')}" for t, x, f in EACH]
    (tmp_path / "a.csv").write_text("\n".join(["time [s];displacement [mm];force [kN]", *rows]))
    found = _campaign(tmp_path, ONE)
    np.testing.assert_allclose(found.records[0].force, 1e3 * LOAD, atol=0.51)
    assert found.findings == ()


def test_marks_that_can_be_read_in_two_ways_are_refused(tmp_path: Path) -> None:
    rows = [f"{t:.3f};{x:.4f};{f:.4f}" for t, x, f in EACH]
    rows[7] = rows[7].rpartition(";")[0] + ";0,25"
    (tmp_path / "a.csv").write_text("\n".join(["time [s];displacement [mm];force [kN]", *rows]))
    said = r"line 9: force \[kN\] must be a number with decimals parted by '.',.* got '0,25'"
    with pytest.raises(InputError, match=said):
        _campaign(tmp_path, ONE)


@pytest.mark.parametrize("mark", [",", "."])
@pytest.mark.parametrize("delimiter", [";", "\t"])
def test_thousands_that_nothing_tells_from_decimals_are_refused(
    tmp_path: Path, mark: str, delimiter: str
) -> None:
    rows = [
        delimiter.join((f"{1e3 * t:.0f}", f"{1e3 * x:,.0f}".replace(",", mark), f"{1e3 * f:.0f}"))
        for t, x, f in EACH
    ]
    header = delimiter.join(("time [ms]", "displacement [µm]", "force [N]"))
    (tmp_path / "a.csv").write_text("\n".join([header, *rows]), encoding="utf-8")
    said = rf"displacement \[µm\] must be written so .* got '-?\d{mark}\d\d\d' beside '-?\d+'"
    with pytest.raises(InputError, match=said):
        _campaign(tmp_path, ONE)
    fixed = [row.replace(mark, "") for row in rows]  # as the error says
    (tmp_path / "a.csv").write_text("\n".join([header, *fixed]), encoding="utf-8")
    np.testing.assert_allclose(_campaign(tmp_path, ONE).records[0].displacement, 1e-3 * STROKE,
                               atol=0.51e-6)  # fmt: skip


def test_three_decimals_everywhere_are_decimals(tmp_path: Path) -> None:
    rows = [f"{1e3 * t:.0f};{x + 20:.3f};{f + 2:.3f}".replace(".", ",") for t, x, f in EACH]
    (tmp_path / "a.csv").write_text("\n".join(["time [ms];displacement [mm];force [kN]", *rows]))
    found = _campaign(tmp_path, ONE)
    np.testing.assert_allclose(found.records[0].force, 1e3 * (LOAD + 2), atol=0.51)
    assert found.findings == ()


def test_times_of_day_count_in_seconds(tmp_path: Path) -> None:
    clock = [f"17.05.2024 23:59:{58 + t:06.3f}" if t < 2.0 else
             f"18.05.2024 00:00:{t - 2.0:06.3f}" for t in TIME]  # fmt: skip
    rows = [f"{c};{x:.9f};{f:.9f}" for c, x, f in zip(clock, STROKE, LOAD, strict=True)]
    text = "time;displacement;force\ns;mm;kN\n" + "\n".join(rows).replace(".", ",").replace(
        "05,2024", "05.2024"
    ).replace("17,", "17.").replace("18,05", "18.05")
    (tmp_path / "a.csv").write_text(text)
    (record,) = _campaign(tmp_path, ONE).records
    np.testing.assert_allclose(record.time - record.time[0], TIME, atol=1e-6)


@pytest.mark.parametrize(
    ("first", "form"),
    [
        ("2026-05-03 23:59:58", "%H:%M:%S.%f"),
        ("2026-05-03 23:59:58", "%Y-%m-%d %H:%M:%S.%f+02:00"),
        ("2026-05-03 11:59:58", "%m/%d/%Y %I:%M:%S.%f %p"),
        ("2026-05-03 23:59:58", "%I:%M:%S.%f %p"),
    ],
    ids=["past midnight", "with an offset", "past noon", "past midnight, twelve hours"],
)
def test_a_clock_that_passes_noon_or_midnight_goes_on(
    tmp_path: Path, first: str, form: str
) -> None:
    begin = datetime.datetime.fromisoformat(first)
    rows = [
        f"{(begin + datetime.timedelta(seconds=t)).strftime(form)},{x:.9f},{f:.9f}"
        for t, x, f in EACH
    ]
    text = "\n".join(["time,displacement [mm],force [kN]", *rows])
    (tmp_path / "a.csv").write_text(text)
    found = _campaign(tmp_path, ONE)
    np.testing.assert_allclose(found.records[0].time - found.records[0].time[0], TIME, atol=1e-6)
    assert found.findings == ()  # a clock's unit is known


@pytest.mark.parametrize("header", ["Time [hh:mm:ss]", "Time (HH:MM:SS.fff)", "Time (UTC)"])
@pytest.mark.parametrize("mark", [".", ":"])
def test_a_header_may_say_how_a_clock_is_written(tmp_path: Path, header: str, mark: str) -> None:
    begin = datetime.datetime(2026, 5, 3, 12, 34, 56)
    clock = [(begin + datetime.timedelta(seconds=t)).strftime("%H:%M:%S.%f")[:-3] for t in TIME]
    rows = [
        f"{c.replace('.', mark)},{x:.9f},{f:.9f}"
        for c, x, f in zip(clock, STROKE, LOAD, strict=True)
    ]
    text = "\n".join([f"{header},Displacement [mm],Force [kN]", *rows])
    (tmp_path / "a.csv").write_text(text)
    found = _campaign(tmp_path, ONE)
    np.testing.assert_allclose(found.records[0].time - found.records[0].time[0], TIME, atol=1e-6)
    assert found.findings == ()


def test_several_tables_of_one_text(tmp_path: Path) -> None:
    header = "time [s],displacement [mm],force [kN]"
    first = _table(f"Test A\n{header}", sep=",")
    second = f"\nTest B\n{header}\n" + "\n".join(
        f"{t:.4f},{0.5 * x:.9f},{0.5 * f:.9f}" for t, x, f in zip(TIME, STROKE, LOAD, strict=True)
    )
    (tmp_path / "a.csv").write_text(first + second)
    found = _campaign(tmp_path, ONE + 'group = "Test ?"\n')
    _check(found, 1.0, 0.5)
    _check(_campaign(tmp_path, ONE + "group = 2\n"), 0.5)


def test_a_span_of_time_is_a_test(tmp_path: Path) -> None:
    (tmp_path / "a.csv").write_text(_table("time [s],displacement [mm],force [kN]", sep=","))
    two = ONE + 'range = "0 s : 2.5 s"\n' + ONE + 'range = "3000 ms :"\nheld_out = true\n'
    first, second = _campaign(tmp_path, two).records
    assert (first.time[0], first.time[-1]) == pytest.approx((0.0, 2.5))
    assert (second.time[0], second.time[-1]) == pytest.approx((3.0, TIME[-1]))
    assert (first.file, second.file) == ("a.csv [0 s : 2.5 s]", "a.csv [3000 ms :]")
    assert second.held_out
    for text, message in (
        ("9 s : 10 s", "range must be inside the record, 0 to 5.995 s, got 9 s : 10 s"),
        ("2 s : 1 s", "range must be rising, got '2 s : 1 s'"),
        ("one", 'range must be a span of time as "10 s : 25 s"'),
        ("A1:C9", "range must be a span of time, .* got 'A1:C9'"),
    ):
        with pytest.raises(InputError, match=message):
            _campaign(tmp_path, ONE + f'range = "{text}"\n')


@pytest.mark.parametrize("cell", ["", "#N/A", "Overload", "-"])
def test_a_range_leaves_out_cells_that_are_no_numbers(tmp_path: Path, cell: str) -> None:
    lines = _table("time [s],displacement [mm],force [kN]", sep=",").splitlines()
    lines[101] = lines[101].rpartition(",")[0] + f",{cell}"  # at 0.5 s
    (tmp_path / "a.csv").write_text("\n".join(lines))
    with pytest.raises(InputError, match=rf"line 102: force .* got '{cell}'; mend .* `range`"):
        _campaign(tmp_path, ONE)
    (record,) = _campaign(tmp_path, ONE + 'range = "0.6 s :"\n').records
    np.testing.assert_allclose(record.force, 1e3 * LOAD[120:], rtol=1e-6, atol=1e-5)
    with pytest.raises(InputError, match="line 102: "):
        _campaign(tmp_path, ONE + 'range = "0.4 s :"\n')


def test_tests_side_by_side_in_a_sheet_are_taken_by_their_cells(tmp_path: Path) -> None:
    book = openpyxl.Workbook()
    header = ["time [s]", "displacement [mm]", "force [kN]"]
    book.active.append([*header, None, *header])
    for t, x, f in EACH:
        book.active.append([t, x, f, None, t, 0.5 * x, 0.5 * f])
    book.save(tmp_path / "a.xlsx")
    one = '[[records]]\nfile = "a.xlsx"\n'
    with pytest.raises(InputError, match=r"take the cells of one test by `range` in \[\[rec"):
        _campaign(tmp_path, one)
    last = len(EACH) + 1
    cells = 'sheet = "Sheet"\nrange = "{}"\n'
    both = one + cells.format(f"A1:C{last}") + one + cells.format(f"E1:G{last}")
    _check(_campaign(tmp_path, both), 1.0, 0.5)


def test_a_pattern_stands_for_every_file_that_no_table_names(tmp_path: Path) -> None:
    for name in ("b.csv", "a.csv", "c.csv"):
        (tmp_path / name).write_text(_table("time [s],displacement [mm],force [kN]", sep=","))
    (tmp_path / "notes.md").write_text("ours")
    every = '[[records]]\nfile = "*"\n'
    found = _campaign(tmp_path, every + '[[records]]\nfile = "b.csv"\nheld_out = true\n')
    assert [(r.file, r.held_out) for r in found.records] == [
        ("a.csv", False), ("c.csv", False), ("b.csv", True)
    ]  # fmt: skip
    with pytest.raises(InputError, match="pattern that some record's name fits, got none"):
        _campaign(tmp_path, '[[records]]\nfile = "*.tdms"\n')
    with pytest.raises(InputError, match="must be in the campaign folder, got outside of it"):
        _campaign(tmp_path, '[[records]]\nfile = "../*.csv"\n')


def test_a_missing_package_is_named_with_its_extra(tmp_path: Path) -> None:
    (tmp_path / "a.tdms").write_bytes(instruments.tdms({"all": 1.0}))
    (tmp_path / "campaign.toml").write_text('[[records]]\nfile = "a.tdms"\n')
    code = (
        "import sys; sys.modules['nptdms'] = None; from discover.cli import main; "
        f"sys.exit(main(['check', {str(tmp_path)!r}, '-o', {str(tmp_path / 'out')!r}]))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.returncode == 2
    assert 'pip install "inerter-discovery[tdms]"' in done.stderr
    assert done.stderr.count("\n") == 1


def test_no_reader_needs_an_optional_package_before_its_file_is_read() -> None:
    names = ("openpyxl", "h5py", "nptdms", "pyuff", "asammdf")
    code = f"import sys; import discover.readers; print([n for n in {names!r} if n in sys.modules])"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout == "[]\n"


def test_links_out_of_an_hdf5_file_are_not_followed(tmp_path: Path) -> None:
    import h5py

    with h5py.File(tmp_path / "other.h5", "w") as other:
        other["time"], other["displacement"], other["force"] = TIME, STROKE, LOAD
    with h5py.File(tmp_path / "a.h5", "w") as file:
        file["own"] = TIME
        for name in ("time", "displacement", "force"):
            file[name] = h5py.ExternalLink("other.h5", f"/{name}")
        file["loop"] = file["/"]
    with pytest.raises(InputError, match="column 'time' must be among the headers, got own"):
        _campaign(tmp_path, '[[records]]\nfile = "a.h5"\n')


@pytest.mark.parametrize("kind", ["tdms", "xlsx", "h5", "mat", "uff", "mf4"])
def test_damaged_files_are_refused_and_never_anything_else(tmp_path: Path, kind: str) -> None:
    path = tmp_path / f"a.{kind}"
    if kind == "tdms":
        path.write_bytes(instruments.tdms({"all": 1.0}))
    else:
        write = {"xlsx": instruments.workbook, "h5": instruments.hdf5, "uff": instruments.uff58,
                 "mat": instruments.matlab_73, "mf4": instruments.mdf4}[kind]  # fmt: skip
        write(path)
    whole = path.read_bytes()
    (tmp_path / "campaign.toml").write_text(f'[[records]]\nfile = "a.{kind}"\n')
    rng = np.random.default_rng(1)
    for _ in range(12):
        data = bytearray(whole)
        for _ in range(rng.integers(1, 6)):
            data[rng.integers(min(3000, len(data)))] = rng.integers(256)
        if rng.random() < 0.4:
            del data[rng.integers(1, len(data)) :]
        path.write_bytes(data)
        try:
            read_campaign(tmp_path)
        except InputError as error:
            assert len(str(error)) < 2000

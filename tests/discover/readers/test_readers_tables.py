"""Files of every kind: what is accepted gives the same numbers, what isn't says where."""

from __future__ import annotations

import io
import itertools
import os
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from scipy.io import savemat
from scipy.sparse import csc_matrix

from discover.readers import read_campaign
from discover.readers.mat_guard import damage
from models.checks import InputError
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

UNITS = '[units]\ntime = "s"\ndisplacement = "mm"\nforce = "kN"\n'
LINES = PLAIN.splitlines()


def _with_line(number: int, text: str) -> str:
    """Return the plain file with one of its lines (from 1) replaced."""
    lines = list(LINES)
    lines[number - 1] = text
    return "\n".join(lines) + "\n"


def _check_values(folder: Path) -> None:
    (record,) = read_campaign(folder).records
    np.testing.assert_allclose(record.time, TIME, atol=1e-9)
    np.testing.assert_allclose(record.displacement, 1e-3 * DISPLACEMENT, rtol=1e-7, atol=1e-12)
    np.testing.assert_allclose(record.force, 1e3 * FORCE, rtol=1e-7, atol=1e-9)
    assert record.uniform


@pytest.mark.parametrize(
    "content",
    [
        PLAIN,
        b"\xef\xbb\xbf" + PLAIN.encode(),
        PLAIN.encode("utf-16"),
        PLAIN.replace("\n", "\r\n"),
        PLAIN.replace("\n", "\r"),
        PLAIN + "\n\n   \n",
        "# measured on Monday\n\n" + PLAIN,
        PLAIN.replace(",", ";"),
        PLAIN.replace(",", ";").replace(".", ","),
        PLAIN.replace(",", "\t"),
        PLAIN.replace(",", "\t").replace(".", ","),
        PLAIN.replace(",", ", "),
        PLAIN.replace("\n", ",\n"),
        PLAIN.replace(HEADER, "Time (s), Displacement (mm), FORCE (kN)"),
        PLAIN.replace(HEADER, '"time [s]","displacement [mm]","force [kN]"'),
        PLAIN.replace("\n", ",fine\n").replace("],fine", "],remark"),
        (HEADER.replace("[mm]", "[µm]") + "\n").encode("latin-1")
        + rows(TIME, 1e3 * DISPLACEMENT, FORCE).encode(),
        HEADER.replace("kN", "lbf") + "\n" + rows(TIME, DISPLACEMENT, FORCE / 0.0044482216152605),
    ],
    ids=[
        "plain", "byte-order-mark", "utf-16", "windows-ends", "old-mac-ends", "blank-end",
        "comments", "semicolons", "decimal-commas", "tabs", "tabs-decimal-commas", "spaces",
        "trailing-comma", "parentheses-and-case", "quoted", "text-column", "latin-1", "pounds",
    ],
)  # fmt: skip
def test_text_that_means_the_same_reads_the_same(tmp_path: Path, content: str | bytes) -> None:
    _check_values(campaign(tmp_path / "c", content))


@pytest.mark.parametrize("mark", ["-----", "OVER", "-1.#IND", "#NV", "---.--"])
@pytest.mark.parametrize("count", [1, 2, 12])
@pytest.mark.parametrize(
    ("head", "sep"),
    [
        ("time;displacement;force\ns;mm;kN\n", ";"),
        ("by Meier\n\ntime\tdisplacement\tforce\n(s)\t(mm)\t(kN)\n", "\t"),
        (HEADER + "\n", ","),
        ("# by Meier\n# time displacement force\n", " "),
    ],
)
def test_first_samples_that_are_no_numbers_are_told_and_none_is_left_out(
    tmp_path: Path, head: str, sep: str, count: int, mark: str
) -> None:
    lines = rows(TIME, DISPLACEMENT, FORCE, sep=sep).splitlines()
    for index in range(count):
        lines[index] = sep.join([lines[index].split(sep)[0], mark, mark])
    content = head + "\n".join(lines) + "\n"
    line = head.count("\n") + 1
    message = rf"a.csv line {line}: displacement.* number, got '{mark}'"
    with pytest.raises(InputError, match=message):
        read_campaign(campaign(tmp_path / "c", content))


def test_exponents_of_fortran_s_doubles(tmp_path: Path) -> None:
    lines = "".join(f"  {t:.8E}  {x:.8E} {f:.8E}\n" for t, x, f in zip(
        TIME, DISPLACEMENT, FORCE, strict=True))  # fmt: skip
    content = "% of test 2D-17\n  time displacement force\n" + lines.replace("E", "D")
    toml = UNITS + '[[records]]\nfile = "a.dat"\n'
    found = read_campaign(campaign(tmp_path / "c", content, toml=toml, file="a.dat"))
    np.testing.assert_allclose(found.records[0].force, 1e3 * FORCE, rtol=1e-8, atol=1e-9)
    np.testing.assert_allclose(found.records[0].displacement, 1e-3 * DISPLACEMENT, atol=1e-10)


def test_tsv_and_txt(tmp_path: Path) -> None:
    for name in ("a.tsv", "a.TXT"):
        toml = f'[[records]]\nfile = "{name}"\n'
        _check_values(campaign(tmp_path / name, PLAIN.replace(",", "\t"), toml=toml, file=name))


@pytest.mark.parametrize(
    ("content", "message"),
    [
        ("", "a.csv: content must be a header line and samples, got an empty file"),
        (" \n\n", "content must be a header line and samples, got an empty file"),
        ("# nothing\n# here\n", "got only comments"),
        (HEADER, "content must be a header line and samples, got only a header"),
        (HEADER + "\n", "got only a header"),
        (b"\x89PNG\r\n\x1a\n\0\0\0\1", "content must be text, got binary data"),
        (b"\xff\xfe" + HEADER.encode("utf-16-le") + b"\n", "content must be text in utf-16"),
        (rows(TIME, DISPLACEMENT, FORCE),
         "column 'time' must be among the headers, got column 1, column 2, column 3"),
        ("all of it is prose\nand no table\n", "names separated by comma, semicolon, tab or"),
        (PLAIN.replace("displacement [mm]", "force [kN]"),
         r"force must be one column, got 'force \[kN\]', 'force \[kN\]'"),
        (PLAIN.replace("displacement [mm]", "Force [N]"), r"force must be one column"),
        (rows(TIME + 0.5, DISPLACEMENT, FORCE).replace(".", ",").join((HEADER + "\n", "")),
         r"line 2: number of columns must be 3 .* got 5 \(decimal commas"),
        (_with_line(7, "1,2"), "a.csv line 7: number of columns must be 3 as in the header, got 2"),
        (_with_line(7, "1,2,3,4"), "a.csv line 7: number of columns must be 3 .*, got 4"),
        (_with_line(7, "0.025,abc,3"), r"line 7: displacement \[mm\] must be a number, got 'abc'"),
        (_with_line(7, "0.025,,3"), r"line 7: displacement \[mm\] must be a finite number"),
        (_with_line(7, "0.025,1,nan"), r"line 7: force \[kN\] must be a finite .* got 'nan'"),
        (_with_line(7, "0.025,1,-inf"), r"line 7: force \[kN\] must be a finite .* got -inf"),
        (_with_line(7, "0.025,1,1e99"), r"line 7: force \[kN\] must be a finite .* got 1e\+99"),
        ("# one\n" + _with_line(7, "0.025,x,3"), r"line 8: displacement"),
        (PLAIN.replace(HEADER, "time,x,force\ns,mm,kN"), "column 'displacement' must be among"),
        (PLAIN.replace(HEADER, "time,displacement,force\ns,mm,V"), "got 'V', a unit of voltage"),
        (PLAIN.replace("force", "forse"), r"column 'force' must be .* is it 'forse \[kN\]'\?"),
        (PLAIN.replace("[kN]", "[kg]"),
         ": force must be in a unit of force such as 'N', got 'kg', a unit of mass"),
        (PLAIN.replace("[kN]", "[V]"), r"'V', a unit of voltage"),
        (PLAIN.replace("[kN]", "[knots/foo]"), "which is not a known unit"),
        (PLAIN.replace("[kN]", "[9^9^9^9]"), "which is not a unit"),
    ],
)  # fmt: skip
def test_text_that_is_wrong_is_one_error_that_says_where(
    tmp_path: Path, content: str | bytes, message: str
) -> None:
    with pytest.raises(InputError, match=message):
        read_campaign(campaign(tmp_path / "c", content))


@pytest.mark.parametrize("end", ["10.000", "10.000,", "10.000,1.5", "10.000,1.5\n", "10.0,1.5,-"])
def test_a_last_line_that_was_not_written_to_its_end_is_left_out(tmp_path: Path, end: str) -> None:
    found = read_campaign(campaign(tmp_path / "c", PLAIN.rstrip("\n") + "\n" + end))
    np.testing.assert_allclose(found.records[0].time, TIME, atol=1e-9)
    (finding,) = found.findings
    told = f"the last line, {TIME.size + 2}, is left out: {end.strip()!r} is no whole row"
    assert finding.text.startswith(told)


def test_columns_and_units_tables(tmp_path: Path) -> None:
    bare = PLAIN.replace(HEADER, "t,x,F")
    names = '[columns]\ntime = "t"\ndisplacement = "x"\nforce = "F"\n'
    _check_values(campaign(tmp_path / "bare", bare, toml=names + UNITS + ONE))
    scaled = UNITS.replace('"mm"', '"1e-3 m"')
    _check_values(campaign(tmp_path / "scaled", bare, toml=names + scaled + ONE))
    whole = names.replace('"F"', '"F [kN]"')
    dressed = PLAIN.replace(HEADER, "t [s],x [mm],F [kN]")
    _check_values(campaign(tmp_path / "whole", dressed, toml=whole + ONE))
    _check_values(campaign(tmp_path / "same", toml=UNITS + ONE))


def test_header_and_units_table_must_agree(tmp_path: Path) -> None:
    folder = campaign(tmp_path / "c", toml=UNITS.replace("kN", "N") + ONE)
    with pytest.raises(InputError, match=r"unit of force must be the same in \[units\] \(N\)"):
        read_campaign(folder)


def test_the_units_table_may_turn_the_sign_of_a_header_s_unit(tmp_path: Path) -> None:
    for place, unit in enumerate(("kN", "kip")):
        text = PLAIN.replace("[kN]", f"[{unit}]")
        (plain,) = read_campaign(campaign(tmp_path / f"{place}a", text)).records
        toml = f'[units]\nforce = "-1 {unit}"\n{ONE}'
        (turned,) = read_campaign(campaign(tmp_path / f"{place}b", text, toml=toml)).records
        np.testing.assert_array_equal(turned.force, -plain.force)
        other = f'[units]\nforce = "-1 N"\n{ONE}'
        with pytest.raises(InputError, match=rf"the same in \[units\] \(-1 N\).* got {unit}"):
            read_campaign(campaign(tmp_path / f"{place}c", text, toml=other))


def test_no_unit_anywhere_is_si_and_said(tmp_path: Path) -> None:
    si = "time,displacement,force\n" + rows(TIME, 1e-3 * DISPLACEMENT, 1e3 * FORCE)
    found = read_campaign(campaign(tmp_path / "c", si))
    assert found.records[0].force[1] == pytest.approx(1e3 * FORCE[1])
    (finding,) = found.findings
    assert finding.level == "warning"
    assert "no unit is stated for time, s taken, displacement, m taken" in finding.text


def test_optional_columns_are_converted(tmp_path: Path) -> None:
    header = (
        HEADER + ",velocity [mm/s],acceleration [g_0],temperature [degC],base acceleration [g_0]"
    )
    v = 30 * np.pi * np.cos(3 * np.pi * TIME)
    a = -90 * np.pi**2 * np.sin(3 * np.pi * TIME) / 9806.65
    content = header + "\n" + rows(TIME, DISPLACEMENT, FORCE, v, a, 20 + TIME, np.sin(TIME))
    (record,) = read_campaign(campaign(tmp_path / "c", content)).records
    np.testing.assert_allclose(record.velocity, 1e-3 * v, rtol=1e-6, atol=1e-9)
    np.testing.assert_allclose(record.acceleration, a * 9.80665, rtol=1e-6, atol=1e-9)
    np.testing.assert_allclose(record.temperature, 293.15 + TIME, rtol=1e-9)
    np.testing.assert_allclose(
        record.inputs["base_acceleration"], 9.80665 * np.sin(TIME), rtol=1e-6
    )


def test_nearly_named_optional_column_is_told(tmp_path: Path) -> None:
    content = HEADER + ",velocty [mm/s]\n" + rows(TIME, DISPLACEMENT, FORCE, FORCE)
    found = read_campaign(campaign(tmp_path / "c", content))
    assert found.records[0].velocity is None
    assert "'velocty [mm/s]' is not read: it is nearly 'velocity'" in found.findings[0].text


def _npz(**arrays: object) -> bytes:
    buffer = io.BytesIO()
    np.savez(buffer, **arrays)
    return buffer.getvalue()


def _mat(content: dict[str, object], **options: object) -> bytes:
    buffer = io.BytesIO()
    savemat(buffer, content, **options)
    return buffer.getvalue()


def _parquet(table: dict[str, object]) -> bytes:
    buffer = io.BytesIO()
    pd.DataFrame(table).to_parquet(buffer)
    return buffer.getvalue()


COLUMNS = {"time": TIME, "displacement": DISPLACEMENT, "force": FORCE}
DRESSED = {"time [s]": TIME, "displacement [mm]": DISPLACEMENT, "force [kN]": FORCE}
MATRIX_NAMES = '[columns]\ntime = "data(:,1)"\ndisplacement = "data(:,2)"\nforce = "data(:,3)"\n'


@pytest.mark.parametrize(
    ("suffix", "content", "toml"),
    [
        ("npz", _npz(**COLUMNS), UNITS),
        ("npz", _npz(**{k: v[:, None] for k, v in COLUMNS.items()}, fs=200.0, note="x"), UNITS),
        ("npz", _npz(**DRESSED), ""),
        ("mat", _mat(COLUMNS), UNITS),
        ("mat", _mat(COLUMNS, do_compression=True), UNITS),
        ("mat", _mat(COLUMNS, format="4"), UNITS),
        ("mat", _mat({"test": {**COLUMNS, "by": "us"}, "fs": 200.0}), UNITS),
        ("mat", _mat({"data": np.column_stack([TIME, DISPLACEMENT, FORCE])}), MATRIX_NAMES + UNITS),
        ("parquet", _parquet(DRESSED), ""),
        ("PARQUET", _parquet(COLUMNS), UNITS),
    ],
    ids=["npz", "npz-column", "npz-units", "mat", "mat-compressed", "mat-4", "mat-struct",
         "mat-matrix", "parquet", "parquet-bare"],
)  # fmt: skip
def test_binary_files_read_the_same(tmp_path: Path, suffix: str, content: bytes, toml: str) -> None:
    name = f"a.{suffix}"
    whole = toml + f'[[records]]\nfile = "{name}"\n'
    _check_values(campaign(tmp_path / "c", content, toml=whole, file=name))


@pytest.mark.parametrize("order", list(itertools.permutations(DRESSED)))
@pytest.mark.parametrize("suffix", ["parquet", "csv", "npz"])
def test_columns_may_stand_in_any_order(
    tmp_path: Path, suffix: str, order: tuple[str, ...]
) -> None:
    columns = {name: DRESSED[name] for name in order}
    content: str | bytes = pd.DataFrame(columns).to_csv(index=False)
    if suffix != "csv":
        content = _parquet(columns) if suffix == "parquet" else _npz(**columns)
    toml = f'[[records]]\nfile = "a.{suffix}"\n'
    _check_values(campaign(tmp_path / "c", content, toml=toml, file=f"a.{suffix}"))


def test_single_precision_time_is_uniform(tmp_path: Path) -> None:
    content = _npz(**{k: v.astype(np.float32) for k, v in COLUMNS.items()})
    toml = UNITS + '[[records]]\nfile = "a.npz"\n'
    found = read_campaign(campaign(tmp_path / "c", content, toml=toml, file="a.npz"))
    assert found.findings == ()
    assert np.ptp(np.diff(found.records[0].time)) < 1e-9


@pytest.mark.parametrize("origin", [1e5, 8e8, 3.8e9])
def test_single_precision_that_holds_no_clock_is_refused(tmp_path: Path, origin: float) -> None:
    """Of seconds since 1904 or 2000 single precision keeps minutes, of a day's hundredths."""
    clock = {"time": (COLUMNS["time"] + origin).astype(np.float32)}
    toml = UNITS + '[[records]]\nfile = "a.npz"\n'
    folder = campaign(tmp_path / "c", _npz(**{**COLUMNS, **clock}), toml=toml, file="a.npz")
    with pytest.raises(InputError, match=r"row \d+: time .* share one time, which is too coarse"):
        read_campaign(folder)
    double = {"time": COLUMNS["time"] + origin}
    campaign(folder, _npz(**{**COLUMNS, **double}), toml=toml, file="a.npz")
    np.testing.assert_allclose(read_campaign(folder).records[0].step, 0.005, rtol=1e-6)


@pytest.mark.parametrize(
    ("suffix", "content", "message"),
    [
        ("parquet", b"", "a.parquet: content must be a Parquet file"),
        ("parquet", b"PAR1 and no more", "content must be a Parquet file"),
        ("parquet", _parquet({**DRESSED, "force [kN]": [str(f) for f in FORCE]}),
         r"force \[kN\] must be numeric, got (large_)?string"),
        ("parquet", _parquet({**DRESSED, "force [kN]": np.where(TIME == 1.0, np.nan, FORCE)}),
         r"a.parquet row 201: force \[kN\] must be a finite number"),
        ("npz", b"", "a.npz: content must be an .npz archive"),
        ("npz", b"PK\x03\x04 and no more", "content must be an .npz archive"),
        ("npz", _npz(time=np.array([1, {}], dtype=object)), "Object arrays cannot be loaded"),
        ("npz", _npz(note="x"), "content must be numeric vectors, got none"),
        ("npz", _npz(**{**COLUMNS, "force": FORCE[:-1]}),
         r"force must be of the length of time \(2000\), got 1999"),
        ("npz", _npz(**{**COLUMNS, "force": 1j * FORCE}), "column 'force' must be among the head"),
        ("mat", b"", "a.mat: content must be a MATLAB file"),
        ("mat", b"no MATLAB file" * 30, "content must be a MATLAB file"),
        ("mat", b"MATLAB 7.3 MAT-file".ljust(512) + b"\x89HDF\r\n\x1a\n" + b"\0" * 400,
         "a.mat: content must be an HDF5 file"),
        ("mat", _mat({"note": "x"}), "content must be numeric vectors, got none"),
        ("xlsx", b"PK", "a.xlsx: content must be an Excel workbook, got File is not a zip file"),
        ("docx", b"PK", "must be one of .asc, .csv, .dat, .* .mat, .* .npz, .* got .docx"),
        ("", b"x", "got no suffix"),
    ],
)  # fmt: skip
def test_binary_files_that_are_wrong(
    tmp_path: Path, suffix: str, content: bytes, message: str
) -> None:
    name = f"a.{suffix}" if suffix else "a"
    toml = f'[[records]]\nfile = "{name}"\n'
    with pytest.raises(InputError, match=message):
        read_campaign(campaign(tmp_path / "c", content, toml=toml, file=name))


def test_matlab_variables_that_scipy_would_crash_on_are_refused() -> None:
    whole = bytearray(_mat(COLUMNS))
    assert damage(bytes(whole)) == ""
    whole[177] = 241  # a data type that isn't one
    assert "values of type" in damage(bytes(whole))
    sparse = _mat({"a": csc_matrix(np.eye(3))})
    assert "class 5 (a table, object, function or sparse matrix)" in damage(sparse)
    assert damage(_mat({"a": {"b": {"c": [1.0, "x", np.eye(2) * 1j]}}}, do_compression=True)) == ""


@pytest.mark.parametrize("suffix", ["csv", "npz", "mat", "parquet"])
def test_damaged_files_never_raise_anything_else(tmp_path: Path, suffix: str) -> None:
    whole = {
        "csv": PLAIN.encode(),
        "npz": _npz(**DRESSED),
        "mat": _mat({"test": COLUMNS}),
        "parquet": _parquet(DRESSED),
    }[suffix]
    rng = np.random.default_rng(0)
    toml = f'[[records]]\nfile = "a.{suffix}"\n'
    refused = 0
    for _ in range(60):
        data = bytearray(whole)
        for _ in range(rng.integers(1, 4)):
            data[rng.integers(min(400, len(data)))] = rng.integers(256)
        if rng.random() < 0.3:
            del data[rng.integers(1, len(data)) :]
        folder = campaign(tmp_path / "c", bytes(data), toml=toml, file=f"a.{suffix}")
        try:
            read_campaign(folder)
        except InputError:
            refused += 1
    assert refused > 20


def test_reading_is_fast(tmp_path: Path) -> None:
    time = np.arange(20000) / 2000.0
    folder = tmp_path / "c"
    toml = ""
    for index in range(10):
        text = HEADER + "\n" + rows(time, 10 * np.sin(9 * time + index), np.cos(9 * time))
        campaign(folder, text, file=f"{index}.csv")
        toml += f'[[records]]\nfile = "{index}.csv"\n'
    (folder / "campaign.toml").write_text(toml)
    began = os.times()
    assert len(read_campaign(folder).records) == 10
    ended = os.times()
    assert (ended.user - began.user) + (ended.system - began.system) < 3.0

"""Text as older programs, printers, displays and microcontrollers write it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from discover.cli.app import main
from discover.readers import read_campaign
from discover.records import Campaign
from models.checks import InputError

TIME = np.arange(1200) / 200.0
STROKE = 8.0 * np.sin(2 * np.pi * 1.5 * TIME)  # mm
LOAD = 600.0 * np.cos(2 * np.pi * 1.5 * TIME)  # N
HEADER = "time [s]{0}displacement [mm]{0}force [N]\n"


def lines(form: str, *columns: np.ndarray) -> str:
    return "".join(form.format(*row) + "\n" for row in zip(*columns, strict=True))


def read(folder: Path, content: str, toml: str = "", file: str = "a.txt") -> Campaign:
    (folder / file).write_text(content)
    (folder / "campaign.toml").write_text(toml + f'[[records]]\nfile = "{file}"\n')
    return read_campaign(folder)


def drafted(folder: Path, content: str, *options: str) -> Campaign:
    (folder / "a.txt").write_text(content)
    assert main(["init", str(folder), *options]) == 0
    return read_campaign(folder)


def check(found: Campaign, *, atol: float = 1e-3) -> None:
    (record,) = found.records
    np.testing.assert_allclose(record.time, TIME, atol=1e-7)
    np.testing.assert_allclose(1e3 * record.displacement, STROKE, atol=atol)
    np.testing.assert_allclose(record.force, LOAD, atol=1e3 * atol)


@pytest.mark.parametrize("form", ["{:7.3f}{:7.3f}{:7.2f}", "{:9.3f}{:6.3f}{:7.2f}"])
def test_columns_of_fixed_width_that_touch(tmp_path: Path, form: str) -> None:
    content = HEADER.format(" ") + lines(form, TIME, STROKE, LOAD)
    check(read(tmp_path, content), atol=6e-3)


def test_numbers_of_fortran_that_fill_their_columns(tmp_path: Path) -> None:
    content = HEADER.format(" ") + lines("{:12.5E}{:12.5E}{:12.5E}", TIME, STROKE, LOAD)
    check(read(tmp_path, content))


def test_numbers_that_touch_and_are_of_no_width_are_refused(tmp_path: Path) -> None:
    content = HEADER.format(" ") + lines("{:.3f} {:.3f}{:+.2f}", TIME, STROKE, LOAD)
    message = r"columns must be parted .* '0.000 0.000\+600.00', in which numbers touch"
    with pytest.raises(InputError, match=message):
        read(tmp_path, content)


def test_dates_and_exponents_do_not_touch(tmp_path: Path) -> None:
    stamps = [f"2024-05-17 09:30:{t:09.6f}" for t in TIME]
    content = "stamp,x [mm],F [N]\n" + lines("{},{:.6e},{:.6e}", stamps, STROKE, LOAD)
    columns = '[columns]\ntime = "stamp"\ndisplacement = "x"\nforce = "F"\n'
    assert read(tmp_path, content, columns).records[0].time.size == TIME.size


@pytest.mark.parametrize("parted", [",", "  "])
def test_a_row_of_dashes_below_the_header_is_told(tmp_path: Path, parted: str) -> None:
    form = parted.join(["{:.3f}", "{:.4f}", "{:.3f}"])
    rule = parted.join(["-----"] * 3)
    found = read(tmp_path, HEADER.format(parted) + rule + "\n" + lines(form, TIME, STROKE, LOAD))
    check(found)
    assert f"line 2 is left out: '{rule}' holds no number" in [f.text for f in found.findings]


def test_a_row_of_units_in_brackets_between_blanks(tmp_path: Path) -> None:
    content = " time  displacement  force\n  (s)   (mm)   (N)\n"
    found = read(tmp_path, content + lines("{:9.3f} {:9.4f} {:9.3f}", TIME, STROKE, LOAD))
    check(found)
    assert found.findings == ()


@pytest.mark.parametrize(
    "header", ["TIME (S),STROKE (MM),LOAD (N)\n", "TIME,STROKE,LOAD\nSEC,MM,N\n"]
)
def test_units_in_capitals(tmp_path: Path, header: str) -> None:
    found = drafted(tmp_path, header + lines("{:.3f},{:.4f},{:.3f}", TIME, STROKE, LOAD))
    check(found)
    assert found.findings == ()


def test_a_unit_whose_case_tells_its_size_is_refused(tmp_path: Path) -> None:
    content = HEADER.format(",").replace("[N]", "[mn]")
    with pytest.raises(InputError, match=r"force must be in a unit .* 'mn', which may be mN or MN"):
        read(tmp_path, content + lines("{:.3f},{:.4f},{:.3f}", TIME, STROKE, LOAD))


@pytest.mark.parametrize(
    "header", ["Time sec\tDisp in\tForce lbs\n", "Time (Sec)\tDisp (IN)\tForce (LBS)\n"]
)
def test_a_force_in_pounds_is_their_weight_and_told(
    tmp_path: Path, header: str, capsys: pytest.CaptureFixture[str]
) -> None:
    rows = lines("{:.3f}\t{:.7f}\t{:.6f}", TIME, STROKE / 25.4, LOAD / 4.4482216)
    check(drafted(tmp_path, "Roehrig\n" + header + rows))
    assert "in lbs*g_0 (by its name)" in capsys.readouterr().out
    toml = '[columns]\ntime = "Time sec"\ndisplacement = "Disp in"\nforce = "Force"\n'
    if "LBS" in header:
        with pytest.raises(InputError, match="a unit of mass"):
            read(tmp_path, header + rows, toml.replace(" sec", "").replace(" in", ""))


@pytest.mark.parametrize(
    ("top", "again"),
    [("", HEADER.format(",")), ("Block {}\n\n", "time,displacement,force\ns,mm,N\n")],
)
@pytest.mark.parametrize("size", [200, 12])
def test_a_header_that_is_written_again_at_every_block(
    tmp_path: Path, top: str, again: str, size: int
) -> None:
    content = ""
    for first in range(0, TIME.size, size):
        block = slice(first, first + size)
        content += top.format(first) + again
        content += lines("{:.3f},{:.4f},{:.3f}", TIME[block], STROKE[block], LOAD[block])
    found = read(tmp_path, content)
    check(found)
    (finding,) = found.findings
    assert finding.text.endswith("tables below one header go on in time and are read as one")
    bad = content.replace(f"{TIME[size + 2]:.3f},", "over,")
    line = bad[: bad.index("over")].count("\n") + 1
    with pytest.raises(InputError, match=f"line {line}"):
        read(tmp_path, bad)


def test_tables_that_begin_again_stay_tests(tmp_path: Path) -> None:
    block = HEADER.format(",") + lines("{:.3f},{:.4f},{:.3f}", TIME, STROKE, LOAD)
    found = drafted(tmp_path, 3 * block)
    assert [r.file for r in found.records] == [f"a.txt [table {i}]" for i in (1, 2, 3)]


@pytest.mark.parametrize(
    ("form", "columns"),
    [
        ("t:{:.3f} x:{:.4f} F:{:.3f}", ("t", "x", "F")),
        ("t = {:.3f}, x = {:.4f}, F = {:.3f}", ("t", "x", "F")),
        ("{:.3f} -> x: {:.4f} mm F: {:.3f} N", ("column 1", "x", "F")),
        ("Time: {:.3f} s; Load cell: {2:.3f} N; Pos: {1:.4f} mm".replace("{:", "{0:"),
         ("Time", "Pos", "Load cell")),
    ],
)  # fmt: skip
def test_lines_that_name_each_value(
    tmp_path: Path, form: str, columns: tuple[str, str, str]
) -> None:
    log = "boot v1.2: ok\n" + lines(form, TIME, STROKE, LOAD)
    quantities = ("time", "displacement", "force")
    named = (f'{q} = "{column}"\n' for q, column in zip(quantities, columns, strict=True))
    toml = "[columns]\n" + "".join(named)
    if "mm" not in form:
        toml += '[units]\ndisplacement = "mm"\n'
    check(read(tmp_path, log, toml))
    cut = read(tmp_path, log + form.format(6.0, 0.0, 0.0)[:12], toml)
    check(cut)
    assert any(f.text.startswith("the last line, 1202, is left out") for f in cut.findings)
    broken = log.splitlines()
    broken[99] = broken[99][:12]
    with pytest.raises(InputError, match="line 100: line must be with .* as the others"):
        read(tmp_path, "\n".join(broken) + "\n", toml)


@pytest.mark.parametrize("encoding", ["utf-16", "utf-16-le", "utf-16-be", "utf-8-sig"])
def test_utf_16_with_and_without_its_mark(tmp_path: Path, encoding: str) -> None:
    content = HEADER.format("\t") + lines("{:.3f}\t{:.4f}\t{:.3f}", TIME, STROKE, LOAD)
    (tmp_path / "a.txt").write_bytes(content.replace("\n", "\r\n").encode(encoding))
    (tmp_path / "campaign.toml").write_text('[[records]]\nfile = "a.txt"\n')
    check(read_campaign(tmp_path))


@pytest.mark.parametrize("mark", ["'", "’", "\u202f", "\xa0"])
@pytest.mark.parametrize("encoding", ["utf-8", "cp1252"])
def test_thousands_of_the_swiss_and_the_french(tmp_path: Path, mark: str, encoding: str) -> None:
    if mark == "\u202f" and encoding == "cp1252":
        pytest.skip("it has no such blank")
    if mark == "’" and encoding == "cp1252":
        pytest.skip("a byte that is a letter elsewhere")
    content = HEADER.format(";") + "".join(
        f"{t:.3f};{x:.4f};{f'{10.0 * f:,.2f}'.replace(',', mark)}\n"
        for t, x, f in zip(TIME, STROKE, LOAD, strict=True)
    )
    (tmp_path / "a.txt").write_bytes(content.encode(encoding))
    (tmp_path / "campaign.toml").write_text('[[records]]\nfile = "a.txt"\n')
    found = read_campaign(tmp_path)
    np.testing.assert_allclose(found.records[0].force, 10.0 * LOAD, atol=0.01)
    (finding,) = found.findings
    assert finding.text.startswith("thousands separators are taken out: 6")


def test_minus_signs_of_a_word_processor(tmp_path: Path) -> None:
    rows = lines("{:.3f};{:.4f};{:.3f}", TIME, STROKE, LOAD).replace("-", "−")
    check(read(tmp_path, HEADER.format(";") + rows))


@pytest.mark.parametrize("offset", ["", "Z", "+02:00"])
def test_a_clock_that_is_put_back_for_winter_goes_on(tmp_path: Path, offset: str) -> None:
    begin = np.datetime64("2024-10-27T00:59:58.000")
    utc = [begin + np.timedelta64(round(1e3 * t), "ms") for t in TIME]
    if offset == "+02:00":
        stamps = [
            f"{t + np.timedelta64(early, 'h')}+0{early}:00"
            for t in utc
            for early in [2 if t < np.datetime64("2024-10-27T01:00") else 1]
        ]
    else:
        stamps = [f"{t}{offset}" for t in utc]
    rows = lines("{},{:.4f},{:.3f}", stamps, STROKE, LOAD)
    check(read(tmp_path, "time,displacement [mm],force [N]\n" + rows))

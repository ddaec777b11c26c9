"""What a file says beside its values: names, units, scales, and what stands for none."""

from __future__ import annotations

from pathlib import Path

import h5py
import numpy as np
import openpyxl
import pandas as pd
import pyarrow as pa
import pyarrow.parquet as parquet
import pytest
from scipy.io import savemat

from discover.readers import read_campaign
from discover.readers import source as source_module
from discover.records import Campaign
from models.checks import InputError

TIME = np.arange(1200) / 200.0
STROKE = 8.0 * np.sin(2 * np.pi * 1.5 * TIME)  # mm
LOAD = 600.0 * np.cos(2 * np.pi * 1.5 * TIME)  # N


def read(folder: Path, file: str, toml: str = "") -> Campaign:
    (folder / "campaign.toml").write_text(toml + f'[[records]]\nfile = "{file}"\n')
    return read_campaign(folder)


def check(found: Campaign, *, atol: float = 1e-3) -> None:
    (record,) = found.records
    np.testing.assert_allclose(record.time, TIME, atol=1e-9)
    np.testing.assert_allclose(1e3 * record.displacement, STROKE, atol=atol)
    np.testing.assert_allclose(record.force, LOAD, atol=100.0 * atol)
    assert found.findings == ()


def netcdf(path: Path, *, missing: int | None = None) -> None:
    """A file as NetCDF's library packs it: counts with a scale, an offset, a fill value."""
    with h5py.File(path, "w") as file:
        for name, values, scale, offset, unit in (
            ("time", TIME, 0.005, 0.0, "seconds since 2024-05-17 09:30:00"),
            ("displacement", STROKE, 0.001, 1.0, "mm"), ("force", LOAD, 0.1, 0.0, "N"),
        ):  # fmt: skip
            counts = np.round((values - offset) / scale).astype("i2")
            if missing is not None and name == "force":
                counts[missing] = -32768
            data = file.create_dataset(name, data=counts)
            data.attrs.update({"scale_factor": scale, "add_offset": offset, "units": unit})
            data.attrs["_FillValue"] = np.int16(-32768)


def test_counts_of_netcdf_stand_for_values(tmp_path: Path) -> None:
    netcdf(tmp_path / "a.h5")
    check(read(tmp_path, "a.h5"))


@pytest.mark.parametrize("key", ["columns", "channel_names", "Labels"])
@pytest.mark.parametrize("rows", [True, False])
def test_an_attribute_names_the_columns_of_a_matrix(tmp_path: Path, key: str, rows: bool) -> None:
    matrix = np.column_stack([TIME, STROKE, LOAD])
    with h5py.File(tmp_path / "a.h5", "w") as file:
        data = file.create_dataset("run/data", data=matrix.T if rows else matrix)
        data.attrs["DIMENSION_LABELS"] = ["sample", "channel"]
        data.attrs[key] = ["time", "displacement", "force"]
        data.attrs["units"] = ["s", "mm", "N"]
    check(read(tmp_path, "a.h5"))


def test_a_fill_value_is_no_value(tmp_path: Path) -> None:
    netcdf(tmp_path / "a.h5", missing=100)
    with pytest.raises(InputError, match=r"row 101: force must be a finite number .* got nan"):
        read(tmp_path, "a.h5")


def test_counts_that_stay_in_their_file_stand_for_values(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("discover.readers.formats.hdf5.LONG", 100)
    assert source_module.LONG > TIME.size
    netcdf(tmp_path / "a.h5")
    check(read(tmp_path, "a.h5"))


def test_units_of_a_table_of_hdf5(tmp_path: Path) -> None:
    table = np.zeros(TIME.size, dtype=[("time", "f8"), ("displacement", "f8"), ("force", "f4")])
    table["time"], table["displacement"], table["force"] = 1e3 * TIME, STROKE, 1e-3 * LOAD
    with h5py.File(tmp_path / "a.h5", "w") as file:
        file.create_dataset("daq/log", data=table).attrs["units"] = ["ms", "mm", "kN"]
    check(read(tmp_path, "a.h5"))


@pytest.mark.parametrize("names", [["Disp [mm]", "F [N]", "t [s]"], ["Disp [mm]", "F [N]"]])
def test_a_list_of_names_beside_a_matrix_names_its_columns(
    tmp_path: Path, names: list[str]
) -> None:
    data = np.column_stack([STROKE, LOAD, TIME])
    listed = np.array(names, dtype=object)
    savemat(tmp_path / "a.mat", {"data": data, "labels": listed, "by": "us"})
    toml = '[columns]\ntime = "t"\ndisplacement = "Disp"\nforce = "F"\n'
    if len(names) == 3:
        check(read(tmp_path, "a.mat", toml))
        return
    with pytest.raises(InputError, match=r"got data\(:,1\), data\(:,2\), data\(:,3\)"):
        read(tmp_path, "a.mat", toml)


def test_a_list_of_units_beside_one_of_names(tmp_path: Path) -> None:
    data = np.column_stack([1e3 * TIME, STROKE, LOAD])
    texts = {"names": ["time", "displacement", "force"], "units": ["ms", "mm", "N"]}
    listed = {key: np.array(own, dtype=object) for key, own in texts.items()}
    savemat(tmp_path / "a.mat", {"data": data, **listed})
    check(read(tmp_path, "a.mat"))


def test_decimals_of_a_data_base(tmp_path: Path) -> None:
    columns = {"time [s]": TIME, "displacement [mm]": STROKE.round(4), "force [N]": LOAD.round(3)}
    exact = {name: pa.array(values).cast(pa.decimal128(12, 4)) for name, values in columns.items()}
    parquet.write_table(pa.table(exact), tmp_path / "a.parquet")
    check(read(tmp_path, "a.parquet"))


def test_a_hidden_sheet_is_told(tmp_path: Path) -> None:
    table = {"time [s]": TIME, "displacement [mm]": STROKE, "force [N]": LOAD}
    with pd.ExcelWriter(tmp_path / "a.xlsx") as writer:
        for sheet in ("Test", "Old"):
            pd.DataFrame(table).to_excel(writer, sheet_name=sheet, index=False)
    book = openpyxl.load_workbook(tmp_path / "a.xlsx")
    book["Old"].sheet_state = "hidden"
    book.save(tmp_path / "a.xlsx")
    (tmp_path / "campaign.toml").write_text('[[records]]\nfile = "a.xlsx"\nsheet = "*"\n')
    (finding,) = read_campaign(tmp_path).findings
    assert (finding.record, finding.text) == (
        "a.xlsx [Old]", "the sheet 'Old' is hidden in the workbook"
    )  # fmt: skip

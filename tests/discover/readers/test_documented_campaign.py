"""The documented campaign.toml in full, read by the reader: nothing in it is wrong or missing."""

from __future__ import annotations

import re
import tomllib
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from scipy.io import savemat

from discover.readers import read_campaign
from discover.readers.campaign import CAMPAIGN_FILE
from discover.readers.columns import QUANTITIES
from discover.readers.formats import FORMATS
from models.checks import InputError
from models.device import Device

PAGE = Path(__file__).parents[3] / "docs" / "campaign.md"
TIME = np.arange(4000) / 500.0
PHASE = 2.0 * np.pi * TIME
MOTION = np.array(
    [np.sin(PHASE), 2.0 * np.pi * np.cos(PHASE), -((2.0 * np.pi) ** 2) * np.sin(PHASE)]
)


def block() -> str:
    _, section = PAGE.read_text(encoding="utf-8").split("## campaign.toml in full")
    found = re.search(r"```toml\n(.*?)```", section, re.DOTALL)
    assert found is not None
    return found[1]


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """The page's campaign with records of 10 mm at 1 Hz in the units that it states."""
    toml = block()
    table = tomllib.loads(toml)
    x, v, a = 0.01 * MOTION
    in_units = {
        "time": 1e3 * TIME,
        "displacement": 1e3 * x,
        "force": 1e-3 * (370.0 * a + 4000.0 * v),
        "velocity": 1e3 * v,
        "acceleration": a / 9.80665,
        "temperature": 20.0 + 0.1 * TIME,
        "base_acceleration": 0.1 * a / 9.80665,
        "applied_force": 5.0 * v,
    }
    columns = {table["columns"][quantity]: values for quantity, values in in_units.items()}
    rows = np.array(list(columns.values())).T
    sine, other, book = (r["file"] for r in table["records"])
    np.savetxt(tmp_path / sine, rows, delimiter=",", header=",".join(columns), comments="")
    savemat(tmp_path / other, {"run": columns, "calibration": {"gain": np.arange(5.0)}})
    with pd.ExcelWriter(tmp_path / book) as writer:
        pd.DataFrame(columns).to_excel(writer, sheet_name="up", index=False)
        pd.DataFrame({"done": ["by us"]}).to_excel(writer, sheet_name="notes", index=False)
    (tmp_path / CAMPAIGN_FILE).write_text(toml, encoding="utf-8")
    return tmp_path


def test_it_is_read_as_it_says(folder: Path) -> None:
    found = read_campaign(folder)
    assert [f.text for f in found.findings if f.level != "note"] == []
    for record in found.records:
        assert record.displacement is not None
        np.testing.assert_allclose(record.displacement, 0.01 * MOTION[0], atol=1e-12)
        np.testing.assert_allclose(record.velocity, 0.01 * MOTION[1], atol=1e-12)
        np.testing.assert_allclose(record.acceleration, 0.01 * MOTION[2], atol=1e-12)
        np.testing.assert_allclose(record.inputs["applied_force"], 0.05 * MOTION[1], atol=1e-12)
        assert record.temperature is not None
        assert record.temperature[0] == pytest.approx(293.15)
    assert (found.records[0].frequency, found.records[0].amplitude) == (1.0, 0.01)
    assert found.device is not None
    assert found.device.name == "My inerter"
    preset = Device.preset("device-12")
    for key in ("turns", "helix_radius", "transition_length", "coulomb_friction", "fluid"):
        assert getattr(found.device, key) == getattr(preset, key)
    assert (found.device.piston_clearance, found.device.inertance_source) == (1e-4, "measured")
    assert found.rig is not None
    assert found.rig.max_acceleration == pytest.approx(49.03325)
    assert found.system is not None
    assert (found.system.stiffness, found.system.input) == (2e4, "base_acceleration")


def test_a_device_without_its_preset_line_is_whole_too(folder: Path) -> None:
    path = folder / CAMPAIGN_FILE
    path.write_text(path.read_text().replace('preset = "device-12"', ""))
    device = read_campaign(folder).device
    assert device is not None
    assert device.inertance == 370.38


@pytest.mark.parametrize(
    ("table", "place"),
    [
        ("", ""),
        ("[device]", "device"),
        ("[device.fluid]", "device.fluid"),
        ("[rig]", "rig"),
        ("[system]", "system"),
        ("[[records]]", "records"),
    ],
)
def test_every_key_that_the_reader_knows_is_in_it(folder: Path, table: str, place: str) -> None:
    path = folder / CAMPAIGN_FILE
    wrong = ("\n" + path.read_text()).replace(f"\n{table}", f"\n{table}\nqqq = 1\n", 1)
    path.write_text(wrong)
    with pytest.raises(InputError, match="'qqq' must be one of") as caught:
        read_campaign(folder)
    known = set(caught.value.expected.removeprefix("one of ").split(", "))
    shown = tomllib.loads(block())
    for part in filter(None, place.split(".")):
        shown = shown[part]
    tables = shown if isinstance(shown, list) else [shown]
    shown_keys = {key for table in tables for key in table}
    assert known == shown_keys


def test_every_column_is_in_it() -> None:
    table = tomllib.loads(block())
    assert set(table["columns"]) == set(table["units"]) == set(QUANTITIES)


def test_the_table_of_files_names_what_can_be_read() -> None:
    _, section = PAGE.read_text(encoding="utf-8").split("## Files\n")
    table, _ = section.split("\n\n**Text.**")
    firsts = [row.split("|")[1] for row in table.splitlines() if row.startswith("| `")]
    named = re.findall(r"`(\.\w+)`", " ".join(firsts))
    read = [suffix for one in FORMATS for suffix in one.suffixes]
    assert sorted(set(named)) == sorted(read)

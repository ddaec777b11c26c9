"""``campaign.toml``: what it says arrives in SI, what it gets wrong is one clear error."""

from __future__ import annotations

import os
import re
from pathlib import Path

import numpy as np
import pytest

from discover.readers import read_campaign
from models.checks import InputError
from models.device import Device
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

REAL = Path(__file__).resolve().parents[4] / "shared" / "real-data"

FULL = """
title = "Device [12], sine tests"
[device]
rod_radius = "12 mm"
cylinder_radius = "28 mm"
channel_radius = "5 mm"
helix_radius = "100 mm"
helix_pitch = "12 mm"
turns = 14
transition_length = "100 mm"
piston_clearance = "0.1 mm"
inertance = "370.38 kg"
coulomb_friction = "400 N"
[device.fluid]
density = "800 kg/m^3"
viscosity = "27 mPa*s"
[rig]
max_stroke = "25 mm"
max_speed = "0.5 m/s"
max_acceleration = "5 g_0"
max_force = "20 kN"
[system]
mass = "250 kg"
stiffness = "20 kN/m"
input = "base_acceleration"
[[records]]
file = "sub/a.csv"
frequency = "1.5 Hz"
amplitude = "10 mm"
[[records]]
file = "b.csv"
frequency = "90 rpm"
held_out = true
"""


def _full(folder: Path) -> Path:
    campaign(folder, toml=FULL, file="b.csv")
    header = HEADER + ",base_acceleration [m/s^2]"
    content = header + "\n" + rows(TIME, DISPLACEMENT, FORCE, np.cos(TIME))
    campaign(folder / "sub", content)
    return folder


def test_everything_in_the_contract_arrives_in_si(tmp_path: Path) -> None:
    found = read_campaign(_full(tmp_path / "c"))
    assert found.title == "Device [12], sine tests"
    assert found.device.rod_radius == 0.012
    assert found.device.piston_clearance == 1e-4
    assert found.device.fluid.viscosity == pytest.approx(0.027, rel=1e-12)
    assert (found.device.inertance, found.device.inertance_source) == (370.38, "measured")
    assert found.device.computed_inertance == Device.preset("device-12").computed_inertance
    assert found.rig.max_acceleration == pytest.approx(5 * 9.80665, rel=1e-12)
    assert (found.rig.max_stroke, found.rig.max_force) == (0.025, 20000.0)
    assert (found.system.mass, found.system.stiffness) == (250.0, 20000.0)
    first, second = found.records
    assert (first.frequency, first.amplitude, first.held_out) == (1.5, 0.01, False)
    assert second.frequency == pytest.approx(1.5)
    assert found.fitted == (first,)
    assert found.held_out == (second,)
    assert found.source == str(tmp_path / "c")
    assert found.findings == ()


def test_preset_may_be_amended(tmp_path: Path) -> None:
    toml = '[device]\npreset = "device-10"\nturns = 8\n[device.fluid]\nviscosity = "6.8 cP"\n' + ONE
    found = read_campaign(campaign(tmp_path / "c", toml=toml)).device
    assert found.turns == 8
    assert found.fluid.viscosity == pytest.approx(0.0068, rel=1e-12)
    assert found.fluid.density == 802.0


def test_the_toml_itself_may_be_named_and_the_title_left_out(tmp_path: Path) -> None:
    folder = campaign(tmp_path / "summer", toml=b"\xef\xbb\xbf" + ONE.encode())
    found = read_campaign(folder / "campaign.toml")
    assert found.title == "summer"
    assert found.content_hash == read_campaign(str(folder)).content_hash


def test_hash_depends_on_the_bytes_and_not_on_the_place(tmp_path: Path) -> None:
    first = read_campaign(campaign(tmp_path / "a"))
    again = read_campaign(campaign(tmp_path / "b"))
    more = read_campaign(campaign(tmp_path / "c", PLAIN + "10.0,0,0\n"))
    renamed = read_campaign(campaign(tmp_path / "d", toml=ONE + "\n"))
    assert re.fullmatch("[0-9a-f]{64}", first.content_hash)
    assert first.content_hash == again.content_hash
    assert len({first.content_hash, more.content_hash, renamed.content_hash}) == 3


@pytest.mark.parametrize(
    ("toml", "message"),
    [
        ("[[records]\n", r"campaign.toml is not valid TOML: Expected .*line 1"),
        ('title = "\xb5"'.encode("latin-1"), "campaign.toml must be in UTF-8"),
        ("title = 3\n" + ONE, "campaign.toml: title must be text of at most 400 characters, got 3"),
        ('titel = "x"\n' + ONE, r"key 'titel' must be one of title, .* \(did you mean 'title'\?\)"),
        ('title = "x"\n', r"campaign.toml: \[\[records\]\] must be at least one table .* got none"),
        ('records = "a.csv"\n', r"\[\[records\]\] must be at least one table"),
        ('records = ["a.csv"]\n', r"\[\[records\]\] 1 must be a table, got 'a.csv'"),
        (ONE + 'frequncy = "1 Hz"\n', r"\[\[records\]\] 1: key 'frequncy' .* mean 'frequency'"),
        (ONE + ONE, r"\[\[records\]\] 2: file must be listed once, got 'a.csv' again"),
        ("[[records]]\nheld_out = true\n", r"file must be a file's name, got None"),
        (ONE + "frequency = 5\n", 'frequency must be a number with a unit .* "1 Hz", got 5'),
        (ONE + 'frequency = "5"\n', "frequency must be a number with a unit .*, got '5'"),
        (ONE + 'frequency = "5 s"\n', "frequency must be .* got 's', a unit of time"),
        (ONE + 'frequency = "-5 Hz"\n', "frequency must be a finite number > 0.0, got -5.0"),
        (ONE + 'amplitude = "1e999 mm"\n', "amplitude must be a finite number, got inf"),
        (ONE + 'amplitude = "nan mm"\n', "amplitude must be a number with a unit"),
        (ONE + 'held_out = "yes"\n', "held_out must be true or false, got 'yes'"),
        ('device = "device-12"\n' + ONE, r"\[device\] must be a table, got 'device-12'"),
        ('[device]\npreset = "device-13"\n' + ONE, r"\[device\]: preset must be one of device-12"),
        ("[device]\npreset = 12\n" + ONE, r"\[device\]: preset must be text, got 12"),
        ('[device]\nrod_radus = "1 mm"\n' + ONE, r"key 'rod_radus' .* mean 'rod_radius'"),
        ('[device]\nrod_radius = "1 mm"\n' + ONE, r"\[device\]: cylinder_radius must be given"),
        ('[device]\nrod_radius = "1 kg"\n' + ONE, "rod_radius must be .* a unit of mass"),
        ("[device]\nrod_radius = 12\n" + ONE, "rod_radius must be a number with a unit of length"),
        ('[device]\npreset = "device-12"\nturns = "14"\n' + ONE, "turns must be a finite number"),
        ('[device]\npreset = "device-12"\nrod_radius = "30 mm"\n' + ONE,
         r"campaign.toml \[device\]: rod_radius must be below the cylinder_radius"),
        ('[device]\npreset = "device-12"\nhelix_pitch = "5 mm"\n' + ONE,
         "helix_pitch must be at least the channel's diameter"),
        ('[device]\npreset = "device-12"\n[device.fluid]\nviscosity = "27 mm^2/s"\n' + ONE,
         r"\[device.fluid\]: viscosity must be .* a unit of kinematic viscosity"),
        ('[device]\npreset = "device-12"\n[device.fluid]\nviscosty = "1 Pa*s"\n' + ONE,
         r"\[device.fluid\]: key 'viscosty' .* mean 'viscosity'"),
        ('[rig]\ntitle = "x"\n' + ONE, r"key 'title' .* campaign stands above the first \[table\]"),
        ('[rig]\nmax_strok = "1 mm"\n' + ONE, r"\[rig\]: key 'max_strok' .* mean 'max_stroke'"),
        ('[rig]\nmax_stroke = "-1 mm"\n' + ONE, r"\[rig\]: max_stroke must be a finite number > 0"),
        ('[rig]\nmax_acceleration = "5 g"\n' + ONE, r"a unit of mass \(standard gravity is g_0\)"),
        ('[system]\nmass = "1 kg"\n' + ONE, r"\[system\]: stiffness must be given, got nothing"),
        ('[system]\nmass = "1 kg"\nstiffness = "1 N/m"\ninput = "base"\n' + ONE,
         r"\[system\]: input must be one of base_acceleration, applied_force, got 'base'"),
        ('[columns]\nforces = "F"\n' + ONE, r"\[columns\]: key 'forces' .* mean 'force'"),
        ("[columns]\nforce = 3\n" + ONE, r"\[columns\]: force must be a header's text, got 3"),
        ('[columns]\nforce = "Q"\n' + ONE, r"a.csv: column 'Q' for force must be among the head"),
        ('[columns]\ntemperature = "Q"\n' + ONE, "temperature must be in a column 'Q' of at least"),
        ('[units]\nforce = "m"\n' + ONE,
         r"\[units\]: force must be in a unit of force such as 'N', got 'm', a unit of length"),
        ('[units]\nforce = "Nm"\n' + ONE, "a unit of torque .* rotary machine give N m"),
        ('[units]\ndisplacement = "deg"\n' + ONE, "a unit of angle .of a rotary .* rad as m"),
        ("[units]\nforce = 1\n" + ONE, r"\[units\]: force must be in a unit .* got 1"),
        ('[units]\nforse = "N"\n' + ONE, r"\[units\]: key 'forse' .* mean 'force'"),
    ],
)  # fmt: skip
def test_toml_that_is_wrong_is_one_error_that_says_where(
    tmp_path: Path, toml: str | bytes, message: str
) -> None:
    with pytest.raises(InputError, match=message) as caught:
        read_campaign(campaign(tmp_path / "c", toml=toml))
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("name", "found"),
    [
        ("b.csv", r"got nothing there \(did you mean 'a.csv'\?\)"),
        ("../outside.csv", "got outside of it"),
        ("sub/../../outside.csv", "got outside of it"),
        ("{root}/outside.csv", "got outside of it"),
        ("link.csv", "got outside of it"),
        ("links/outside.csv", "got outside of it"),
        ("loop.csv", "loop"),
        (".", "got a folder"),
        ("a\\u0000.csv", "null (byte|character)"),  # as Python says it
        ("a" * 3000 + ".csv", "File name too long"),
        ("fifo.csv", "got a pipe"),
    ],
)
def test_paths_stay_inside_the_folder(tmp_path: Path, name: str, found: str) -> None:
    (tmp_path / "outside.csv").write_text(PLAIN)
    toml = f'[[records]]\nfile = "{name.format(root=tmp_path)}"\n'
    folder = campaign(tmp_path / "c", toml=toml)
    (folder / "link.csv").symlink_to(tmp_path / "outside.csv")
    (folder / "links").symlink_to(tmp_path)
    (folder / "loop.csv").symlink_to(folder / "loop.csv")
    os.mkfifo(folder / "fifo.csv")
    with pytest.raises(InputError, match=f"must be in the campaign folder, .*({found})") as caught:
        read_campaign(folder)
    assert len(str(caught.value)) < 300


def test_links_inside_the_folder_are_fine(tmp_path: Path) -> None:
    folder = campaign(tmp_path / "c", toml='[[records]]\nfile = "link.csv"\n')
    (folder / "link.csv").symlink_to(folder / "a.csv")
    (tmp_path / "campaign-link").symlink_to(folder)
    assert read_campaign(tmp_path / "campaign-link").records[0].time.size == TIME.size


def test_toml_outside_the_folder_is_refused(tmp_path: Path) -> None:
    outside = campaign(tmp_path / "outside")
    (tmp_path / "c").mkdir()
    (tmp_path / "c" / "campaign.toml").symlink_to(outside / "campaign.toml")
    with pytest.raises(InputError, match="'campaign.toml' must be in the campaign folder"):
        read_campaign(tmp_path / "c")


def test_a_folder_that_is_none(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="nowhere must be a campaign folder, .* got nothing"):
        read_campaign(tmp_path / "nowhere")
    (tmp_path / "notes.md").write_text("")
    with pytest.raises(InputError, match="notes.md must be a campaign folder.* got a file of"):
        read_campaign(tmp_path / "notes.md")
    (tmp_path / "empty").mkdir()
    with pytest.raises(InputError, match="'campaign.toml' must be .*`inerter init .*empty` wr"):
        read_campaign(tmp_path / "empty")


def test_system_without_its_column_and_shared_findings_are_told_once(tmp_path: Path) -> None:
    bare = PLAIN.replace("[kN]", "")
    folder = campaign(tmp_path / "c", bare, file="b.csv")
    system = '[system]\nmass = "1 kg"\nstiffness = "1 N/m"\ninput = "applied_force"\n'
    campaign(folder, bare, toml=system + ONE + ONE.replace("a.csv", "b.csv"))
    units, missing = read_campaign(folder).findings
    assert units.text.startswith("all records: no unit is stated for force, N taken")
    assert units.record is None
    assert "no record has that column" in missing.text


def test_arrays_are_frozen_and_read_afresh(tmp_path: Path) -> None:
    folder = _full(tmp_path / "c")
    record = read_campaign(folder).records[0]
    with pytest.raises(ValueError, match="read-only"):
        record.force[0] = 1.0
    np.testing.assert_array_equal(record.force, read_campaign(folder).records[0].force)


@pytest.mark.parametrize(
    ("name", "sizes", "step"),
    [("emps", [24841], 1e-3), ("silverbox", [86750, 40000], 1.0 / 610.3515625)],
)
def test_measured_campaigns(name: str, sizes: list[int], step: float) -> None:
    if not (REAL / name).is_dir():
        pytest.skip(f"{REAL} is not beside the checkout")
    found = read_campaign(REAL / name)
    assert [r.time.size for r in found.records] == sizes
    for record in found.records:
        assert record.uniform
        assert record.step == pytest.approx(step, rel=1e-7)
    assert found.findings == ()  # the multisine's times are rounded to 1 us: no jitter

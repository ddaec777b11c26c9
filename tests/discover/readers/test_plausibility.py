"""Units that make no sense are warned of, with the one that would; what makes sense is not."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from discover.cli import main
from discover.readers import read_campaign

DEVICE = '[device]\npreset = "device-12"\n'  # 370 kg
TIME = np.arange(4000) / 1000.0


def _folder(
    folder: Path,
    *,
    header: str = "time [s],displacement [m],force [N]",
    scale: tuple[float, float, float] = (1.0, 1.0, 1.0),
    head: str = "",
    stroke: float = 0.008,
) -> Path:
    """Three sine tests of an inerter of 370 kg whose columns are written times a scale each."""
    toml = head
    for index, frequency in enumerate((2.0, 3.0, 4.5)):
        w = 2 * np.pi * frequency
        x = stroke * np.sin(w * TIME)
        force = -370.0 * w**2 * x + 900.0 * stroke * w * np.cos(w * TIME)
        columns = [c * s for c, s in zip((TIME, x, force), scale, strict=True)]
        np.savetxt(
            folder / f"{index}.csv", np.column_stack(columns), delimiter=",", header=header,
            comments="", fmt="%.9g",
        )  # fmt: skip
        toml += f'[[records]]\nfile = "{index}.csv"\n'
    (folder / "campaign.toml").write_text(toml)
    return folder


def _told(folder: Path) -> list[str]:
    found = [f for f in read_campaign(folder).findings if f.level != "note"]
    assert all(f.level == "warning" for f in found)
    return [f.text for f in found if "no unit is stated" not in f.text]


@pytest.mark.parametrize("head", ["", DEVICE])
def test_what_makes_sense_is_not_warned_of(tmp_path: Path, head: str) -> None:
    assert _told(_folder(tmp_path, head=head)) == []


@pytest.mark.parametrize(
    ("read", "scale", "asked"),
    [
        ("s, m, N", (1e3, 1.0, 1.0), "is time in ms where s was read"),
        ("s, m, N", (1e9, 1.0, 1.0), "is time in ns where s was read"),
        ("ms, m, N", (1.0, 1.0, 1.0), "is time in s where ms was read"),
        ("s, m, N", (1e-3, 1.0, 1.0), "are the values of time 1000 times too small"),
        ("s, m, N", (1.0, 1e3, 1.0), "is displacement in mm where m was read"),
        ("s, mm, N", (1.0, 1.0, 1.0), "is displacement in m where mm was read"),
        ("s, mm, N", (1.0, 1e6, 1.0), "is displacement in µm where mm was read"),
        ("s, m, N", (1.0, 1e-3, 1.0), "are the values of displacement 1000 times too small"),
        ("s, m, N", (1.0, 1.0, 1e-3), "is force in kN where N was read"),
        ("s, m, kN", (1.0, 1.0, 1.0), "is force in N where kN was read"),
        ("s, m, 1e3 N", (1.0, 1.0, 1.0), "is force in N where 1e3 N was read"),
        ("s, m, N", (1.0, 1.0, 1e3), "is force in mN where N was read"),
    ],
)
def test_a_slip_in_all_records_of_a_known_device(
    tmp_path: Path, read: str, scale: tuple[float, float, float], asked: str
) -> None:
    time, displacement, force = read.split(", ")
    header = f"time [{time}],displacement [{displacement}],force [{force}]"
    (text,) = _told(_folder(tmp_path, header=header, head=DEVICE, scale=scale))
    assert text.startswith("all records: ")
    assert asked in text


def test_an_amplitude_that_makes_no_sense_tells_millimetres_from_kilonewtons(
    tmp_path: Path,
) -> None:
    (text,) = _told(_folder(tmp_path, head=DEVICE, scale=(1.0, 1e3, 1.0)))
    assert "the displacement's amplitude is 8 m; the apparent inertance is 0.37 kg" in text
    assert "kN" not in text


def test_millimetres_without_a_unit(tmp_path: Path) -> None:
    header = "time [s],displacement,force [N]"
    (text,) = _told(_folder(tmp_path, header=header, scale=(1.0, 1e3, 1.0)))
    assert "amplitude is 8 m: is displacement in mm where m was read? It would make" in text


def test_nanoseconds_that_parquet_does_not_name(tmp_path: Path) -> None:
    """What pandas writes of time stamps that were made whole numbers."""
    speed = 2 * np.pi * 3.0
    x = 0.008 * np.sin(speed * TIME)
    stamps = pd.to_datetime(np.round(1e9 * TIME)).astype("datetime64[ns]").astype("int64")
    columns = {"time": stamps, "displacement [m]": x, "force [N]": -370.0 * speed**2 * x}
    pd.DataFrame(columns).to_parquet(tmp_path / "a.parquet")
    (tmp_path / "campaign.toml").write_text('[[records]]\nfile = "a.parquet"\n')
    (text,) = _told(tmp_path)
    assert "is time in ns where s was read? It would make sense" in text


def test_milliseconds_labelled_seconds_without_a_device(tmp_path: Path) -> None:
    (text,) = _told(_folder(tmp_path, scale=(1e3, 1.0, 1.0)))
    assert "sampling interval is 1 s" in text
    assert "is time in ms where s was read? It would make sense" in text


def test_a_rig_can_not_have_done_it(tmp_path: Path) -> None:
    head = '[rig]\nmax_stroke = "25 mm"\nmax_force = "20 kN"\n'
    (text,) = _told(_folder(tmp_path, head=head, scale=(1.0, 50.0, 1.0)))
    assert "the displacement's amplitude is 0.4 m, beyond the rig's 0.025 m" in text


@pytest.mark.parametrize("scale", [1e-3, 1.0, 30.0])
def test_a_device_of_any_size_without_inertia_is_never_accused(
    tmp_path: Path, scale: float
) -> None:
    """A damper's force says nothing of inertance."""
    toml = DEVICE
    for index, frequency in enumerate((0.5, 1.0)):
        w = 2 * np.pi * frequency
        x, v = 0.01 * np.sin(w * TIME), 0.01 * w * np.cos(w * TIME)
        force = scale * (2e4 * v + 300.0 * np.sign(v) + 2e4 * x)
        header = "time [s],displacement [m],force [N]"
        columns = np.column_stack([TIME, x, force])
        path = tmp_path / f"{index}.csv"
        np.savetxt(path, columns, delimiter=",", header=header, comments="")
        toml += f'[[records]]\nfile = "{index}.csv"\n'
    (tmp_path / "campaign.toml").write_text(toml)
    assert _told(tmp_path) == []


def test_no_test_is_proposed_in_a_unit_that_is_in_doubt(
    tmp_path: Path, undrawn: None, capsys: pytest.CaptureFixture[str]
) -> None:
    """Of one frequency, so that structures are left open; a displacement in mm without a unit."""
    w = 2 * np.pi * 2.0
    x, v = 10.0 * np.sin(w * TIME), 10.0 * w * np.cos(w * TIME)
    force = -0.2 * w**2 * x + 9.0 * v + np.random.default_rng(0).standard_normal(TIME.size)
    table = np.column_stack([TIME, x, force])
    for name, unit in (("doubted", ""), ("stated", " [mm]")):
        header = f"time [s],displacement{unit},force [N]"
        folder = tmp_path / name
        folder.mkdir()
        np.savetxt(folder / "a.csv", table, delimiter=",", header=header, comments="", fmt="%.9g")
        (folder / "campaign.toml").write_text('[[records]]\nfile = "a.csv"\n')
    said = {}
    for name in ("doubted", "stated"):
        for verb in ("check", "discover"):
            assert main([verb, str(tmp_path / name), "-o", str(tmp_path / f"{name}-{verb}")]) == 0
            said[name, verb] = capsys.readouterr().out
    assert "is displacement in mm where m was read?" in said["doubted", "check"]
    assert "Next: see whether the unit in question is right" in said["doubted", "check"]
    assert "Next test: none proposed while a unit is in doubt." in said["doubted", "discover"]
    assert "Next: add a test at 1 Hz and 10 mm" in said["stated", "check"]
    assert "Next test: none" not in said["stated", "discover"]

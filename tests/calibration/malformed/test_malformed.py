"""Whatever a model file or a campaign holds, the command ends in a result or in clear lines."""

from __future__ import annotations

import resource
import time
from pathlib import Path

import pytest

from discover.cli import main
from tests.calibration.malformed.campaigns import WHOLE, malformed_campaign, record, toml_text
from tests.calibration.malformed.models import malformed_model

LONGEST_LINE = 2000
MOST_SECONDS = 60.0
MOST_KILOBYTES = 2_000_000


def _ends_well(arguments: list[str], capsys: pytest.CaptureFixture[str], what: str) -> int:
    began = time.process_time()
    code = main(arguments)
    taken = time.process_time() - began
    out, err = capsys.readouterr()
    assert code in (0, 1, 2), f"{what}: exit {code}: {err[:300]}"
    assert "Traceback" not in err + out, what
    lines = (out + err).splitlines()
    assert max((len(line) for line in lines), default=0) <= LONGEST_LINE, what
    assert all(line.replace("\u202f", " ").isprintable() for line in lines), what
    assert (code == 2) == err.startswith("inerter: "), f"{what}: exit {code}: {err[:300]}"
    assert taken < MOST_SECONDS, f"{what}: {taken:.0f} s"
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss < MOST_KILOBYTES, what
    return code


@pytest.fixture
def sound(tmp_path: Path) -> Path:
    """The campaign that the malformed ones come from."""
    folder = tmp_path / "sound"
    folder.mkdir()
    (folder / "campaign.toml").write_text(toml_text(WHOLE))
    for index in range(3):
        (folder / f"{index}.csv").write_bytes(record(1.0 + index))
    return folder


def _models(seeds: range, sound: Path, capsys: pytest.CaptureFixture[str]) -> list[int]:
    path = sound.parent / "model.json"
    codes = []
    for seed in seeds:
        path.write_bytes(malformed_model(seed))
        arguments = ["simulate", str(path), str(sound), "-o", str(sound.parent / "out")]
        codes.append(_ends_well(arguments, capsys, f"model {seed}"))
    return codes


def _campaigns(seeds: range, folder: Path, capsys: pytest.CaptureFixture[str]) -> list[int]:
    codes = []
    for seed in seeds:
        campaign = folder / f"campaign-{seed}"
        campaign.mkdir()
        malformed_campaign(campaign, seed)
        arguments = ["check", str(campaign), "-o", str(folder / "out")]
        codes.append(_ends_well(arguments, capsys, f"campaign {seed}"))
    return codes


def test_the_campaign_that_the_malformed_ones_come_from_is_sound(
    sound: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert _ends_well(["check", str(sound), "-o", str(sound.parent / "out")], capsys, "sound") == 0


def test_malformed_models(sound: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert _models(range(30), sound, capsys).count(2) > 15


@pytest.mark.slow
def test_malformed_campaigns(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert _campaigns(range(100), tmp_path, capsys).count(2) > 40


@pytest.mark.sweep
def test_more_malformed_models(sound: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert _models(range(30, 130), sound, capsys).count(2) > 50


@pytest.mark.sweep
@pytest.mark.parametrize("first", [100, 150])
def test_more_malformed_campaigns(
    tmp_path: Path, first: int, capsys: pytest.CaptureFixture[str]
) -> None:
    assert _campaigns(range(first, first + 50), tmp_path, capsys).count(2) > 20

"""Campaign folders for tests, written as a user would."""

from __future__ import annotations

from pathlib import Path

import numpy as np

TIME = np.arange(2000) / 200.0
DISPLACEMENT = 10.0 * np.sin(2 * np.pi * 1.5 * TIME)  # mm
VELOCITY = 30.0 * np.pi * np.cos(2 * np.pi * 1.5 * TIME)  # mm/s
FORCE = np.sin(2 * np.pi * 1.5 * TIME + 0.3)  # kN
HEADER = "time [s],displacement [mm],force [kN]"
ONE = '[[records]]\nfile = "a.csv"\n'


def rows(*columns: np.ndarray, sep: str = ",", end: str = "\n") -> str:
    """Return columns as lines of text."""
    return "".join(sep.join(f"{v:.9g}" for v in row) + end for row in zip(*columns, strict=True))


PLAIN = HEADER + "\n" + rows(TIME, DISPLACEMENT, FORCE)


def campaign(
    folder: Path,
    content: str | bytes = PLAIN,
    *,
    toml: str | bytes = ONE,
    file: str = "a.csv",
) -> Path:
    """Write a campaign of one record and return its folder."""
    folder.mkdir(exist_ok=True)
    (folder / file).write_bytes(content if isinstance(content, bytes) else content.encode())
    (folder / "campaign.toml").write_bytes(toml if isinstance(toml, bytes) else toml.encode())
    return folder

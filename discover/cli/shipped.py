"""The campaign that ships with the package."""

from __future__ import annotations

from pathlib import Path

import discover
from models.checks import InputError

NAME = "device-12-rig"


def shipped_campaign() -> Path:
    """Return the shipped campaign's folder: inside the installed package, else the checkout's.

    Raises
    ------
    InputError
        Where neither has it.
    """
    package = Path(discover.__file__).parent
    for folder in (package / "_data" / NAME, package.parent / "data" / NAME):
        if (folder / "campaign.toml").is_file():
            return folder
    raise InputError("the shipped campaign", expected="installed with the package", found="none")

"""The campaigns that ship with the package."""

from __future__ import annotations

from pathlib import Path

import discover
from models.checks import InputError

CLEAR = "segmented"
"""A device whose answer is plain: what a first run studies."""
HIDDEN = "hidden-effect"
"""One with something in it that its model lacks."""
HIDDEN_MODEL = "ioim-laminar"
"""The model that lacks it."""


def shipped_campaign(name: str = CLEAR) -> Path:
    """Return a shipped campaign's folder: inside the installed package, else the checkout's.

    Parameters
    ----------
    name : str
        Of the folder.

    Raises
    ------
    InputError
        Where neither has it.
    """
    package = Path(discover.__file__).parent
    for folder in (package / "_data" / name, package.parent / "data" / name):
        if (folder / "campaign.toml").is_file():
            return folder
    raise InputError(
        f"the shipped campaign {name}", expected="installed with the package", found="none"
    )

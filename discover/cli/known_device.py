"""A device by name: a preset, or the one that a campaign states."""

from __future__ import annotations

from pathlib import Path

from models.checks import InputError
from models.device import PRESETS, Device


def known_device(name: str, *, where: str = "--device") -> Device:
    """Return a preset, or the device of a campaign's folder.

    Raises
    ------
    InputError
        For a name that is neither, or a campaign without a device.

    Examples
    --------
    >>> known_device("device-10").turns
    7
    """
    if name in PRESETS:
        return Device.preset(name)
    if not Path(name).exists():
        raise InputError(
            "device",
            expected="one of " + ", ".join(PRESETS) + ", or a campaign's folder",
            found=name,
            where=where,
        )
    from discover.readers import read_campaign

    device = read_campaign(name).device
    if device is None:
        raise InputError("campaign", expected="one with a [device] table", found=name, where=where)
    return device

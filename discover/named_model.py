"""Models by name: a ``model.json``, or one of the paper's forms with its values for a device."""

from __future__ import annotations

import json
from pathlib import Path

from models.checks import InputError, nearest
from models.constitutive import (
    Band,
    ForceModel,
    SegmentedModel,
    foim,
    ioim_laminar,
    ioim_turbulent,
    sfoim,
)
from models.device import Device

FROM_GEOMETRY = ("ioim-laminar", "ioim-turbulent")
"""Models whose coefficients follow from a device's geometry."""
NAMES = (*FROM_GEOMETRY, "foim", "sfoim")
"""All models that have a name."""

# (b0, order) as the paper identified them: M1 (0.5 Hz), M2 (12 Hz) and M3 (3 Hz).
_ABOVE = {"device-12": (0.57, 1.89), "device-10": (0.087, 1.98)}
_BELOW = {"device-12": (18.25, 0.48)}


def named_model(name: str, device: Device | None, *, where: str = "--model") -> SegmentedModel:
    """Return a model from its name or file.

    Parameters
    ----------
    name : str
        ``ioim-laminar``, ``ioim-turbulent`` (coefficients from the device's geometry), ``foim``,
        ``sfoim`` (the paper's b0 and order, for its two devices), or the path of a ``model.json``.
    device : Device or None
        Needed by the names.
    where : str
        What an error names as the place.

    Raises
    ------
    InputError
        For an unknown name, a file that holds no model, or a name without its device.

    Examples
    --------
    >>> model = named_model("sfoim", Device.preset("device-12"))
    >>> [band.model.terms[0].shape["order"] for band in model.bands]
    [0.48, 1.89]
    """
    if name not in NAMES:
        return _from_file(name, where=where)
    if device is None:
        raise InputError(
            name, expected="used with a device ([device] of campaign.toml; `fit:` needs none)",
            found="none", where=where,
        )  # fmt: skip
    if name.startswith("ioim"):
        make = ioim_laminar if name == "ioim-laminar" else ioim_turbulent
        if device.coulomb_friction is not None:
            return _one_band(make(device), device)
        frictionless = make(device, friction=0.0)
        terms = tuple(t for t in frictionless.terms if t.id != "coulomb-friction")
        return _one_band(ForceModel(terms, frictionless.name), device)
    known = _ABOVE if name == "foim" else _BELOW
    if device.name not in known:
        raise InputError(
            f"{name} with the paper's values",
            expected="used with " + " or ".join(known),
            found=device.name or "another device",
            where=where,
        )
    above = _ABOVE[device.name]
    if name == "foim":
        return _one_band(foim(device, *above), device)
    return sfoim(device, _BELOW[device.name], above)


def paper_values(name: str, device: Device | None) -> bool:
    """Tell whether the paper has b0 and order of a fractional model for a device.

    Examples
    --------
    >>> paper_values("sfoim", Device.preset("device-10"))
    False
    """
    known = {"foim": _ABOVE, "sfoim": _BELOW}.get(name, {})
    return device is not None and device.name in known


def left_out(name: str, device: Device | None) -> tuple[str, ...]:
    """Return in words what a model by name lacks, for want of a value of the device.

    Examples
    --------
    >>> left_out("ioim-laminar", Device.preset("device-12"))
    ()
    """
    if device is None or name not in FROM_GEOMETRY:
        return ()
    notes = []
    if device.coulomb_friction is None:
        notes.append(f"{name} is without Coulomb friction: the device has no coulomb_friction.")
    if name == "ioim-turbulent" and device.piston_clearance is None:
        notes.append(f"{name} is without its film term: the device has no piston_clearance.")
    return tuple(notes)


def _one_band(model: ForceModel, device: Device) -> SegmentedModel:
    return SegmentedModel((Band(None, None, model),), "speed", "paper", device, model.name)


def _from_file(name: str, *, where: str) -> SegmentedModel:
    path = Path(name)
    if not path.is_file():
        if path.suffix or len(path.parts) > 1:
            raise InputError("no such file", where=f"{where} {name}")
        raise InputError(
            "model",
            expected="one of " + ", ".join(NAMES) + ", or a model.json",
            found=name + nearest(name, NAMES),
            where=where,
        )
    try:
        table = json.loads(path.read_text(encoding="utf-8-sig"))
    except (ValueError, RecursionError) as error:  # of integers of 5,000 digits and of nesting too
        raise InputError("not valid JSON", found=str(error), where=name) from None
    if not isinstance(table, dict):
        raise InputError("model", expected="a JSON object", found=type(table).__name__, where=name)
    return SegmentedModel.from_dict(table, where=name)

"""Models by band of the Dean number, speed or frequency, and the document they are stored in."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

from models.checks import InputError, one_of, shown, stored_number
from models.constitutive.model import ForceModel, stored_text
from models.device import Device

SCHEMA = "inerter.model/1"
"""Of the document that a model is stored in."""
COORDINATES = ("dean", "speed", "frequency")
"""What bands lie on."""


@dataclass(frozen=True)
class Band:
    """A range of the coordinate and the model that holds there.

    Examples
    --------
    >>> from models.constitutive import FittedTerm
    >>> band = Band(None, 100.0, ForceModel((FittedTerm("inertia", 60.0),)))
    >>> band.upper
    100.0
    """

    lower: float | None
    """Lower end of the coordinate; None where open."""
    upper: float | None
    """Upper end of the coordinate; None where open."""
    model: ForceModel
    """The model inside."""


@dataclass(frozen=True)
class SegmentedModel:
    """Models by band of the Dean number, speed amplitude or frequency (Eq. 11).

    Examples
    --------
    >>> from models.constitutive import FittedTerm
    >>> slow, fast = (ForceModel((FittedTerm("viscous-damping", c),)) for c in (900.0, 700.0))
    >>> model = SegmentedModel((Band(None, 0.02, slow), Band(0.02, None, fast)), "speed")
    >>> model.at(0.05).coefficient("viscous-damping")
    700.0
    """

    bands: tuple[Band, ...]
    """In rising order, without gaps."""
    coordinate: str
    """"dean", "speed" (m/s amplitude) or "frequency" (Hz)."""
    convention: str = "paper"
    """Convention of the Dean number."""
    device: Device | None = None
    """Needed for the Dean number; optional otherwise."""
    name: str = ""
    """For legends and tables."""
    added: tuple[str, ...] = ()
    """Ids of the last terms of every band, where a search for missing effects added them."""

    def at(self, coordinate: float) -> ForceModel:
        """Return the model of the band that holds `coordinate`.

        Parameters
        ----------
        coordinate : float
            Dean number, speed amplitude (m/s) or frequency (Hz), as the model's `coordinate` says.
        """
        for band in self.bands:
            if band.upper is None or coordinate < band.upper:
                return band.model
        return self.bands[-1].model

    def to_dict(self) -> dict[str, Any]:
        """Return the document ``model.json`` without its header."""
        result: dict[str, Any] = {
            "name": self.name,
            "convention": self.convention,
            "bands": [
                {
                    "name": b.model.name,
                    "lower": b.lower,
                    "upper": b.upper,
                    "coordinate": self.coordinate,
                    "terms": b.model.to_dict()["terms"],
                }
                for b in self.bands
            ],
        }
        if self.added:
            result["added"] = list(self.added)
        if self.device is not None:
            result["device"] = self.device.to_dict()
        return result

    @classmethod
    def from_dict(cls, data: Mapping[str, Any], *, where: str = "") -> SegmentedModel:
        """Read what `to_dict` wrote.

        Parameters
        ----------
        data : mapping
            The document ``model.json``.
        where : str
            What an error names as the place.

        Raises
        ------
        InputError
            For what is no such document.
        """
        schema = data.get("schema", SCHEMA)
        if schema != SCHEMA:
            raise InputError("schema", expected=repr(SCHEMA), found=shown(schema), where=where)
        listed = data.get("bands")
        if not isinstance(listed, list | tuple) or not listed:
            raise InputError("bands", expected="a list of bands", found=shown(listed), where=where)
        device = data.get("device")
        if device is not None:
            device = Device.from_dict(device, where=f"{where} device".strip())
        bands = tuple(_band(table, where) for table in listed)
        for below, above in pairwise(bands):
            if below.upper is None or above.lower is None or above.lower < below.upper:
                found = f"one up to {below.upper}, then one from {above.lower}"
                raise InputError("bands", expected="in rising order", found=found, where=where)
        coordinates = {stored_text(table, "coordinate", where, "speed") for table in listed}
        if len(coordinates) > 1:
            found = " and ".join(sorted(coordinates))
            raise InputError("coordinate", expected="one for all bands", found=found, where=where)
        (coordinate,) = coordinates
        one_of("coordinate", coordinate, COORDINATES, where=where)
        convention = stored_text(data, "convention", where, "paper")
        one_of("convention", convention, ("paper", "standard"), where=where)
        added = _added(data.get("added", []), bands, where)
        return cls(bands, coordinate, convention, device, stored_text(data, "name", where), added)


def _band(table: Any, where: str) -> Band:
    """Return one band of a document."""
    if not isinstance(table, Mapping):
        raise InputError("a band", expected="a table", found=shown(table), where=where)
    lower, upper = (
        None if table.get(key) is None else stored_number(key, table[key], where=where)
        for key in ("lower", "upper")
    )
    if lower is not None and upper is not None and not lower < upper:
        raise InputError(
            "band", expected="with lower below upper", found=f"{lower:g} to {upper:g}", where=where
        )
    return Band(lower, upper, ForceModel.from_dict(table, where=where))


def _added(ids: Any, bands: Sequence[Band], where: str) -> tuple[str, ...]:
    if not isinstance(ids, list):
        raise InputError("added", expected="a list of ids", found=shown(ids), where=where)
    if not all(isinstance(name, str) for name in ids):
        raise InputError("added", expected="a list of ids", found=shown(ids), where=where)
    for band in bands:
        last = [t.id for t in band.model.terms][len(band.model.terms) - len(ids) :]
        if last != ids:
            raise InputError(
                "added",
                expected="the ids of the last terms of every band",
                found=shown(ids),
                where=where,
            )
    return tuple(ids)

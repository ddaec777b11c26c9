"""Values of a campaign: its records, limits of the rig, what was found on reading."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from os import PathLike
from typing import Any

import numpy as np

from discover.answer_html import answer_html
from discover.records.finding import Finding
from discover.records.record import Record
from discover.words import quantity
from models.checks import InputError, shown
from models.device import Device


@dataclass(frozen=True)
class RigLimits:
    """What the rig can do; None where not stated."""

    max_stroke: float | None = None
    """m, displacement amplitude."""
    max_speed: float | None = None
    """m/s."""
    max_acceleration: float | None = None
    """m/s^2."""
    max_force: float | None = None
    """N."""


@dataclass(frozen=True)
class CarriedSystem:
    """The mass and spring that the device works in, for judging a model by its motion."""

    mass: float
    """kg."""
    stiffness: float
    """N/m."""
    input: str
    """"base_acceleration" or "applied_force": the column that drives it."""


@dataclass(frozen=True, repr=False)
class Campaign:
    """Records of one device: of a folder with its ``campaign.toml``, or from memory.

    `discover.read_campaign` reads one, `from_frames` makes one.

    Examples
    --------
    >>> time = np.arange(400) / 100.0
    >>> table = {"time": time, "displacement": np.sin(6.0 * time), "force": np.cos(6.0 * time)}
    >>> Campaign.from_frames({"1 Hz": table}, units={"displacement": "mm", "force": "kN"})
    <Campaign 'records in memory': 1 record, 1 warning>
    """

    title: str
    """As given by the user."""
    records: tuple[Record, ...]
    """In the order of ``campaign.toml``."""
    device: Device | None = None
    """Geometry and fluid, where known."""
    rig: RigLimits | None = None
    """Limits for proposed tests."""
    system: CarriedSystem | None = None
    """Carried system for judging by motion."""
    content_hash: str = ""
    """SHA-256 over ``campaign.toml`` and the records' bytes."""
    source: str = ""
    """Folder as the user named it; for messages and the command that repeats the work."""
    findings: tuple[Finding, ...] = ()
    """What reading had to mend or found odd."""

    @property
    def fitted(self) -> tuple[Record, ...]:
        """Records that may be fitted."""
        return tuple(r for r in self.records if not r.held_out)

    @property
    def held_out(self) -> tuple[Record, ...]:
        """Records that are only predicted."""
        return tuple(r for r in self.records if r.held_out)

    @classmethod
    def from_frames(
        cls,
        frames: Mapping[str, Any],
        *,
        units: Mapping[str, str] | None = None,
        columns: Mapping[str, str] | None = None,
        device: Device | str | Mapping[str, Any] | None = None,
        held_out: Collection[str] = (),
        sampling_rate: float | None = None,
        title: str = "",
    ) -> Campaign:
        """Return a campaign of tables that are in memory.

        Parameters
        ----------
        frames : mapping of str to table
            A record's name, and its samples: a pandas or polars frame, an xarray data set, or a
            mapping of column names to arrays (N,). Columns are ``time``, ``displacement`` and
            ``force``, and where measured ``velocity``, ``acceleration``, ``temperature``,
            ``base_acceleration``, ``applied_force``. A pandas index with a name is a column too;
            time stamps count in seconds.
        units : mapping of str to str, optional
            Units by these names, as ``{"force": "kN"}``. A header may carry its own, as
            ``force [kN]``; where neither does, SI is taken and a finding says so.
        columns : mapping of str to str, optional
            Headers by these names, where they differ: ``{"force": "Load cell"}``.
        device : Device, str or mapping, optional
            Geometry and fluid: a `models.device.Device`, a preset's name, or the ``[device]``
            table of a ``campaign.toml`` as a mapping. Without it no Dean number is told.
        held_out : collection of str
            Records that are predicted and never fitted.
        sampling_rate : float, optional
            Hz, of frames without a time.
        title : str
            Shown with every answer.

        Returns
        -------
        Campaign
            In SI, with what had to be mended in its ``findings``. The frames are not changed.

        Raises
        ------
        InputError
            Where a column is missing or can't be worked on, with the record's name.

        Examples
        --------
        >>> t = np.arange(2000) / 500
        >>> frame = {"time": t, "displacement": 10 * np.sin(7 * t), "force": 0.8 * np.cos(7 * t)}
        >>> units = {"time": "s", "displacement": "mm", "force": "kN"}
        >>> Campaign.from_frames({"slow": frame}, units=units)
        <Campaign 'records in memory': 1 record>
        """
        # It stands above the values: what is in a file and in memory is read by the same code.
        from discover.readers.frames import campaign_from_frames

        return campaign_from_frames(
            frames, units=units, columns=columns, device=device, held_out=held_out,
            sampling_rate=sampling_rate, title=title,
        )  # fmt: skip

    def __repr__(self) -> str:
        """Return the title and what is in it, in a line."""
        count = len(self.records)
        told = f"{count} record{'' if count == 1 else 's'}"
        if self.held_out:
            told += f" ({len(self.held_out)} held out)"
        if self.device is not None:
            told += f" of {self.device.name or 'a device with geometry'}"
        worst = [f for f in self.findings if f.level != "note"]
        if worst:
            told += f", {len(worst)} warning{'' if len(worst) == 1 else 's'}"
        return f"<Campaign {shown(self.title)}: {told}>"

    def _repr_html_(self) -> str:
        """Return the campaign as a notebook shows it: its findings, and a row for every record."""
        lines = [f"Campaign: {repr(self).removeprefix('<Campaign ').removesuffix('>')}"]
        for f in self.findings:
            lines.append(f"{f.level.capitalize()}: {f'{f.record}: ' if f.record else ''}{f.text}")
        header = ("record", "samples", "length", "greatest force", "greatest displacement", "use")
        rows = [
            [
                r.file,
                str(r.samples),
                quantity(r.step * (r.samples - 1), "s"),
                quantity(float(np.abs(r.force).max()), "N"),
                "–" if (x := r.displacement) is None else quantity(float(np.abs(x).max()), "m"),
                "held out" if r.held_out else "fitted",
            ]
            for r in self.records
        ]
        return answer_html(self.title, lines, header, rows)


def checked_campaign(given: object) -> Campaign:
    """Return a campaign, or raise `InputError` that says how to make one of what was given.

    Examples
    --------
    >>> checked_campaign("lab")
    Traceback (most recent call last):
        ...
    models.checks.InputError: campaign must be a Campaign: discover.read_campaign('lab') reads ...
    """
    if isinstance(given, Campaign):
        return given
    if isinstance(given, str | PathLike):
        advice, found = f"discover.read_campaign({str(given)!r}) reads one", "a path"
    elif isinstance(given, Record):
        advice, found = "discover.Campaign('title', (record,)) makes one", "a Record"
    else:
        advice = "discover.Campaign.from_frames({'name': table}, units={...}) makes one"
        found = type(given).__name__
    raise InputError("campaign", expected=f"a Campaign: {advice}", found=found)

"""Values of a campaign: records as measured, limits of the rig, what was found on reading."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from os import PathLike
from types import MappingProxyType
from typing import Any, TypeVar, cast

import numpy as np
from scipy.interpolate import CubicSpline

from discover.answer_html import answer_html
from discover.words import quantity
from models.checks import Array, InputError, finite_array, shown
from models.device import Device

Found = TypeVar("Found")

GAP = 1.5
"""Times the usual step, from which a step is a gap in the record."""
EVEN = 1e-3
"""Of a step: what times may be off a grid of equal ones."""
_CLOCK = float(np.finfo(np.float64).eps) ** -0.25  # of a record's length

_NO_INPUTS: Mapping[str, Array] = MappingProxyType({})
_COLUMNS = ("force", "displacement", "velocity", "acceleration", "temperature")


@dataclass(frozen=True)
class Finding:
    """Something that a user should know about the data or the answer."""

    level: str
    """"error", "warning" or "note"."""
    text: str
    """What was found and what to do about it."""
    record: str | None = None
    """The record that it concerns; None for the whole campaign."""

    def to_dict(self) -> dict[str, Any]:
        """Return the entry as documents carry it."""
        result: dict[str, Any] = {"level": self.level, "text": self.text}
        if self.record is not None:
            result["record"] = self.record
        return result


@dataclass(frozen=True)
class Piece:
    """Some samples of a long record, in SI units."""

    time: Array
    """(B,) s, strictly increasing, from piece to piece too."""
    displacement: Array
    """(B,) m."""
    force: Array
    """(B,) N."""


@dataclass(frozen=True)
class LongRecord:
    """All samples of a record that is too long to be held: they are read a piece at a time."""

    samples: int
    """N, of all pieces together."""
    pieces: Callable[[], Iterator[Piece]]
    """Reads them from the first on, each time that it is called."""


@dataclass(frozen=True, repr=False)
class Record:
    """One measured record, in SI units.

    A sine test is fitted at the times at which it was measured, which may jitter and lack samples.
    What needs equal steps takes `even`. Columns may be anything that numpy takes for an array of
    numbers (a pandas Series, a list); they are kept as read-only views. Where `long` is there, the
    columns are the first of the record's samples.

    Raises
    ------
    InputError
        Where columns differ in length or hold what is no finite number, or time does not rise.

    Examples
    --------
    >>> t = np.arange(1000) / 500
    >>> Record("1hz.csv", t, 800 * np.cos(6.28 * t), 0.01 * np.sin(6.28 * t))
    <Record '1hz.csv': 1000 samples, 1.998 s, force up to 800 N, displacement up to 0.01 m>
    """

    file: str
    """Name as in ``campaign.toml``."""
    time: Array
    """(N,) s, strictly increasing. A clock's, which starts so far from zero that sums of its
    squares would lose half of their digits, counts from the first sample."""
    force: Array
    """(N,) N."""
    displacement: Array | None = None
    """(N,) m; None for a digitised force curve of a sine test."""
    velocity: Array | None = None
    """(N,) m/s, measured; optional."""
    acceleration: Array | None = None
    """(N,) m/s^2, measured; optional."""
    temperature: Array | None = None
    """(N,) K; optional."""
    inputs: Mapping[str, Array] = field(default_factory=lambda: _NO_INPUTS)
    """Further columns by name: ``base_acceleration`` (m/s^2), ``applied_force`` (N)."""
    frequency: float | None = None
    """Hz, as labelled in the campaign; None where not labelled."""
    amplitude: float | None = None
    """m, as labelled; None where not labelled."""
    held_out: bool = False
    """Never fitted, only predicted."""
    uniform: bool = True
    """False only for a digitised force curve, whose points are far from evenly spaced."""
    long: LongRecord | None = field(default=None, repr=False, compare=False)
    """All samples of a sine test that is too long to be held; None where the columns are all."""

    _known: dict[Callable[[Record], Any], Any] = field(
        default_factory=dict, init=False, repr=False, compare=False
    )
    """What was found in it, by what found it."""

    def __post_init__(self) -> None:
        """Reject columns of unequal length and times that do not rise, and freeze the arrays."""
        for name in ("time", *_COLUMNS):
            if getattr(self, name) is not None:
                object.__setattr__(self, name, self._column(name))
        size = self.time.size
        if size > 1 and not np.diff(self.time).min() > 0.0:
            raise InputError("time", expected="rising", found="steps back or none", where=self.file)
        if size > 1 and abs(self.time[0]) > _CLOCK * (self.time[-1] - self.time[0]):
            counted = self.time - self.time[0]
            counted.flags.writeable = False
            object.__setattr__(self, "time", counted)

    def _column(self, name: str) -> Array:
        """Return a column that nobody can change through the record."""
        column = finite_array(name, getattr(self, name), ndim=1, where=self.file).view()
        size = np.size(self.time)
        if column.shape != (size,):
            raise InputError(
                name, expected=f"of shape ({size},)", found=f"{column.shape}", where=self.file
            )
        column.flags.writeable = False
        return column

    def __repr__(self) -> str:
        """Return the record's name, length and sizes in a line."""
        told = [f"{self.samples} samples, {self.step * (self.samples - 1):.4g} s"]
        told.append(f"force up to {np.abs(self.force).max():.4g} N")
        if self.displacement is not None:
            told.append(f"displacement up to {np.abs(self.displacement).max():.4g} m")
        if self.held_out:
            told.append("held out")
        return f"<Record {self.file!r}: {', '.join(told)}>"

    @property
    def samples(self) -> int:
        """Number of samples, in memory or not."""
        return self.time.size if self.long is None else self.long.samples

    @property
    def gaps(self) -> int:
        """Number of steps that are longer than the usual one."""
        steps = np.diff(self.time)
        return int(np.count_nonzero(steps > GAP * np.median(steps))) if self.uniform else 0

    @cached_property
    def even(self) -> Record:
        """The record in equal steps: itself, or by a cubic spline through its samples."""
        grid = np.linspace(self.time[0], self.time[-1], self.time.size)
        if not self.uniform or np.abs(self.time - grid).max() <= EVEN * self.step:
            return self
        columns = {n: getattr(self, n) for n in _COLUMNS if getattr(self, n) is not None}
        return self.sampled(grid, on_grid(self.time, {**columns, **self.inputs}, grid))

    def once(self, found: Callable[[Record], Found]) -> Found:
        """Return what a function finds in the record: it is asked once, as samples never change."""
        if found not in self._known:
            self._known[found] = found(self)
        return cast(Found, self._known[found])

    def sampled(self, time: Array, columns: Mapping[str, Array]) -> Record:
        """Return the record with other samples: of its force and whatever else it has."""
        found = {n: columns[n] if getattr(self, n) is not None else None for n in _COLUMNS}
        return replace(
            self,
            time=time,
            force=columns["force"],
            displacement=found["displacement"],
            velocity=found["velocity"],
            acceleration=found["acceleration"],
            temperature=found["temperature"],
            inputs={name: columns[name] for name in self.inputs},
        )

    @property
    def step(self) -> float:
        """Sampling interval, s (the mean one where not uniform)."""
        return float((self.time[-1] - self.time[0]) / (self.time.size - 1))


def on_grid(time: Array, columns: Mapping[str, Array], grid: Array) -> dict[str, Array]:
    """Return columns (N,) at other times (M,), by cubic splines through their samples."""
    names = list(columns)
    table = CubicSpline(time, np.column_stack([columns[name] for name in names]))(grid)
    return {name: np.ascontiguousarray(table[:, i]) for i, name in enumerate(names)}


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

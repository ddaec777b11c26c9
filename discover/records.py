"""Values of a campaign: records as measured, limits of the rig, what was found on reading."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from types import MappingProxyType
from typing import Any

import numpy as np
from scipy.interpolate import CubicSpline

from models.checks import Array, InputError
from models.device import Device

GAP = 1.5
"""Times the usual step, from which a step is a gap in the record."""
EVEN = 1e-3
"""Of a step: what times may be off a grid of equal ones."""

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
class Record:
    """One measured record, in SI units.

    A sine test is fitted at the times at which it was measured, which may jitter and lack samples.
    What needs equal steps takes `even`.
    """

    file: str
    """Name as in ``campaign.toml``."""
    time: Array
    """(N,) s, strictly increasing."""
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

    def __post_init__(self) -> None:
        """Reject columns of unequal length and times that do not rise, and freeze the arrays."""
        size = self.time.size
        for name in ("time", *_COLUMNS):
            column = getattr(self, name)
            if column is None:
                continue
            if column.shape != (size,):
                raise InputError(
                    name, expected=f"of shape ({size},)", found=f"{column.shape}", where=self.file
                )
            column.flags.writeable = False
        if size > 1 and not np.diff(self.time).min() > 0.0:
            raise InputError("time", expected="rising", found="steps back or none", where=self.file)

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


@dataclass(frozen=True)
class Campaign:
    """A folder of records with what its ``campaign.toml`` says of them."""

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

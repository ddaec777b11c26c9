"""One measured record: its samples, and what was found in them."""

from __future__ import annotations

import copy
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from types import MappingProxyType
from typing import Any, TypeVar, cast

import numpy as np
from scipy.interpolate import CubicSpline

from models.checks import Array, InputError, finite_array

Found = TypeVar("Found")

GAP = 1.5
"""Times the usual step, from which a step is a gap in the record."""
EVEN = 1e-3
"""Of a step: what times may be off a grid of equal ones."""
_CLOCK = float(np.finfo(np.float64).eps) ** -0.25  # of a record's length

_NO_INPUTS: Mapping[str, Array] = MappingProxyType({})
_COLUMNS = ("force", "displacement", "velocity", "acceleration", "temperature")


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
    total: int | None = field(default=None, repr=False, compare=False)
    """Number of samples as read, where the columns are the first of them and what is found (`once`)
    is of all; None where the columns are all."""

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
        if self.long is not None:
            return self.long.samples
        return self.time.size if self.total is None else self.total

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

    @property
    def found(self) -> Mapping[Callable[[Record], Any], Any]:
        """What was found in it so far, by what found it."""
        return MappingProxyType(self._known)

    def learn(self, found: Mapping[Callable[[Record], Any], Any]) -> None:
        """Take over what was found in the same samples elsewhere, as by another process."""
        self._known.update(found)

    def first(self, samples: int) -> Record:
        """Return the record with its first samples alone, and with what was found in all of them.

        It is no new record: its times stay, and so does its step.
        """
        held = copy.copy(self)
        columns = {name: getattr(self, name) for name in ("time", *_COLUMNS)}
        held.__dict__.update(
            {name: _first(c, samples) for name, c in columns.items() if c is not None},
            inputs={name: _first(c, samples) for name, c in self.inputs.items()},
            step=self.step,
            _known=dict(self._known),
        )
        if self.long is not None:
            held.__dict__["long"] = LongRecord(self.long.samples, _not_here)
        else:
            held.__dict__["total"] = self.samples
        return held

    def __getstate__(self) -> dict[str, Any]:
        """Return what a copy, or another process, is given."""
        state = {**self.__dict__, "inputs": dict(self.inputs)}
        state.pop("even", None)
        return state

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

    @cached_property
    def step(self) -> float:
        """Sampling interval, s (the mean one where not uniform)."""
        return float((self.time[-1] - self.time[0]) / (self.time.size - 1))


def _first(column: Array, samples: int) -> Array:
    """Return the first samples of a column, which do not hold the others in memory."""
    part = column[:samples].copy()
    part.flags.writeable = False
    return part


def _not_here() -> Iterator[Piece]:
    """Refuse to read a record again of which the first samples alone are held."""
    raise ValueError("the record's samples are not here: what was found in them is")


def on_grid(time: Array, columns: Mapping[str, Array], grid: Array) -> dict[str, Array]:
    """Return columns (N,) at other times (M,), by cubic splines through their samples."""
    names = list(columns)
    table = CubicSpline(time, np.column_stack([columns[name] for name in names]))(grid)
    return {name: np.ascontiguousarray(table[:, i]) for i, name in enumerate(names)}

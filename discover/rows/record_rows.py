"""A record's force as rows that are white where only noise is left, and what maps forces to rows.

A sine test's rows are its projections on an orthonormal set: the mean, the harmonics, a slow change
of the mean and of the lowest harmonics, so that what changes while the record lasts shows too. Rows
of other records are the spectral lines of tapered windows.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from discover.motion_fit import Observation
from models.checks import Array
from models.motion import Motion

_COARSER = 4  # times: the remainder's grid of a cycle against the motion's


@dataclass(frozen=True)
class RecordRows:
    """A record's rows."""

    observation: Observation
    """The record."""
    motion: Motion
    """At M moments: the samples, or in a long sine test means over a little time and phase."""
    cycle: Motion | None
    """One steady cycle of a sine test on a grid of G points; None for other records."""
    target: Array
    """(R,) the measured force."""
    size: Array
    """(R,) what a force of the record's own root mean square is in each row, were it all there."""
    of_motion: Callable[[Array], Array]
    """Maps forces (..., M) on `motion` to rows (..., R)."""
    cycle_rows: Array | None
    """(G, R) maps a force on `cycle` to rows; None without one."""
    remainder: Array
    """(F, R) rows of generic functions of the motion, by which what no term has may differ."""
    loudness: Array
    """(L, R) what each kind of independent error of the record's own size is in each row: the first
    of sine tests, the second of others."""
    windows: tuple[slice, ...]
    """Rows of each window; all rows of a sine test."""

    @cached_property
    def coarse(self) -> RecordRows:
        """The same with a quarter of the cycle's points: enough to weigh what may be missing."""
        if self.cycle is None or self.cycle_rows is None:
            return self
        size = self.cycle.displacement.size
        points = size // _COARSER
        cycle = replace(
            self.observation.cycle_of(points), test=self.cycle.test, sampling=self.cycle.sampling
        )
        share = np.arange(_COARSER)[None, :, None] / _COARSER
        fine = self.cycle_rows.reshape(points, _COARSER, -1)
        before, after = np.sum((1.0 - share) * fine, axis=1), np.sum(share * fine, axis=1)
        return replace(self, cycle=cycle, cycle_rows=before + np.roll(after, 1, axis=0))

    @property
    def file(self) -> str:
        """Name of the record."""
        return self.observation.file

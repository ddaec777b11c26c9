"""The rows that a plan of tests promises: of every sine test those of a sine, and of nothing else.

A drive's harmonics, a few thousandths of the motion, would formally tell an order at a single
frequency. They are not part of the plan, and at that size a rig's own flaws are as large, so what a
plan can tell is judged without them.
"""

from __future__ import annotations

from collections.abc import Hashable, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from discover.motion_fit.observation import Lines, real_rows
from discover.rows import RecordRows
from discover.rows.columns import force_columns
from models.checks import Array
from models.constitutive import FittedTerm
from models.motion import Motion, sine_motion

_SAMPLES = 128  # of one cycle
_LINES = 8  # of a test that is added


@dataclass(frozen=True)
class SineTest:
    """A pure sine test, with the noise of its lines."""

    frequency: float
    """Hz."""
    amplitude: float
    """m."""
    deviation: Array
    """(L,) N, standard deviation of the real and of the imaginary part of each line."""

    _known: dict[Hashable, Lines] = field(default_factory=dict, repr=False, compare=False)
    """Terms' lines: where a test is added in thought, the others are asked for them again."""

    def columns(self, terms: Sequence[FittedTerm]) -> Array:
        """Return terms' lines over their noise, (2 L, K)."""
        lines = np.stack([self._lines(t) for t in terms])
        return np.asarray(real_rows(lines[:, : self.deviation.size] / self.deviation).T)

    def _lines(self, fitted: FittedTerm) -> Lines:
        """Return a term's lines, their mean square that of the force, (N / 2 + 1,) N."""
        key = (fitted.id, *fitted.shape.items())
        if key not in self._known:
            if fitted.term.column is None:
                raise ValueError(f"{fitted.id} adds no force")
            lines = np.fft.rfft(fitted.term.column(self._motion, fitted.shape))
            lines *= np.sqrt(2.0) / _SAMPLES
            lines[0] /= np.sqrt(2.0)
            self._known[key] = lines
        return self._known[key]

    @cached_property
    def _motion(self) -> Motion:
        return sine_motion(self.amplitude, self.frequency, samples=_SAMPLES)


@dataclass(frozen=True)
class Plan:
    """The tests of a plan."""

    sines: tuple[SineTest, ...]
    """Sine tests."""
    others: tuple[RecordRows, ...]
    """Records that are none."""
    size: float
    """Length of all measured force over its noise."""
    noise: float
    """A line's standard deviation over its record's rms force, the median."""

    def columns(self, terms: Sequence[FittedTerm]) -> Array:
        """Return terms over the noise in all tests, (R, K)."""
        parts = [s.columns(terms) for s in self.sines]
        parts += [force_columns(r, terms).T for r in self.others]
        return np.concatenate(parts)

    @property
    def frequency(self) -> Array:
        """(T,) Hz, of every test or window."""
        own = [s.frequency for s in self.sines]
        return np.array([*own, *(w.frequency for r in self.others for w in r.observation.windows)])

    @property
    def amplitude(self) -> Array:
        """(T,) m, likewise."""
        own = [s.amplitude for s in self.sines]
        return np.array([*own, *(w.amplitude for r in self.others for w in r.observation.windows)])

    @property
    def records(self) -> int:
        """Number of records."""
        return len(self.sines) + len(self.others)

    def with_test(self, frequency: float, amplitude: float, level: float) -> Plan:
        """Return the plan with one sine test more, its lines' noise `level` N."""
        test = SineTest(frequency, amplitude, np.full(_LINES, level))
        return replace(self, sines=(*self.sines, test))


def plan_of(rows: Sequence[RecordRows]) -> Plan:
    """Return the plan of the records that may be fitted."""
    sines, others, levels = [], [], []
    size = 0.0
    for r in rows:
        o = r.observation
        for w in o.windows:
            levels.append(float(np.sqrt(np.median(w.variance) / max(w.power, 1e-300))))
            size += float(np.sum(np.abs(w.force) ** 2 / w.variance))
        if o.kind == "sine":
            deviation = np.sqrt(o.windows[0].variance)
            most = _SAMPLES // 2
            sines.append(SineTest(o.frequency, o.amplitude, deviation[:most]))
        else:
            others.append(r)
    return Plan(tuple(sines), tuple(others), float(np.sqrt(size)), float(np.median(levels)))

"""What a campaign covers: the sizes that shapes of effects are tried in."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from discover.motion_fit import Observation

COARSE = 8.0  # samples, up to which a digital filter is not as an analogue one
_ANOTHER_RATE = 1.05  # times the sampling interval of another record


@dataclass(frozen=True)
class Scales:
    """What a campaign covers."""

    speed: float
    """m/s, greatest amplitude."""
    displacement: float
    """m, greatest amplitude."""
    force: float
    """N, greatest measured."""
    peaks: tuple[float, ...]
    """N, of every record, rising."""
    duration: float
    """s, longest record."""
    omega: float
    """rad/s, highest."""
    slowest: float
    """rad/s, lowest."""
    numbers: tuple[int, ...] = ()
    """Of the tests that are fitted, in the campaign; 0 where it is not known."""
    reversal: float = 0.0
    """m/s over which the baseline's friction reverses."""
    sampling: float = 0.0
    """Hz, highest; 0 where all records have the same."""
    step: float = 0.0
    """s, longest sampling interval."""

    @property
    def tests(self) -> int:
        """Number of the last test of the campaign; 0 where it is not known."""
        return max(self.numbers, default=0)


def scales_of(observations: Sequence[Observation], reversal: float = 0.0) -> Scales:
    """Return what the records cover."""
    peaks = sorted(float(np.abs(o.measured).max()) for o in observations)
    steps = [o.motion.step for o in observations]
    fastest, slowest = min(steps), max(steps)
    omegas = [2.0 * np.pi * float(w.frequency) for o in observations for w in o.windows]
    return Scales(
        speed=max(float(np.abs(o.motion.velocity).max()) for o in observations),
        displacement=max(float(np.abs(o.motion.displacement).max()) for o in observations),
        force=peaks[-1],
        peaks=tuple(peaks),
        duration=max(float(o.time[-1] - o.time[0]) for o in observations),
        omega=max(omegas),
        slowest=min(omegas),
        numbers=tuple(o.test for o in observations),
        reversal=reversal,
        sampling=0.0 if slowest < _ANOTHER_RATE * fastest else 1.0 / fastest,
        step=slowest,
    )

"""What a campaign covers: the sizes in which shapes of terms are tried."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Scales:
    """What a campaign covers."""

    displacement: float
    """m, greatest amplitude."""
    least_displacement: float
    """m, amplitude of the record that moves least."""
    speed: float
    """m/s, greatest speed amplitude."""
    least_speed: float
    """m/s, speed amplitude of the slowest record."""
    force: float
    """N, greatest measured."""
    peaks: tuple[float, ...]
    """(records,) N, greatest force of each record, rising."""
    duration: float
    """s, longest record."""
    omega: float
    """rad/s, highest."""
    least_omega: float
    """rad/s, lowest."""
    tests: tuple[int, ...] = ()
    """(records,) numbers of the records in the campaign, from 1; empty where they aren't known."""
    sampling: float = 0.0
    """Hz, highest, where records are sampled at different rates; else 0."""

    @property
    def reversal(self) -> float:
        """m/s over which friction reverses where nothing better is known."""
        return 0.01 * self.speed

    def reversals(self) -> list[float]:
        """Return speeds (m/s) over which friction's curve may change."""
        return doubling(0.03 * self.least_speed, 0.05 * self.speed)

    def size(self, of: str) -> float:
        """Return the greatest "displacement", "speed" or "force"; 1 for "" (no scale)."""
        return {
            "": 1.0, "displacement": self.displacement, "speed": self.speed, "force": self.force
        }[of]


def doubling(low: float, high: float) -> list[float]:
    """Return sizes from one to another, each twice the one before."""
    return [float(v) for v in np.exp(np.arange(np.log(low), np.log(high), np.log(2.0)))]

"""What the noise of the displacement makes of the force in sine tests.

The motion's harmonics are fitted, and are off by what is left of the displacement's noise. A device
answers such an error as it answers motion: an inertance by the square of the harmonic. So a
harmonic of the force can be no surer than that of the motion which drives it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Self

import numpy as np

from discover.motion_fit.observation import Observation
from models.checks import Array

_ALIKE = 0.2  # of the logarithm of frequency, within which tests count as of one


def with_motion_noise(observations: Sequence[Observation]) -> tuple[Observation, ...]:
    """Return observations whose sine tests know the force's error due to that of their motion.

    The campaign's tests together tell what force a motion makes: the apparent dynamic stiffness of
    their fundamentals over frequency.
    """
    sines = [o for o in observations if _is_seen(o)]
    if not sines:
        return tuple(observations)
    frequency = np.array([o.frequency for o in sines])
    size = np.array([np.sqrt(2.0) * abs(o.windows[0].force[1]) / o.amplitude for o in sines])
    known = size > 0.0
    if not np.any(known):
        return tuple(observations)
    answer = _Answer.of(frequency[known], size[known])
    return tuple(_with_noise(o, answer) if _is_seen(o) else o for o in observations)


def _is_seen(observation: Observation) -> bool:
    """Tell whether an observation is of a sine test whose motion is measured, with noise."""
    return observation.kind == "sine" and bool(np.any(observation.motion_error > 0.0))


@dataclass(frozen=True)
class _Answer:
    """Dynamic stiffness over frequency, between tests a power of it."""

    place: Array
    """(T,) logarithm of frequencies, Hz, rising."""
    level: Array
    """(T,) logarithm of the stiffness, N/m."""

    @classmethod
    def of(cls, frequency: Array, stiffness: Array) -> Self:
        """Return what tests (N,) tell: frequencies, Hz, and stiffness, N/m."""
        place, level = np.log(frequency), np.log(stiffness)
        groups, left = list[tuple[float, float]](), np.ones(place.size, dtype=bool)
        while np.any(left):  # from the highest on, beyond which the rise of the last two goes on
            alike = left & (place > place[left].max() - _ALIKE)
            groups.insert(0, (float(place[alike].mean()), float(level[alike].mean())))
            left &= ~alike
        return cls(*np.array(groups).T)

    @property
    def slope(self) -> float:
        """Power of the frequency beyond the tests': of a spring 0, an inertance 2.

        That of the two highest ones; a damper's where all tests are at one frequency.
        """
        if self.place.size < 2:
            return 1.0
        rise = np.diff(self.level[-2:]) / np.diff(self.place[-2:])
        return float(np.clip(rise[0], 0.0, 2.0))

    def at(self, frequency: Array) -> Array:
        """Return the stiffness (K,), N/m, at frequencies, Hz."""
        place = np.log(frequency)
        beyond = np.maximum(place - self.place[-1], 0.0)
        return np.asarray(np.exp(np.interp(place, self.place, self.level) + self.slope * beyond))


def _with_noise(observation: Observation, answer: _Answer) -> Observation:
    (window,) = observation.windows
    error = observation.motion_error[1 : window.omega.size]
    made = np.zeros(window.omega.size)
    made[1 : 1 + error.size] = (
        error * answer.at(window.omega[1 : 1 + error.size] / (2.0 * np.pi))
    ) ** 2
    window = replace(
        window,
        variance=window.variance + 0.5 * made,
        through=0.5 * made,
        noise_power=window.noise_power + float(made.sum()),
    )
    return replace(observation, windows=(window,))

"""What the noise of the displacement makes of the force in sine tests.

The motion's harmonics are fitted, and are off by what is left of the displacement's noise. A device
answers such an error as it answers motion: an inertance by the square of the harmonic. So a
harmonic of the force can be no surer than that of the motion which drives it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from discover.motion_fit.observation import Lines, Observation
from models.checks import Array


def with_motion_noise(observations: Sequence[Observation]) -> tuple[Observation, ...]:
    """Return observations whose sine tests know the force's error due to that of their motion.

    The campaign's tests together tell what force a motion makes: the apparent dynamic stiffness of
    their fundamentals over frequency, as of a spring, a damper and an inertance.
    """
    sines = [o for o in observations if _is_seen(o)]
    if not sines:
        return tuple(observations)
    omega = np.array([2.0 * np.pi * o.frequency for o in sines])
    # Phases count from the velocity's.
    stiffness = np.array([1j * np.sqrt(2.0) * o.windows[0].force[1] / o.amplitude for o in sines])
    parts = _parts(omega, stiffness)
    return tuple(_with_noise(o, parts) if _is_seen(o) else o for o in observations)


def _is_seen(observation: Observation) -> bool:
    """Tell whether an observation is of a sine test whose motion is measured, with noise."""
    return observation.kind == "sine" and bool(np.any(observation.motion_error > 0.0))


def _answers(omega: Array) -> Lines:
    """Return the dynamic stiffness (T, 3) of a unit of each part at rates (T,), 1/s."""
    return np.stack([np.ones_like(omega), 1j * omega, -(omega**2)], axis=1).astype(complex)


def _parts(omega: Array, stiffness: Lines) -> Array:
    """Return the spring, N/m, damper, N s/m, and inertance, kg, that answer like the tests (T,).

    Each test counts alike; of one alone, which can't tell spring and inertance, as even ones.
    """
    answers = _answers(omega) / np.abs(stiffness)[:, None]
    goal = stiffness / np.abs(stiffness)
    columns = np.concatenate([answers.real, answers.imag])
    scale = np.linalg.norm(columns, axis=0)
    found = np.linalg.lstsq(columns / scale, np.concatenate([goal.real, goal.imag]), rcond=None)[0]
    return np.asarray(found / scale)


def _with_noise(observation: Observation, parts: Array) -> Observation:
    (window,) = observation.windows
    error = np.zeros(window.omega.size)
    known = observation.motion_error[: error.size]
    error[1 : known.size] = known[1:]
    made = (error * np.abs(_answers(window.omega) @ parts)) ** 2
    window = replace(
        window,
        variance=window.variance + 0.5 * made,
        through=0.5 * made,
        noise_power=window.noise_power + float(made.sum()),
    )
    return replace(observation, windows=(window,))

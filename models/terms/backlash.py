"""Backlash: play in a joint, in which the device coasts until the other flank is met."""

import numpy as np
from numba import njit

from models.checks import Array
from models.motion import Motion
from models.terms.term import ForceOf, Parameter, Shape, Term

_CONTACT = 12.0  # contact's natural frequency over that of the motion's fastest grid of cycles
_DAMPING = 0.3


def transform(force_of: ForceOf, motion: Motion, coefficient: float, shape: Shape) -> Array:
    """Return the force through a joint with play: `coefficient` 1 is all of it.

    The device is a mass with viscous and dry resistance, as fit its own force best; it is driven
    through a dead zone of width `gap` with a stiff, damped contact. What the play changes on that
    device is added to the force.
    """
    force = force_of(motion)
    v, a, x = motion.velocity, motion.acceleration, motion.displacement
    columns = np.stack([a, v, np.sign(v)], axis=1)
    (mass, viscous, dry), *_ = np.linalg.lstsq(columns, force - force.mean(), rcond=None)
    mass, viscous, dry = abs(mass), abs(viscous), max(dry, 0.0)
    omega = float(np.std(v) / max(np.std(x), 1e-300))
    natural = _CONTACT * shape["stiffness"] * omega
    passes = 3 if motion.periodic else 1
    step = motion.step
    inner = max(int(np.ceil(natural * step / 0.2)), 1)
    rigid = mass * a + viscous * v + dry * np.sign(v)
    played = _coast(
        x, v, step, inner, mass, viscous, dry, 0.5 * shape["gap"], mass * natural**2,
        2.0 * _DAMPING * mass * natural, 0.02 * float(np.abs(v).max()), passes,
    )
    return np.asarray(force + coefficient * (played - rigid))


@njit(cache=True)  # type: ignore[untyped-decorator]
def _coast(
    x: Array, v: Array, step: float, inner: int, mass: float, viscous: float, dry: float,
    half: float, stiffness: float, damping: float, slow: float, passes: int,
) -> Array:
    """Return the contact force on a mass with resistance, driven through a dead zone, (N,)."""
    size = x.size
    result = np.empty(size)
    position, speed = x[0], v[0]
    h = step / inner
    for _ in range(passes):
        for i in range(size):
            following = (i + 1) % size
            force = 0.0
            for k in range(inner):
                share = k / inner
                ends = x[i] + share * (x[following] - x[i])
                pace = v[i] + share * (v[following] - v[i])
                depth = ends - position
                contact = 0.0
                if depth > half:
                    contact = max(stiffness * (depth - half) + damping * (pace - speed), 0.0)
                elif depth < -half:
                    contact = min(stiffness * (depth + half) + damping * (pace - speed), 0.0)
                force += contact / inner
                resistance = viscous * speed + dry * np.tanh(speed / slow)
                speed += h * (contact - resistance) / mass
                position += h * speed
            result[i] = force
    return result


TERM = Term(
    "backlash",
    "1",
    "play of width gap in a joint: the device coasts in it",
    transform=transform,
    acts="input",
    parameters=(
        Parameter("gap", 0.001, 1.0, 0.05, "m", "displacement", "log"),
        Parameter("stiffness", 0.3, 10.0, 1.0, ""),
    ),
    nonnegative=True,
    mistaken_for=("hysteresis", "coulomb-friction", "series-compliance"),
)

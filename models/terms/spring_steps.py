"""A device behind a spring that always bears: stepped implicitly, however stiff or light it is."""

import numpy as np

from models.checks import Array
from models.compiled import compiled
from models.motion import Motion
from models.terms.hysteresis import bristle_state
from models.terms.joint_device import JointDevice
from models.terms.stepping import (
    SETTLED,
    begin,
    driven_end,
    forgetting,
    on_curve,
    passes_of,
    size_of,
    with_deflection,
    with_friction,
)

_STEP = 0.4  # of the natural period over 2 pi, where it can be followed
_MOST_INNER = 12  # what is faster than this is followed on average
_ADDED_MASS = 1e-4  # of what would make the whole force: a spring's loss is told by a mass


def carried_by_spring(
    motion: Motion,
    device: JointDevice,
    rigid: Array,
    stiffness: float,
    loss: float,
    load: tuple[float, float, float],
) -> Array:
    """Return the force (N,) that a spring before a device carries.

    Parameters
    ----------
    motion : Motion
        Of the driven end.
    device : JointDevice
        What is behind it.
    rigid : ndarray, shape (N,)
        Its force where the spring is rigid.
    stiffness : float
        N/m.
    loss : float
        Damping over twice the critical damping of the device's mass on the stiffness.
    load : tuple of float
        How stiffness changes under load: `half_load`, `load_share`, `load_side` of a `Joint`.
    """
    x, v = motion.displacement - motion.displacement.mean(), motion.velocity
    mass = max(device.mass, _ADDED_MASS * size_of(rigid) / size_of(motion.acceleration))
    natural = float(np.sqrt((stiffness + max(device.spring, 0.0)) / mass))
    fastest = natural
    if load[0] > 0.0:
        squeezed = 1.0 + float(np.abs(rigid).max()) / load[0]
        taken = max(load[1], 0.0)
        fastest /= np.sqrt(1.0 - taken + taken / squeezed**2)
    inner = int(np.clip(np.ceil(fastest * motion.step / _STEP), 1, _MOST_INNER))
    loss = forgetting(loss, natural, motion)
    passes, start = passes_of(motion)
    seal = float(bristle_state(motion, device.length)[start]) if device.length > 0.0 else 0.0
    return np.asarray(_step(
        x, v, motion.step, inner, mass, device.viscous, device.quadratic, device.dry,
        device.reversal, device.length, seal, device.spring, stiffness,
        2.0 * loss * np.sqrt(stiffness * mass), *load, passes, start,
        float(rigid[start]) / stiffness, device.curve, device.top,
    ))  # fmt: skip


@compiled(cache=True, fastmath=True, error_model="numpy", nogil=True)
def _step(
    x: Array, v: Array, step: float, inner: int, mass: float, viscous: float, quadratic: float,
    dry: float, slow: float, length: float, seal: float, spring: float, stiffness: float,
    damping: float, half_load: float, taken: float, load_side: float, passes: int, start: int,
    bent: float, curve: Array, top: float,
) -> Array:
    """Return the force that the spring carries, (N,), mean over each sample's inner steps.

    It begins at sample `start`, with the spring pressed in by `bent` and friction at `seal` of what
    slides. Speeds are half a step behind places. In a step the spring's force is that of places
    around it (Fox and Goodwin's weights, Newmark's of constant acceleration where it is too stiff
    for these), and what resists is that of the speed in its middle, or at its end where it is too
    fast to be followed.
    """
    size = x.size
    result = np.empty(size)
    position, speed = x[start] - bent, v[start]
    pace_limit = np.max(np.abs(v))
    h = step / inner
    before = np.zeros((3, 2))  # what the last cycles began with
    known = 0  # of them
    aside = max(spring, 0.0)
    for turn in range(passes + 1 if start > 0 else passes):
        was, was_speed = position - x[0], speed
        deepest = 0.0
        for i in range(start, size):
            total = 0.0
            for k in range(inner):
                share = (k - 0.5 * (inner - 1)) / inner
                end, pace = driven_end(x, v, i, share)
                depth = end - position
                deepest = max(deepest, abs(depth))
                lossy, stiff = damping, stiffness
                if half_load > 0.0 and (load_side == 0.0 or load_side * depth > 0.0):
                    # depth stiffness = force (1 - taken + taken half_load / (half_load + force))
                    stiff /= 1.0 - taken
                    rest = abs(depth) * stiff - half_load / (1.0 - taken)
                    force = abs(depth) * stiff * half_load
                    force = 0.5 * (rest + np.sqrt(rest * rest + 4.0 * force))
                    softer = 1.0 - taken + taken * (half_load / (half_load + force)) ** 2
                    force = force if depth > 0.0 else -force
                    lossy /= np.sqrt(softer)
                    stiff = stiffness / softer
                else:
                    force = stiffness * depth
                resisted = (viscous + quadratic * abs(speed)) * speed + spring * position
                steep = viscous + 2.0 * quadratic * abs(speed)
                if curve.size > 0:
                    curved, slope = on_curve(curve, top, speed)
                    resisted += curved
                    steep += max(slope, 0.0)
                squared = h * h * (stiff + aside)
                own = squared / (mass + 0.5 * h * (steep + lossy))
                if own > 2.0:  # its own motion is too fast: it dies out
                    lossy += (0.5 - 1.0 / own) * h * stiff
                pace_of = h * (steep + lossy)
                late = 0.5 if pace_of <= 2.0 * mass else 1.0 - mass / pace_of
                weight = 1.0 / 12.0 if squared <= 3.0 * mass else 0.25 - 0.5 * mass / squared
                heavy = mass + late * pace_of + weight * squared
                force += lossy * (pace - speed)
                free = speed + h * (force - resisted) / heavy
                if length > 0.0:
                    now, seal = with_deflection(free, h * dry / heavy, seal, h / length)
                else:
                    now = with_friction(free, h * dry / heavy, slow)
                total += force - (late * lossy + weight * h * stiff) * (now - speed)
                speed = now
                position += h * speed
            result[i] = total / inner
        if start > 0:
            start = 0
            continue
        moved = abs(position - x[0] - was)
        steady = moved < SETTLED * deepest and abs(speed - was_speed) < SETTLED * pace_limit
        if turn > 0 and steady:
            break
        known = begin(before, known, was, was_speed, position - x[0], speed)
        if known == 3:
            position, speed = before[0, 0] + x[0], before[0, 1]
            known = 0
    return result

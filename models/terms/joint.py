"""A joint in series with a device: a spring, play, or a limit of what it carries.

The device behind it (`device_of`) is driven through the joint and stepped in time to its steady
state.
"""

from dataclasses import dataclass

import numpy as np

from models.checks import Array
from models.compiled import compiled
from models.motion import Motion
from models.terms.joint_device import JointDevice
from models.terms.spring_steps import carried_by_spring
from models.terms.stepping import (
    SETTLED,
    begin,
    driven_end,
    forgetting,
    passes_of,
    size_of,
    with_friction,
)

_STEP = 0.15  # of the joint's natural period over 2 pi
_LEAST_INNER, _MOST_INNER = 4, 60
_MOST_STEPS = 1_000_000  # of one pass: a stiffer joint is as stiff as they can follow
_ADDED_MASS = 1e-3  # of what would make the whole force: a damper's own time can't be stepped
_SLOWED = 0.5  # of its speed, by which resistance slows a mass in an inner step at most
_FAR = 15.0  # widths from a soft flank, where it is met or not


@dataclass(frozen=True)
class Joint:
    """What is between the driven end and the device."""

    stiffness: float
    """N/m."""
    loss: float
    """Damping over twice the critical damping of the device's mass on the stiffness."""
    gap: float = 0.0
    """m, whole play."""
    soft: float = 0.0
    """m of play over which its flanks are met, as by rubber or an oil film; 0 for hard ones."""
    lower: float = -np.inf
    """N, least force that it carries."""
    upper: float = np.inf
    """N, greatest force that it carries."""
    refilled: bool = False
    """True where what is lost at a limit is made up at once, as by a valve: the joint slips."""
    lag: float = 0.0
    """s that the valve takes to close, once the flow through it has turned."""
    valve: float = 0.0
    """N s/m of its resistance, by which the limit deepens as more is made up."""
    half_load: float = 0.0
    """N of force that makes half of the spring's change under load; 0 for a linear one."""
    load_share: float = 0.0
    """Share of the unloaded spring's compliance that a great load takes, as it squeezes gas by
    Boyle's law; below 0 what it adds, as rubber and joints that open do."""
    load_side: float = 0.0
    """1 or -1 where it changes only under positive or negative force, 0 where under both."""
    fluid_only: bool = False
    """True where dry friction is beside the joint and not behind it."""


def through_joint(force: Array, motion: Motion, joint: Joint, device: JointDevice) -> Array:
    """Return the force (N,) with a joint before a device whose own force is `force`.

    It is not finite where the device's own is too great to have a square.

    Parameters
    ----------
    force : ndarray, shape (N,)
        The device's force where the joint is rigid, N.
    motion : Motion
        Of the driven end.
    joint : Joint
        What it is driven through.
    device : JointDevice
        What `device_of` makes of the force.
    """
    bears = joint.gap == 0.0 and joint.lower == -np.inf and joint.upper == np.inf
    driven = device.for_spring() if bears else device._replace(curve=device.curve[:0])
    rigid = driven.force(motion, dry=not joint.fluid_only)
    if not np.isfinite(force @ force + rigid @ rigid):
        return np.full_like(force, np.nan)  # beyond all numbers: there is no such device
    if not np.any(rigid):
        return force
    if joint.fluid_only:
        driven = driven._replace(dry=0.0)
    if bears:
        load = joint.half_load, joint.load_share, joint.load_side
        carried = carried_by_spring(motion, driven, rigid, joint.stiffness, joint.loss, load)
        return np.asarray(force + carried - rigid)
    mass, viscous, quadratic, dry, reversal, _, spring, _, _ = driven
    v, x = motion.velocity, motion.displacement - motion.displacement.mean()
    most = min(max(_MOST_STEPS // x.size, _LEAST_INNER), _MOST_INNER)
    resistance = viscous + quadratic * float(np.abs(v).max())
    carried_along = _ADDED_MASS * size_of(rigid) / size_of(motion.acceleration)
    mass = max(mass, carried_along, resistance * motion.step / (_SLOWED * most))
    natural = float(np.sqrt((joint.stiffness + max(spring, 0.0)) / mass))
    fastest = max(natural, resistance / mass)
    inner = int(np.clip(np.ceil(fastest * motion.step / _STEP), 1, most))
    stiffness = min(joint.stiffness, mass * (_STEP * 2.0 * inner / motion.step) ** 2)
    loss = joint.loss if joint.gap > 0.0 else forgetting(joint.loss, natural, motion)
    damping = 2.0 * loss * np.sqrt(stiffness * mass)
    passes, start = passes_of(motion)
    start = 0 if joint.refilled else start
    borne = min(max(float(rigid[start]), joint.lower), joint.upper)
    bent = borne / stiffness if joint.gap == 0.0 else 0.0
    carried = _step(
        x, v, motion.step, inner, mass, viscous, quadratic, dry, reversal, spring, stiffness,
        damping, 0.5 * joint.gap, joint.soft, joint.lower, joint.upper, int(joint.refilled),
        joint.lag, joint.valve, passes, start, bent,
    )
    return np.asarray(force + carried - rigid)


# One compiled function, long as it is: the joint's state is a dozen local numbers that every part
# of a step reads and writes, and numba keeps them in registers only while they stay in one place.
@compiled(cache=True, fastmath=True, error_model="numpy", nogil=True)
def _step(
    x: Array, v: Array, step: float, inner: int, mass: float, viscous: float, quadratic: float,
    dry: float, slow: float, spring: float, stiffness: float, damping: float, half: float,
    soft: float, lower: float, upper: float, refilled: int, lag: float, valve: float, passes: int,
    start: int, bent: float,
) -> Array:
    """Return the force that the joint carries, (N,), mean over each sample's inner steps.

    It begins at sample `start`, with the joint pressed in by `bent`.
    """
    size = x.size
    result = np.empty(size)
    position, speed, slipped = x[start] - bent, v[start], 0.0
    pace_limit = 0.0
    for i in range(size):
        pace_limit = max(pace_limit, abs(v[i]))
    h = step / inner
    brake = h * dry / mass
    rate, turned_for = 0.0, -1.0  # the valve's time; -1 where it is closed
    before = np.zeros((3, 2))  # what the last cycles began with
    known = 0  # of them
    limit = held_open = 0.0
    for turn in range(passes + 1 if start > 0 else passes):
        was, was_speed = position - x[0] + slipped, speed
        deepest = 0.0
        for i in range(start, size):
            total = 0.0
            for k in range(inner):
                share = (k - 0.5 * (inner - 1)) / inner
                end, pace = driven_end(x, v, i, share)
                depth = end - position - slipped
                deepest = max(deepest, abs(depth))
                now = speed + 0.5 * h * rate  # half a step on: there the place is known
                force = 0.0
                if soft > 0.0:
                    pressed, bearing = _flanks(abs(depth) / soft, half / soft)
                    force = stiffness * soft * (pressed if depth > 0.0 else -pressed)
                    force += damping * bearing * (pace - now)
                elif half > 0.0:
                    side = 1.0 if depth > 0.0 else -1.0
                    push, held = _pushed(
                        abs(depth) - half, side * (pace - now), stiffness, damping, h
                    )
                    force, held = side * push, held * damping
                    if held > 0.0:
                        resisted = (viscous + quadratic * abs(now)) * now + spring * position
                        ahead = (force + held * (now - speed) - resisted) / (mass + 0.5 * h * held)
                        force += held * (now - speed - 0.5 * h * ahead)
                else:
                    force = stiffness * depth + damping * (pace - now)
                if refilled == 1 and (turned_for >= 0.0 or force < lower or force > upper):
                    if turned_for < 0.0:
                        turned_for, limit = 0.0, lower if force < lower else upper
                        force = limit
                    else:
                        force = held_open
                    # spring and valve in series, implicitly: a valve never adds to the suction
                    bent_by = stiffness * h
                    force = valve * (force + bent_by * (pace - now)) + bent_by * limit
                    force /= valve + bent_by
                    held_open = force
                    flow = (force - limit) / valve if valve > 0.0 else pace - now
                    back = flow if limit == lower else -flow
                    turned_for = turned_for + h if back > 0.0 else 0.0
                    if turned_for > lag:
                        gained = (pace - now) * min(turned_for - lag, h)
                        slipped = end - position - force / stiffness - gained
                        turned_for = -1.0
                else:
                    force = min(max(force, lower), upper)
                total += force
                begun = speed
                resisted = (viscous + quadratic * abs(now)) * now + spring * position
                speed += h * (force - resisted) / mass
                speed = with_friction(speed, brake, slow)
                rate = (speed - begun) / h
                position += h * speed
            result[i] = total / inner
        if start > 0:
            start = 0
            continue
        moved = abs(position - x[0] + slipped - was)
        steady = moved < SETTLED * deepest and abs(speed - was_speed) < SETTLED * pace_limit
        if turn > 0 and steady:
            break
        if refilled == 0:
            known = begin(before, known, was, was_speed, position - x[0], speed)
            if known == 3:
                position, speed = before[0, 0] + x[0], before[0, 1]
                known = 0
    return result


@compiled(cache=True, inline="always")
def _pushed(
    deep: float, closing: float, stiffness: float, damping: float, h: float
) -> tuple[float, float]:
    """Return what a flank that only pushes does on average over a step, met or left within it.

    It is `deep` (m) in the middle of the step and goes deeper at `closing` (m/s).
    """
    reach = 0.5 * h * abs(closing)
    if closing > 0.0:
        if deep >= reach:
            return stiffness * deep + damping * closing, 1.0
        if deep <= -reach:
            return 0.0, 0.0
        held = deep + reach  # deepest within the step, of 2 reach
        share = held / (2.0 * reach)
        return share * (0.5 * stiffness * held + damping * closing), share
    middle = stiffness * deep + damping * closing
    if middle >= stiffness * reach:
        return middle, 1.0
    if middle <= -stiffness * reach:
        return 0.0, 0.0
    most = middle + stiffness * reach
    share = most / (2.0 * stiffness * reach)
    return share * 0.5 * most, share


@compiled(cache=True, inline="always")
def _flanks(depth: float, half: float) -> tuple[float, float]:
    """Return how far both flanks are pressed in, and the slope of that; in widths, depth from 0.

    A flank is met along the logarithm of 1 + exp(depth): 0 far from it, linear beyond.
    """
    near = depth - half
    if near > _FAR:
        return near, 1.0
    if near < -_FAR:
        return 0.0, 0.0
    grown = np.exp(near)
    if depth + half > _FAR:
        return np.log(1.0 + grown), grown / (1.0 + grown)
    other = np.exp(-depth - half)
    pressed = np.log((1.0 + grown) / (1.0 + other))
    return pressed, grown / (1.0 + grown) + other / (1.0 + other)

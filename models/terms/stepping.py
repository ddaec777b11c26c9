"""What the steppers of joints share; numba compiles what it can into each of them."""

import numpy as np

from models.checks import Array
from models.compiled import compiled
from models.motion import Motion

_PASSES = 8  # at most, until a cycle ends as it began
_LEAD = 4  # of a cycle this part is stepped ahead: most joints forget within it how they began
_SHORT = 8192  # samples of one cycle; longer periods of many cycles settle within one
_FORGETS = 7.0  # times e that what a joint began with decays over a cycle at least
_LEAST_LOSS = 0.005  # that is enough for it, where it moves of its own many times a cycle
SETTLED = 5e-4
"""Of the deepest bend and of the greatest speed, by which a cycle may end other than it began."""
NEWTON = 2
"""Steps for the speed after friction."""
NEARLY_STILL = 1e-4
"""Of friction's length, below which a step's way is a straight part of its curve."""
WIDE = 3.0
"""Ranges of reversal, beyond which friction is whole."""


def passes_of(motion: Motion) -> tuple[int, int]:
    """Return how often a motion is gone through at most, and the sample at which that begins."""
    size = motion.time.size
    passes = 1 if not motion.periodic else (_PASSES if size <= _SHORT else 2)
    return passes, size - size // _LEAD if passes > 1 else 0


def forgetting(loss: float, natural: float, motion: Motion) -> float:
    """Return a joint's loss, with which in a steady state it forgets how it began.

    Its natural frequency is in rad/s.
    """
    if not motion.periodic:
        return loss
    cycle = natural * motion.step * motion.time.size  # rad of the joint's own motion
    return max(loss, min(_FORGETS / cycle, _LEAST_LOSS))


def size_of(values: Array) -> float:
    """Return the root mean square."""
    return float(np.sqrt(values @ values / values.size))


@compiled(cache=True, inline="always")
def driven_end(x: Array, v: Array, i: int, share: float) -> tuple[float, float]:
    """Return place and speed of the driven end a share of a sample after sample i, or before it."""
    if share >= 0.0:
        following = i + 1 if i + 1 < x.size else 0
        return x[i] + share * (x[following] - x[i]), v[i] + share * (v[following] - v[i])
    return x[i] + share * (x[i] - x[i - 1]), v[i] + share * (v[i] - v[i - 1])


@compiled(cache=True, inline="always")
def on_curve(curve: Array, top: float, speed: float) -> tuple[float, float]:
    """Return the force and the slope at a speed of a curve given at `speed_curve`'s nodes.

    Beyond the last ones, at `top`, it stays as it is.
    """
    middle, far = curve.size // 2, abs(speed) / top
    if far >= 1.0:
        return curve[2 * middle] if speed > 0.0 else curve[0], 0.0
    k = int(np.sqrt(far) * middle)
    low, high = top * (k / middle) ** 2, top * ((k + 1) / middle) ** 2
    step = 1 if speed > 0.0 else -1
    near = curve[middle + step * k]
    rise = (curve[middle + step * (k + 1)] - near) / (high - low)
    return near + rise * (abs(speed) - low), step * rise


@compiled(cache=True, inline="always")
def tanh(value: float) -> float:
    """Return the hyperbolic tangent to 2e-6 up to `WIDE`, from its continued fraction."""
    s = value * value
    above = 135135.0 + s * (17325.0 + s * (378.0 + s))
    below = 135135.0 + s * (62370.0 + s * (3150.0 + s * 28.0))
    return min(max(value * above / below, -1.0), 1.0)


@compiled(cache=True, error_model="numpy")
def begin(
    before: Array, known: int, place: float, speed: float, place_now: float, speed_now: float
) -> int:
    """Return how many cycles' beginnings are in `before`; after three, the steady one is first.

    From cycle to cycle a state nearly follows a linear map, whose fixed point three steps of it
    give by Cayley and Hamilton. Where the map does not contract the last two are kept.
    """
    # Number by number: what numba makes of rows takes ten times as long to compile.
    before[known, 0] = place
    before[known, 1] = speed
    if known < 2:
        return known + 1
    a0, a1 = before[1, 0] - before[0, 0], before[1, 1] - before[0, 1]
    b0, b1 = before[2, 0] - before[1, 0], before[2, 1] - before[1, 1]
    c0, c1 = place_now - before[2, 0], speed_now - before[2, 1]
    area = a0 * b1 - a1 * b0
    if area != 0.0:  # the map takes a to b and b to c
        trace = (a0 * c1 - a1 * c0) / area
        product = (b0 * c1 - b1 * c0) / area
        if abs(product) < 1.0 and abs(trace) < 1.0 + product:
            left = 1.0 - trace + product
            before[0, 0] = before[2, 0] + (c0 - product * b0) / left
            before[0, 1] = before[2, 1] + (c1 - product * b1) / left
            return 3
    for n in range(2):
        for k in range(2):
            before[n, k] = before[n + 1, k]
    return 2


@compiled(cache=True, inline="always")
def with_friction(free: float, brake: float, slow: float) -> float:
    """Return the speed that dry friction leaves of one, implicitly: it never overshoots.

    Friction takes off `brake` (m/s) where it is whole and reverses over the range `slow`.
    """
    if brake == 0.0:
        return free
    if abs(free) > WIDE * slow + brake:
        return free - brake if free > 0.0 else free + brake
    if abs(free) > slow + brake:
        speed = free - brake if free > 0.0 else free + brake
    else:
        speed = free / (1.0 + brake / slow)
    for _ in range(NEWTON):
        turned = tanh(speed / slow)
        slope = 1.0 + brake / slow * (1.0 - turned * turned)
        speed -= (speed + brake * turned - free) / slope
    return speed


@compiled(cache=True, inline="always")
def with_deflection(free: float, brake: float, state: float, pace: float) -> tuple[float, float]:
    """Return the speed that friction leaves which deflects before it slides, and its new state.

    By Dahl's equation, implicitly: the step takes the mean of the state over it. Friction takes off
    `brake` (m/s) where it slides; a speed of one deflects it by `pace` of its length in the step.
    """
    speed = free - brake * state
    for _ in range(NEWTON + 1):
        side = 1.0 if speed > 0.0 else -1.0
        way = abs(speed) * pace
        if way > NEARLY_STILL:
            kept = np.exp(-way)
            share = (1.0 - kept) / way
            slope = (kept - share) / way
        else:
            share, slope = 1.0 - 0.5 * way, -0.5
        mean = side + (state - side) * share
        steep = 1.0 + brake * (state - side) * slope * side * pace
        speed -= (speed + brake * mean - free) / steep
    side = 1.0 if speed > 0.0 else -1.0
    return speed, side + (state - side) * np.exp(-abs(speed) * pace)

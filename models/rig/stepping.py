"""A device behind an elastic element, in time: play, yielding mounts, oil that tears.

The actuator moves one end of the element by y(t); the device, with all its inertance, is at the
other end: b u'' + drag(u') + wall layer + seal(u') = E(y - u) + d (y' - u'), and E with its damping
is the force that a load cell sees.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from numba import njit

from models.checks import Array
from models.flow import wall_modes
from models.rig.drive import Drive
from models.rig.physics import FlowLaw
from models.rig.reversal import tabulate
from models.rig.seal import Seal

_MODES = 10
_SETTLE = 0.5
_STEP_ANGLE = 0.35
_THETA = 0.52


@dataclass(frozen=True)
class Element:
    """Force E(delta) of the element between actuator and device, piecewise linear."""

    extension: Array
    """(P,) increasing, m."""
    force: Array
    """(P,) non-decreasing, N; continued with the end slopes."""
    damping: float = 0.0
    """Parallel damping where the element's slope is at its greatest, N s/m."""

    refill_time: float = 0.0
    """Time in which oil fills a void, s; 0 for an element that no oil flows into."""
    refill_below: float = 0.0
    """Extension under which there is a void, m."""


def transmitted_force(
    law: FlowLaw, drive: Drive, element: Element, *, seal_behind: bool = True
) -> Array:
    """Return the force (G,) that the element transmits, on the drive's grid, N.

    Parameters
    ----------
    law : FlowLaw
        The device; its oil is taken as stiff.
    drive : Drive
        The actuator's motion.
    element : Element
        What is between them.
    seal_behind : bool
        True where the seals rub behind the element (a joint, a mount), False where they rub before
        it and the element carries the fluid's force alone (a chamber of oil).

    Notes
    -----
    Implicit in the device's speed (theta method, theta = 0.52; the wall layer's modes exactly for
    a speed linear in a step), stepped finely enough for the element's resonance. Sine tests are
    run until transients have died out and the last period is returned; transients once.
    """
    inertance = law.device.inertance
    rates, gain = np.empty(0), 0.0
    if law.physics.wall:
        modes = wall_modes(law.device, count=_MODES)
        rates, gain, inertance = modes.rates, modes.gain, inertance + modes.remainder
    line, load = element.extension, element.force
    slopes = np.diff(load) / np.diff(line)
    stiffness = float(slopes.max())
    resonance = math.sqrt(stiffness / inertance)
    substeps = max(1, math.ceil(resonance * drive.step / _STEP_ANGLE))
    passes = min(40, 1 + math.ceil(_SETTLE / drive.window)) if drive.periodic else 1
    seal = law.seal if seal_behind else replace(law.seal, sliding=0.0)
    return np.asarray(
        _march(
            drive.position,
            drive.velocity,
            drive.step,
            substeps,
            passes,
            inertance,
            np.concatenate([[line[0] - 1.0], line, [line[-1] + 1.0]]),
            np.concatenate([[load[0] - slopes[0]], load, [load[-1] + slopes[-1]]]),
            element.damping,
            stiffness,
            element.refill_time,
            element.refill_below,
            law.table,
            law.top,
            law.physics.seal == "dynamic",
            _numbers(seal),
            tabulate(seal.reversal),
            rates,
            gain,
        )
    )


@njit(cache=True)  # type: ignore[untyped-decorator]
def _element(
    delta: float, rate: float, x: Array, f: Array, d: float, k: float
) -> tuple[float, float, float]:
    """Return the element's force, and its derivatives to delta and rate."""
    low, high = 0, x.size - 1
    while high - low > 1:
        middle = (low + high) // 2
        if x[middle] <= delta:
            low = middle
        else:
            high = middle
    slope = (f[high] - f[low]) / (x[high] - x[low])
    share = d * slope / k
    return f[low] + slope * (delta - x[low]) + share * rate, slope, share


@njit(cache=True)  # type: ignore[untyped-decorator]
def _drag(w: float, table: Array, top: float) -> tuple[float, float]:
    """Return the steady drag at the speed w and its slope."""
    step = top / (table.size - 1)
    place = abs(w) / step
    i = min(int(place), table.size - 2)
    rise = table[i + 1] - table[i]
    return math.copysign(table[i] + (place - i) * rise, w), rise / step


def _numbers(seal: Seal) -> Array:
    """Return the seal's numbers in the order that `_friction` reads them in."""
    return np.array(
        [seal.sliding, seal.breakaway, seal.stribeck_speed, seal.presliding, seal.half_speed]
    )


@njit(cache=True)  # type: ignore[untyped-decorator]
def _share(ratio: float, table: Array) -> tuple[float, float]:
    """Return a reversal's share of the limit at velocity over half speed, and its slope."""
    speed = abs(ratio)
    steps = table.size - 1
    place = steps * speed / (1.0 + speed)
    i = min(int(place), steps - 1)
    rise = table[i + 1] - table[i]
    return math.copysign(table[i] + (place - i) * rise, ratio), rise * steps / (1.0 + speed) ** 2


@njit(cache=True)  # type: ignore[untyped-decorator]
def _friction(
    w: float,
    way: float,
    z: float,
    dynamic: bool,  # noqa: FBT001 - numba has no keyword-only arguments
    seal: Array,
    reversal: Array,
) -> tuple[float, float, float, float]:
    """Return dry friction after the displacement `way`, its slope to `way`, to w, and the state.

    `seal` holds sliding, breakaway, Stribeck speed, presliding and half speed, `reversal` the
    shares of the limit as ``models.rig.reversal`` tabulates them; the laws are those of
    ``models.rig.seal``.
    """
    if not dynamic:
        share, rise = _share(w / seal[4], reversal)
        return seal[0] * share, 0.0, seal[0] * rise / seal[4], z
    limit = 1.0 + (seal[1] - 1.0) * math.exp(-abs(w) / seal[2])
    bound = math.copysign(limit, way)
    left = math.exp(-abs(way) / (seal[3] * limit))
    new = bound + (z - bound) * left
    slope = (bound - z) * left / (seal[3] * bound)
    return seal[0] * new, seal[0] * slope, 0.0, new


@njit(cache=True)  # type: ignore[untyped-decorator]
def _between(
    y0: float, y1: float, v0: float, v1: float, step: float, s: float
) -> tuple[float, float]:
    """Return position and velocity at the share s of a step, by Hermite's cubic.

    A stiff element needs both to agree: linear interpolation would load it with its own error.
    """
    rise = (y1 - y0) / step
    curve, twist = 3.0 * rise - 2.0 * v0 - v1, v0 + v1 - 2.0 * rise
    y = y0 + step * s * (v0 + s * (curve + s * twist))
    return y, v0 + s * (2.0 * curve + 3.0 * s * twist)


# One compiled function, long as it is: a step's parts share the element's state, and numba's
# functions take values and arrays only, no object that holds them.
@njit(cache=True)  # type: ignore[untyped-decorator]
def _march(
    position: Array,
    velocity: Array,
    step: float,
    substeps: int,
    passes: int,
    b: float,
    x: Array,
    f: Array,
    d: float,
    k: float,
    refill: float,
    edge: float,
    table: Array,
    top: float,
    dynamic: bool,  # noqa: FBT001 - numba has no keyword-only arguments
    seal: Array,
    reversal: Array,
    rates: Array,
    gain: float,
) -> Array:
    """March through the grid `passes` times; return the element's force in the last pass."""
    size = position.size
    dt = step / substeps
    count = rates.size
    decay, first, last = np.empty(count), np.empty(count), np.empty(count)
    for m in range(count):
        h = rates[m] * dt
        decay[m] = math.exp(-h)
        mean = -math.expm1(-h) / h
        first[m], last[m] = mean - decay[m], 1.0 - mean
    lag = gain * (count - last.sum())
    memory = np.full(count, velocity[0])
    result = np.empty(size)
    filling = -math.expm1(-dt / refill) if refill > 0.0 else 0.0
    u, w, z = position[0], velocity[0], 0.0
    force, _, _ = _element(0.0, 0.0, x, f, d, k)
    net = force - _drag(w, table, top)[0] - _friction(w, 0.0, z, dynamic, seal, reversal)[0]
    for sweep in range(passes):
        for i in range(size):
            following = (i + 1) % size
            result[i] = force
            if sweep == passes - 1 and i == size - 1:
                break
            for j in range(substeps):
                s = (j + 1.0) / substeps
                y, dy = _between(
                    position[i], position[following], velocity[i], velocity[following], step, s
                )
                past = 0.0
                for m in range(count):
                    past += gain * (decay[m] * memory[m] + first[m] * w)
                low, high = -50.0 * top, 50.0 * top
                new, z_new, net_new = w, z, net
                for _ in range(60):
                    way = dt * (_THETA * new + (1.0 - _THETA) * w)
                    force, slope, share = _element(y - u - way, dy - new, x, f, d, k)
                    drag, rise = _drag(new, table, top)
                    dry, by_way, by_speed, z_new = _friction(new, way, z, dynamic, seal, reversal)
                    net_new = force - drag - dry - (lag * new - past)
                    error = b * (new - w) - dt * (_THETA * net_new + (1.0 - _THETA) * net)
                    if error > 0.0:
                        high = new
                    else:
                        low = new
                    grow = (slope + by_way) * dt * _THETA + share + rise + by_speed + lag
                    trial = new - error / (b + dt * _THETA * grow)
                    # Before the bracket: an exact root is an end of it, and Newton stays there.
                    done = abs(trial - new) <= 1e-12 + 1e-10 * abs(new)
                    if not done and not low < trial < high:
                        trial = 0.5 * (low + high)
                    new = trial
                    if done:
                        break
                for m in range(count):
                    memory[m] = decay[m] * memory[m] + first[m] * w + last[m] * new
                u += dt * (_THETA * new + (1.0 - _THETA) * w)
                # What flows in makes up the void: the device's end counts as that much further.
                u += filling * min(y - u - edge, 0.0)
                w, z, net = new, z_new, net_new
    return result

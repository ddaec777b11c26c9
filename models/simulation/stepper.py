"""The compiled loop: one step after another, trapezoidal in time, with memory and friction.

Over a step the velocity is linear, so x1 - x0 = h (v0 + v1)/2, and momentum balances the impulses,

    M (v1 - v0) + h C (v0 + v1)/2 + h K (x0 + x1)/2 + sum_j d_j I_j = h p (f0 + f1)/2,

I_j being the impulse of device j. Multiplied by the mean velocity this is the energy balance of the
step, so the ledger of works closes to rounding wherever the equation for v1 is solved.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from models.simulation.element_step import device_step
from models.simulation.elements import (
    BY_SPEED,
    CUBIC,
    INERTANCE,
    OFFSET,
    STIFFNESS,
    VISCOUS,
)

INPUT, DAMPING, FRACTIONAL, CURVES, FRICTION_WORK, SWITCHING = range(6)
_SWEEPS = 500
# Sums may be reordered, which lets the modes' loop use vector registers.
_JIT = {"cache": True, "error_model": "numpy", "fastmath": {"reassoc", "contract", "nsz"}}


@njit(**_JIT)
def response_to_impulse(mass, damping, stiffness, directions, h, rows, table, memory, active):  # type: ignore[no-untyped-def] # noqa: ANN001, ANN201
    """Return inverse of the step's matrix, its columns for the devices, and their coupling."""
    size, devices = mass.shape[0], directions.shape[0]
    matrix = mass + 0.5 * h * damping + 0.25 * h * h * stiffness
    for j in range(devices):
        row = rows[j]
        own = 0.5 * h * table[row, VISCOUS] + 0.25 * h * h * table[row, STIFFNESS]
        own += table[row, INERTANCE]
        for m in range(active.shape[0]):
            if active[m, 0] == j and active[m, 1] == rows[j]:
                own += memory[m, 0] * memory[m, 1]
        for i in range(size):
            for k in range(size):
                matrix[i, k] += own * directions[j, i] * directions[j, k]
    if matrix.shape[0] == 1:
        inverse = 1.0 / matrix
    else:
        inverse = np.linalg.inv(matrix)
    columns = np.zeros((size, devices))
    for i in range(size):
        for j in range(devices):
            for k in range(size):
                columns[i, j] += inverse[i, k] * directions[j, k]
    coupling = np.zeros((devices, devices))
    for i in range(devices):
        for j in range(devices):
            for k in range(size):
                coupling[i, j] += directions[i, k] * columns[k, j]
    return inverse, columns, coupling


# One compiled function, long as it is: a step's parts share so many arrays that each call would
# hand them all on, and numba's functions take values and arrays only, no objects that hold them.
@njit(**_JIT)
def advance(  # type: ignore[no-untyped-def] # noqa: ANN201
    mass, damping, stiffness, directions, ends, pattern, h, load,  # noqa: ANN001
    first, table, curve_first, curves, edges, coordinate,  # noqa: ANN001
    memory, place, mode_first, bank,  # noqa: ANN001
    x, v, w, modes, rows, cycle, reversal, impulse, ledger, counts,  # noqa: ANN001
    every, out_x, out_v, out_f,  # noqa: ANN001
):
    """Advance the state in place by load.size - 1 steps and fill the outputs.

    Parameters
    ----------
    mass, damping, stiffness : (n, n)
    directions : (q, n), ends : (q, 2) int, -1 for ground
    pattern : (n,) load per unit of `load`, (steps + 1,)
    first ... coordinate : the fields of `Elements`
    memory : (m, 6) coefficient, weights of w_new, w_now, w_before, w_now at the start, w's zero
    place : (m, 2) device, row; mode_first : (m + 1,);
    bank : (3, modes) decay over a step, weights of w at the start and the end of an interval
    x, v : (n,); w : (m, 3) newest first; modes : (modes,)
    rows : (q,) active rows; cycle : (q, 2) peak speed, sign; reversal : (q,) step of the last one
    impulse : (q, 4) of the last step, the one before, the first, the second; ledger : (6,) works;
    counts : steps, output row, switches, age
    every : steps between outputs, whose rows are out_x, out_v (n) and out_f (q)
    """
    size, devices, memories = x.size, directions.shape[0], place.shape[0]
    inverse, columns, coupling = response_to_impulse(
        mass, damping, stiffness, directions, h, rows, table, memory, place
    )
    rest = np.empty(size)
    ended = np.empty(size)
    linear = np.empty(devices)
    recalled = np.empty(memories)
    bend = np.zeros(devices)
    shift = np.zeros(devices)
    rub = np.zeros(devices)
    speed = np.empty(devices)
    stroke = np.empty(devices)
    stuck = np.zeros(devices, dtype=np.bool_)
    for step in range(load.size - 1):
        push = 0.5 * (load[step] + load[step + 1])
        age = counts[3]
        for j in range(devices):
            u, s = 0.0, 0.0
            for i in range(size):
                u += directions[j, i] * v[i]
                s += directions[j, i] * x[i]
            speed[j], stroke[j] = u, s
            row = rows[j]
            linear[j] = (0.5 * h * table[row, VISCOUS] - table[row, INERTANCE]) * u
            linear[j] += h * table[row, STIFFNESS] * (s + 0.25 * h * u)
        for m in range(memories):
            j = place[m, 0]
            gone = 0.0
            if age >= 2:
                older, newer = w[m, 2], w[m, 1]
                for i in range(mode_first[m], mode_first[m + 1]):
                    y = bank[0, i] * modes[i] + bank[1, i] * older + bank[2, i] * newer
                    modes[i] = y
                    gone += y
            now = memory[m, 2] if age >= 1 else memory[m, 4]
            # At the end w is u - w(0); the constant part belongs to the known side.
            gone += now * w[m, 0] + memory[m, 3] * w[m, 1]
            recalled[m] = gone - memory[m, 1] * memory[m, 5]
            if place[m, 1] == rows[j]:
                linear[j] += memory[m, 0] * recalled[m]

        for i in range(size):
            total = h * pattern[i] * push
            for k in range(size):
                total += (mass[i, k] - 0.5 * h * damping[i, k]) * v[k]
                total -= stiffness[i, k] * (h * x[k] + 0.25 * h * h * v[k])
            for j in range(devices):
                total -= directions[j, i] * linear[j]
            rest[i] = total
        for i in range(size):
            total = 0.0
            for k in range(size):
                total += inverse[i, k] * rest[k]
            ended[i] = total

        for _ in range(_SWEEPS):
            largest, moved = 0.0, 0.0
            for j in range(devices):
                row = rows[j]
                free = 0.0
                for i in range(size):
                    free += directions[j, i] * ended[i]
                for k in range(devices):
                    if k != j:
                        free -= coupling[j, k] * (bend[k] + shift[k] + rub[k])
                before = bend[j] + shift[j] + rub[j]
                _, bend[j], shift[j], rub[j], stuck[j] = device_step(
                    speed[j], stroke[j], free, coupling[j, j], h, table, row, curves,
                    curve_first[row], curve_first[row + 1],
                )
                after = bend[j] + shift[j] + rub[j]
                moved = max(moved, abs(after - before))
                largest = max(largest, abs(after))
            if devices < 2 or moved <= 1e-15 * largest:
                break
        for j in range(devices):
            force = bend[j] + shift[j] + rub[j]
            for i in range(size):
                ended[i] -= columns[i, j] * force
        for j in range(devices):
            if stuck[j]:  # rounding must not move what sticks
                upper, lower = ends[j, 0], ends[j, 1]
                ended[upper] = ended[lower] if lower >= 0 else 0.0

        for i in range(size):
            mean = 0.5 * (v[i] + ended[i])
            ledger[INPUT] += h * push * pattern[i] * mean
            for k in range(size):
                ledger[DAMPING] += h * mean * damping[i, k] * 0.5 * (v[k] + ended[k])
        outputs = counts[0] % every == 0
        turned = False
        for j in range(devices):
            u = 0.0
            for i in range(size):
                u += directions[j, i] * ended[i]
            row = rows[j]
            mean = 0.5 * (speed[j] + u)
            ledger[DAMPING] += h * table[row, VISCOUS] * mean * mean
            ledger[CURVES] += bend[j] * mean
            ledger[FRICTION_WORK] += rub[j] * mean
            whole = bend[j] + shift[j] + rub[j]
            whole += table[row, INERTANCE] * (u - speed[j]) + h * table[row, VISCOUS] * mean
            whole += h * table[row, STIFFNESS] * (stroke[j] + 0.5 * h * mean)
            for m in range(memories):
                if place[m, 0] == j:
                    fresh = u - memory[m, 5]
                    if place[m, 1] == rows[j]:
                        part = memory[m, 0] * (recalled[m] + memory[m, 1] * u)
                        ledger[FRACTIONAL] += part * mean
                        whole += part
                    w[m, 2], w[m, 1], w[m, 0] = w[m, 1], w[m, 0], fresh
            if outputs:
                out_f[counts[1], j] = 0.5 * (impulse[j, 0] + whole) / h
            impulse[j, 1], impulse[j, 0] = impulse[j, 0], whole
            if counts[0] < 2:
                impulse[j, 2 + counts[0]] = whole
            if first[j + 1] - first[j] > 1:
                turned |= _follow_band(
                    j, u, stroke[j] + h * mean, h, first, table, edges, coordinate, rows, cycle,
                    reversal, ledger, counts,
                )
        if outputs:
            for i in range(size):
                out_x[counts[1], i] = x[i]
                out_v[counts[1], i] = v[i]
            counts[1] += 1
        for i in range(size):
            x[i] += 0.5 * h * (v[i] + ended[i])
            v[i] = ended[i]
        counts[0] += 1
        counts[3] += 1
        if turned:
            inverse, columns, coupling = response_to_impulse(
                mass, damping, stiffness, directions, h, rows, table, memory, place
            )


@njit(**_JIT)
def _follow_band(  # type: ignore[no-untyped-def] # noqa: ANN202
    j, u, s, h, first, table, edges, coordinate, rows, cycle, reversal, ledger, counts  # noqa: ANN001
):
    """At a reversal choose the band of the half-cycle that has ended; True where it changed."""
    side = np.sign(u)
    if side == 0.0 or side == cycle[j, 1]:
        cycle[j, 0] = max(cycle[j, 0], abs(u))
        return False
    half = (counts[0] + 1 - reversal[j]) * h
    known = cycle[j, 1] != 0.0 and (coordinate[j] == BY_SPEED or reversal[j] >= 0)
    value = cycle[j, 0] if coordinate[j] == BY_SPEED else 0.5 / half
    cycle[j, 0], cycle[j, 1] = abs(u), side
    reversal[j] = counts[0] + 1
    if not known:
        return False
    chosen = first[j]
    while chosen < first[j + 1] - 1 and value >= edges[chosen]:
        chosen += 1
    if chosen == rows[j]:
        return False
    was = rows[j]
    ledger[SWITCHING] += 0.5 * (table[chosen, INERTANCE] - table[was, INERTANCE]) * u * u
    ledger[SWITCHING] += 0.5 * (table[chosen, STIFFNESS] - table[was, STIFFNESS]) * s * s
    ledger[SWITCHING] += 0.25 * (table[chosen, CUBIC] - table[was, CUBIC]) * s**4
    ledger[SWITCHING] += (table[chosen, OFFSET] - table[was, OFFSET]) * s
    rows[j] = chosen
    counts[2] += 1
    return True

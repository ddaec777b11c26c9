"""One simulation at one step: the state in arrays, driven through the compiled loop in chunks."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from models.checks import Array
from models.simulation.elements import (
    CUBIC,
    END_STOP,
    INERTANCE,
    OFFSET,
    STIFFNESS,
    Elements,
)
from models.simulation.load import Load
from models.simulation.memory import ImpulseMemory, impulse_memory
from models.simulation.response import EnergyBalance, PeriodicPast
from models.simulation.stepper import advance
from models.structure import Structure

_CHUNK = 1 << 16  # steps between evaluations of the load: bounds the memory that it takes


@dataclass(frozen=True)
class Run:
    """Outputs of one run."""

    time: Array
    """(N,) s."""
    displacement: Array
    """(N, n) m."""
    velocity: Array
    """(N, n) m/s."""
    device_force: Array
    """(N, q) N."""
    energy: EnergyBalance
    """At the end."""
    switches: int
    """Changes of band."""


def run(
    structure: Structure,
    elements: Elements,
    load: Load,
    *,
    step: float,
    steps: int,
    every: int,
    displacement: Array,
    velocity: Array,
    past: PeriodicPast | None,
    kernel_error: float,
) -> Run:
    """Return `steps` steps from the given state, every `every`-th kept."""
    directions = structure.directions
    devices, size = directions.shape
    memories = tuple(
        impulse_memory(term.order, step, step * steps, error=kernel_error)
        for term in elements.fractional
    )
    x, v = displacement.copy(), velocity.copy()
    w, modes, scalars = _memory_state(structure, elements, memories, v, step, past)
    place = np.array([[t.device, t.band] for t in elements.fractional], dtype=np.int64)
    mode_first = np.concatenate([[0], np.cumsum([m.rates.size for m in memories])]).astype(np.int64)
    bank = np.concatenate([m.bank for m in memories] or [np.zeros((3, 0))], axis=1)
    rows = elements.first[:-1].copy()
    cycle = np.zeros((devices, 2))
    reversal = np.full(devices, -1, dtype=np.int64)
    impulse = np.zeros((devices, 4))
    ledger = np.zeros(6)
    counts = np.array([0, 0, 0, 2 if past is not None else 0], dtype=np.int64)
    kept = steps // every + 1
    out_x, out_v = np.empty((kept, size)), np.empty((kept, size))
    out_f = np.zeros((kept, devices))
    at_start = _stored(structure, elements, rows, x, v)
    initial = at_start[0] + at_start[1]
    pattern = load.vector(structure.mass)
    ends = np.array(
        [[m.upper, -1 if m.lower is None else m.lower] for m in structure.devices], dtype=np.int64
    ).reshape(-1, 2)
    for start in range(0, steps, _CHUNK):
        count = min(_CHUNK, steps - start)
        values = load.history(step * np.arange(start, start + count + 1, dtype=np.float64))
        advance(
            structure.mass, structure.damping, structure.stiffness, directions, ends, pattern,
            step, np.ascontiguousarray(values, dtype=np.float64),
            elements.first, elements.table, elements.curve_first, elements.curves,
            elements.edges, elements.coordinate,
            scalars, place.reshape(-1, 2), mode_first, bank,
            x, v, w, modes, rows, cycle, reversal, impulse, ledger, counts,
            every, out_x, out_v, out_f,
        )  # fmt: skip
    if steps % every == 0:
        out_x[-1], out_v[-1] = x, v
        out_f[-1] = (3.0 * impulse[:, 0] - impulse[:, 1]) / (2.0 * step)
    if steps > 1:
        out_f[0] = (3.0 * impulse[:, 2] - impulse[:, 3]) / (2.0 * step)
    kinetic, potential = _stored(structure, elements, rows, x, v)
    work_in, viscous, fractional, curved, friction, switching = (float(e) for e in ledger)
    turnover = sum(abs(e) for e in ledger) + abs(initial) + abs(kinetic) + abs(potential)
    energy = EnergyBalance(
        work_in, initial, kinetic, potential, viscous, fractional, curved, friction, switching,
        turnover,
    )  # fmt: skip
    time: Array = step * every * np.arange(kept, dtype=np.float64)
    return Run(time, out_x, out_v, out_f, energy, int(counts[2]))


def _memory_state(
    structure: Structure,
    elements: Elements,
    memories: tuple[ImpulseMemory, ...],
    velocity: Array,
    step: float,
    past: PeriodicPast | None,
) -> tuple[Array, Array, Array]:
    """Return recent speeds (m, 3), modes two steps back, and each memory's scalars (m, 6)."""
    w = np.zeros((len(memories), 3))
    scalars = np.zeros((len(memories), 6))
    modes = [np.zeros(0)]
    for i, (term, memory) in enumerate(zip(elements.fractional, memories, strict=True)):
        direction = structure.directions[term.device]
        at_start = float(direction @ velocity)
        zero = at_start if memory.from_rest and past is None else 0.0
        scalars[i] = (term.coefficient, *memory.recent, memory.first, zero)
        if past is None:
            w[i, 0] = at_start - zero
            modes.append(np.zeros(memory.rates.size))
            continue
        w[i] = past.velocity(-step * np.arange(3)) @ direction
        harmonics = past.rates[1:]
        turn = 1j * harmonics * np.exp(-2j * harmonics * step)
        response = (turn * (past.coefficients[1:] @ direction)) / np.add.outer(
            memory.rates, 1j * harmonics
        )
        modes.append(memory.gain * response.sum(axis=1).real)
    return w, np.concatenate(modes), scalars


def _stored(
    structure: Structure, elements: Elements, rows: NDArray[np.int64], x: Array, v: Array
) -> tuple[float, float]:
    """Return kinetic and potential energy, J, the devices' included."""
    kinetic = 0.5 * float(v @ structure.mass @ v)
    potential = 0.5 * float(x @ structure.stiffness @ x)
    for direction, row in zip(structure.directions, rows, strict=True):
        values = elements.table[int(row)]
        u, s = float(direction @ v), float(direction @ x)
        kinetic += 0.5 * values[INERTANCE] * u * u
        potential += 0.5 * values[STIFFNESS] * s * s + 0.25 * values[CUBIC] * s**4
        potential += values[OFFSET] * s
        for code, stiffness, gap, power in elements.curves[
            elements.curve_first[row] : elements.curve_first[row + 1]
        ]:
            if code == END_STOP:
                depth = max(np.sign(gap) * s - abs(gap), 0.0)
                potential += stiffness * depth ** (power + 1.0) / (power + 1.0)
    return kinetic, potential

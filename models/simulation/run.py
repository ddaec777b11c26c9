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
from models.simulation.recall import Memories, Recall, memories
from models.simulation.response import EnergyBalance, PeriodicPast
from models.simulation.stepper import advance
from models.structure import Structure

_CHUNK = 1 << 16  # steps between evaluations of the load: bounds the memory that it takes
_START_SHARE = 64  # of the steps, at most, are a graded start
_SHORTEST_START = 4 * _START_SHARE
_LONGEST_START = 4096  # steps
_LEVELS = 12  # halvings of the step towards the start


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


class _Machine:
    """The state of a simulation, and the compiled loop that carries it on."""

    def __init__(
        self, structure: Structure, elements: Elements, load: Load, x: Array, v: Array
    ) -> None:
        devices = len(structure.devices)
        self.structure, self.elements, self.load = structure, elements, load
        self.pattern = load.vector(structure.mass)
        ends = [[m.upper, -1 if m.lower is None else m.lower] for m in structure.devices]
        self.ends = np.array(ends, dtype=np.int64).reshape(-1, 2)
        self.x, self.v = x.copy(), v.copy()
        self.rows = elements.first[:-1].copy()
        self.cycle = np.zeros((devices, 2))
        self.reversal = np.full(devices, -1, dtype=np.int64)
        self.impulse = np.zeros((devices, 4))
        self.ledger = np.zeros(6)
        self.counts = np.zeros(4, dtype=np.int64)

    def go(
        self, recall: Recall, step: float, steps: int, *, start: float, every: int, out: Outputs
    ) -> None:
        """Go `steps` steps on from time `start`, s, keeping every `every`-th state in `out`."""
        structure, elements = self.structure, self.elements
        self.counts[3] = recall.age
        for first in range(0, steps, _CHUNK):
            count = min(_CHUNK, steps - first)
            times = start + step * np.arange(first, first + count + 1, dtype=np.float64)
            advance(
                structure.mass, structure.damping, structure.stiffness, structure.directions,
                self.ends, self.pattern, step,
                np.ascontiguousarray(self.load.history(times), dtype=np.float64),
                elements.first, elements.table, elements.curve_first, elements.curves,
                elements.edges, elements.coordinate,
                recall.scalars, recall.place, recall.mode_first, recall.bank,
                self.x, self.v, recall.w, recall.modes, self.rows, self.cycle, self.reversal,
                self.impulse, self.ledger, self.counts,
                every, out.displacement, out.velocity, out.device_force,
            )  # fmt: skip

    def last_force(self, step: float) -> Array:
        """Return the devices' forces now, (q,) N, from the last two steps."""
        return np.asarray((3.0 * self.impulse[:, 0] - self.impulse[:, 1]) / (2.0 * step))

    def first_force(self, step: float) -> Array:
        """Return the devices' forces at the start, (q,) N, from the first two steps."""
        return np.asarray((3.0 * self.impulse[:, 2] - self.impulse[:, 3]) / (2.0 * step))


@dataclass(frozen=True)
class Outputs:
    """States that are kept."""

    displacement: Array
    """(N, n) m."""
    velocity: Array
    """(N, n) m/s."""
    device_force: Array
    """(N, q) N."""


def _outputs(structure: Structure, kept: int) -> Outputs:
    size, devices = structure.size, len(structure.devices)
    return Outputs(np.empty((kept, size)), np.empty((kept, size)), np.zeros((kept, devices)))


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
    machine = _Machine(structure, elements, load, displacement, velocity)
    at_start = _stored(structure, elements, machine.rows, displacement, velocity)
    initial = at_start[0] + at_start[1]
    held = memories(structure, elements, step, step * steps, kernel_error)
    kept = steps // every + 1
    out = _outputs(structure, kept)
    done = 0
    if past is not None:
        recall = held.in_steady_state(past)
    elif steps >= _SHORTEST_START and _starts_steeply(structure, elements):
        # A fixed share of the time, so that halving the step halves every step of it.
        done = min(1 << ((steps // _START_SHARE).bit_length() - 1), _LONGEST_START)
        recall = _graded_start(machine, held, step, done, every, out, kernel_error)
    else:
        recall = held.at_rest(velocity)
    machine.go(recall, step, steps - done, start=step * done, every=every, out=out)
    if steps % every == 0:
        out.displacement[-1], out.velocity[-1] = machine.x, machine.v
        out.device_force[-1] = machine.last_force(step)
    if steps > 1 and not done:
        out.device_force[0] = machine.first_force(step)
    kinetic, potential = _stored(structure, elements, machine.rows, machine.x, machine.v)
    ledger = [float(e) for e in machine.ledger]
    turnover = sum(abs(e) for e in ledger) + abs(initial) + abs(kinetic) + abs(potential)
    work_in, viscous, fractional, curved, friction, switching = ledger
    energy = EnergyBalance(
        work_in, initial, kinetic, potential, viscous, fractional, curved, friction, switching,
        turnover,
    )  # fmt: skip
    time: Array = step * every * np.arange(kept, dtype=np.float64)
    switches = int(machine.counts[2])
    return Run(time, out.displacement, out.velocity, out.device_force, energy, switches)


def _starts_steeply(structure: Structure, elements: Elements) -> bool:
    """Tell whether a fractional term of order above one moves something without inertia.

    The velocity then starts as a power of time below one, and equal steps lose their order.
    """
    if not any(1.0 < t.order for t in elements.fractional):
        return False
    inertia = np.array(structure.mass)
    for direction, row in zip(structure.directions, elements.first[:-1], strict=True):
        inertia += elements.table[row, INERTANCE] * np.outer(direction, direction)
    return bool(np.linalg.matrix_rank(inertia) < structure.size)


def _graded_start(
    machine: _Machine,
    held: Memories,
    step: float,
    done: int,
    every: int,
    out: Outputs,
    kernel_error: float,
) -> Recall:
    """Go through the first `done` steps with ever shorter ones towards the start.

    Stretch after stretch, each twice as long as all before it, with twice the step. Returns the
    memories at its end, for `step`.
    """
    structure, elements = machine.structure, machine.elements
    time: list[Array] = []
    moved: list[Array] = []
    speeds: list[Array] = []
    forces: list[Array] = []
    now = 0.0
    recall = memories(
        structure, elements, step / 2**_LEVELS, step * done, kernel_error
    ).at_rest(machine.v)
    for level in range(_LEVELS, -1, -1):
        own_step = step / 2**level
        steps = done if level == _LEVELS else done // 2
        if level < _LEVELS:
            own = memories(structure, elements, own_step, step * done, kernel_error)
            recall = own.after(np.append(np.concatenate(time), now),
                               np.vstack([*speeds, machine.v]))  # fmt: skip
            machine.impulse[:, :2] *= 2.0  # as impulses of this stretch's steps
        stretch = _outputs(structure, steps)
        machine.counts[0] = machine.counts[1] = 0
        machine.go(recall, own_step, steps, start=now, every=1, out=stretch)
        if level == _LEVELS:
            stretch.device_force[0] = machine.first_force(own_step)
        time.append(now + own_step * np.arange(steps))
        moved.append(stretch.displacement)
        speeds.append(stretch.velocity)
        forces.append(stretch.device_force)
        now = step * done / 2**level
    times = np.concatenate(time)
    wanted = step * np.arange(0, done, every)
    at = np.searchsorted(times, wanted - 0.5 * step / 2**_LEVELS)
    count = wanted.size
    out.displacement[:count] = np.concatenate(moved)[at]
    out.velocity[:count] = np.concatenate(speeds)[at]
    out.device_force[:count] = np.concatenate(forces)[at]
    machine.counts[0], machine.counts[1] = done, count
    return held.after(np.append(times, now), np.vstack([*speeds, machine.v]))


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

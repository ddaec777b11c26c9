"""What the memories hold at the start of a stretch of equal steps: rest, a steady state, a past."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from models.checks import Array
from models.simulation.elements import Elements
from models.simulation.memory import ImpulseMemory, impulse_memory, phi_one, phi_two
from models.simulation.response import PeriodicPast
from models.structure import Structure


@dataclass(frozen=True)
class Recall:
    """Memories as the compiled loop takes them; `w` and `modes` change as it goes."""

    scalars: Array
    """(m, 6) coefficient, weights of w, w's zero."""
    place: NDArray[np.int64]
    """(m, 2) device and row."""
    mode_first: NDArray[np.int64]
    """(m + 1,) first mode of each memory."""
    bank: Array
    """(3, modes) recurrence of the modes."""
    w: Array
    """(m, 3) speeds now, one and two steps back."""
    modes: Array
    """(modes,) two steps back."""
    age: int
    """Steps since rest, at most two."""


@dataclass(frozen=True)
class Memories:
    """Recurrences of all fractional terms at one step."""

    structure: Structure
    """Where the devices are."""
    elements: Elements
    """Their terms."""
    each: tuple[ImpulseMemory, ...]
    """One a term."""
    step: float
    """s."""

    def at_rest(self, velocity: Array) -> Recall:
        """Return memories that begin now, at a velocity (n,) m/s."""
        speeds = self._speeds(velocity)
        zeros = self._zeros(speeds)
        w = np.zeros((len(self.each), 3))
        w[:, 0] = speeds - zeros
        return self._recall(zeros, w, [np.zeros(m.rates.size) for m in self.each], 0)

    def in_steady_state(self, past: PeriodicPast) -> Recall:
        """Return memories that have held a steady state since ever."""
        w = np.zeros((len(self.each), 3))
        modes = []
        harmonics = past.rates[1:]
        turn = 1j * harmonics * np.exp(-2j * harmonics * self.step)
        for i, (way, memory) in enumerate(zip(self._ways, self.each, strict=True)):
            w[i] = past.velocity(-self.step * np.arange(3)) @ way
            lines = turn * (past.coefficients[1:] @ way)
            response = lines / np.add.outer(memory.rates, 1j * harmonics)
            modes.append(memory.gain * response.sum(axis=1).real)
        return self._recall(np.zeros(len(self.each)), w, modes, 2)

    def after(self, time: Array, velocity: Array) -> Recall:
        """Return memories that hold a motion from rest at time[0] on, linear between samples.

        Parameters
        ----------
        time : ndarray, shape (T,)
            s, from the start to now, with now less one and two steps among the samples.
        velocity : ndarray, shape (T, n)
            m/s.
        """
        zeros = self._zeros(self._speeds(velocity[0]))
        back = time[-1] - self.step * np.arange(3)
        old = time <= back[2] + 1e-9 * self.step
        w = np.zeros((len(self.each), 3))
        modes = []
        for i, (way, memory) in enumerate(zip(self._ways, self.each, strict=True)):
            speed = velocity @ way - zeros[i]
            w[i] = np.interp(back, time, speed)
            modes.append(memory.gain * _held(memory.rates, time[old], speed[old]))
        return self._recall(zeros, w, modes, 2)

    @property
    def _ways(self) -> Array:
        return np.asarray(
            [self.structure.directions[t.device] for t in self.elements.fractional]
        ).reshape(-1, self.structure.size)

    def _speeds(self, velocity: Array) -> Array:
        return np.asarray(self._ways @ velocity)

    def _zeros(self, speeds: Array) -> Array:
        return np.where([m.from_rest for m in self.each], speeds, 0.0)

    def _recall(self, zeros: Array, w: Array, modes: list[Array], age: int) -> Recall:
        scalars = np.zeros((len(self.each), 6))
        for i, (term, memory) in enumerate(zip(self.elements.fractional, self.each, strict=True)):
            scalars[i] = (term.coefficient, *memory.recent, memory.first, zeros[i])
        place = [[t.device, t.band] for t in self.elements.fractional]
        sizes = [m.rates.size for m in self.each]
        return Recall(
            scalars,
            np.array(place, dtype=np.int64).reshape(-1, 2),
            np.concatenate([[0], np.cumsum(sizes)]).astype(np.int64),
            np.concatenate([m.bank for m in self.each] or [np.zeros((3, 0))], axis=1),
            w,
            np.concatenate(modes or [np.zeros(0)]),
            age,
        )


def memories(
    structure: Structure, elements: Elements, step: float, horizon: float, error: float
) -> Memories:
    """Return the recurrences at a step, for `horizon` seconds."""
    each = tuple(
        impulse_memory(term.order, step, horizon, error=error) for term in elements.fractional
    )
    return Memories(structure, elements, each, step)


def _held(rates: Array, time: Array, speed: Array) -> Array:
    """Return the integral of exp(-r (t_end - t)) w(t), w linear between samples, (M,)."""
    if time.size < 2:
        return np.zeros_like(rates)
    gaps = np.diff(time)
    z = np.outer(rates, gaps)
    near, whole = phi_two(z), phi_one(z)
    parts = gaps * ((whole - near) * speed[:-1] + near * speed[1:])
    return np.asarray((np.exp(-np.outer(rates, time[-1] - time[1:])) * parts).sum(axis=1))

"""Stability of a steady state, fractional memory included: counting exponents that grow.

A disturbance exp(s t) p(t), p periodic, obeys J(s) p = 0, with the linear part of harmonic k at
s + i k omega. The number of roots with Re s > 0 and |Im s| <= omega/2 follows from the argument
principle: the phase of det J along the imaginary axis, relative to that of the inertia alone.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from models.checks import Array
from models.harmonic_balance.forces import sort_forces
from models.harmonic_balance.problem import reverses
from models.harmonic_balance.steady_state import SteadyState

_SMOOTH_HARMONICS = 20
_LARGEST_TURN = 0.6  # rad between neighbouring points of the contour
_CLOSEST = 1e-9


def unstable_exponents(state: SteadyState) -> int:
    """Return the number of growing exponents; zero for a stable state.

    Examples
    --------
    >>> from models.harmonic_balance import SineDrive, steady_state
    >>> from models.structure import oscillator
    >>> state = steady_state(oscillator(1.0, 1.0, damping=0.1), SineDrive(1.0), 0.1)
    >>> unstable_exponents(state)
    0
    """
    hill = _Hill(state)
    half = 0.5 * state.omega
    pending = [(k / 16.0, (k + 1) / 16.0) for k in range(16)]
    values: dict[float, complex] = {}

    def phase(at: float) -> complex:
        if at not in values:
            values[at] = hill.sign(1j * half * at)
        return values[at]

    total = 0.0
    while pending:
        a, b = pending.pop()
        middle = 0.5 * (a + b)
        first = float(np.angle(phase(middle) / phase(a)))
        second = float(np.angle(phase(b) / phase(middle)))
        if max(abs(first), abs(second)) > _LARGEST_TURN and b - a > _CLOSEST:
            pending += [(a, middle), (middle, b)]
        else:
            total += first + second
    # Up the axis is clockwise about the right half plane; the lower half mirrors the upper.
    return max(round(-2.0 * total / (2.0 * np.pi)), 0)


class _Hill:
    """J(s) with everything that does not depend on s prepared."""

    def __init__(self, state: SteadyState) -> None:
        structure = state.structure
        forces = sort_forces(structure)
        rubs = any(law.rubs for law in forces)
        own = state.coefficients.shape[0] - 1
        harmonics = own if rubs else min(own, _SMOOTH_HARMONICS)
        count = 2 * harmonics + 1
        self.omega, self.structure, self.forces = state.omega, structure, forces
        self.k = np.arange(-harmonics, harmonics + 1)
        phase = 2.0 * np.pi * np.arange(count) / count
        self.samples = np.exp(1j * np.outer(phase, self.k))
        self.coefficients = self.samples.conj().T / count
        mean = np.sinc(self.k / count)
        self.from_cells, self.rub_samples = self.coefficients / mean[:, None], self.samples / mean
        rates = 1j * state.omega * np.arange(own + 1)
        turn = np.exp(np.outer(phase / state.omega, rates))
        smooth = state.coefficients @ structure.directions.T
        moved, speed = (turn @ smooth).real, (turn @ (rates[:, None] * smooth)).real
        self.by_x: list[NDArray[np.complex128] | None] = []
        self.by_v: list[NDArray[np.complex128] | None] = []
        self.held: list[NDArray[np.int64]] = []
        self.corner: list[Array] = []
        self.share: list[Array] = []
        for j, law in enumerate(forces):
            slope_x, slope_v = law.slopes(moved[:, j], speed[:, j])
            by_v = self._carried(slope_v)
            self.by_x.append(self._carried(slope_x))
            held, corner, share = np.zeros(0, dtype=np.int64), np.zeros(0), np.zeros(0)
            if law.rubs:
                sharp = rates / np.sinc(np.arange(own + 1) / count) * smooth[:, j]
                velocity, change = (turn @ sharp).real, (turn @ (rates * sharp)).real
                held = np.nonzero(state.held[j])[0]
                at_rest = float(law.limit(np.zeros(1))[0][0])
                cell = np.pi / count / state.omega
                shift = cell * change[held]
                before, after = velocity[held - 1], velocity[(held + 1) % count]
                shift = np.where(reverses(before, after, shift), shift, 0.0)
                corner = -np.abs(shift) / at_rest
                share = cell * np.sign(shift) * state.friction[j, held] / at_rest
                if law.stribeck:
                    falling = law.limit(velocity)[1] * np.sign(state.friction[j])
                    falling = np.where(state.held[j], 0.0, falling)
                    rubbed = self.from_cells @ (falling[:, None] * self.rub_samples)
                    by_v = rubbed if by_v is None else by_v + rubbed
            self.by_v.append(by_v)
            self.held.append(held)
            self.corner.append(corner)
            self.share.append(share)

    def _carried(self, slope: Array) -> NDArray[np.complex128] | None:
        if not slope.any():
            return None
        return np.asarray(self.coefficients @ (slope[:, None] * self.samples))

    def sign(self, s: complex) -> complex:
        """Return the phase factor of det J(s) over that of the inertia, moved off the axis."""
        structure, size, count = self.structure, self.structure.size, self.k.size
        rates = s + 1j * self.omega * self.k
        square = rates[:, None, None]
        blocks = square**2 * structure.mass + square * structure.damping + structure.stiffness
        matrix = np.zeros((size, count, size, count), dtype=np.complex128)
        diagonal = np.arange(count)
        rows, columns = [], []
        for j, law in enumerate(self.forces):
            direction = structure.directions[j]
            dyad = np.outer(direction, direction)
            scalar = np.zeros(count, dtype=np.complex128)
            for order, coefficient in law.linear:
                scalar += coefficient * rates**order
            blocks = blocks + scalar[:, None, None] * dyad
            for carried, factor in ((self.by_x[j], np.ones(count)), (self.by_v[j], rates)):
                if carried is not None:
                    own = carried * factor
                    matrix += dyad[:, None, :, None] * own[None, :, None, :]
            for index, share in zip(self.held[j], self.share[j], strict=True):
                rule = self.rub_samples[index] * rates * (1.0 - share * rates)
                rows.append(np.outer(direction, rule).ravel())
                columns.append(np.outer(direction, self.from_cells[:, index]).ravel())
        matrix[:, diagonal, :, diagonal] += blocks
        total = matrix.reshape(size * count, size * count)
        if rows:
            extra = len(rows)
            wide = np.zeros((total.shape[0] + extra,) * 2, dtype=np.complex128)
            wide[:-extra, :-extra] = total
            wide[-extra:, :-extra] = np.array(rows)
            wide[:-extra, -extra:] = np.array(columns).T
            wide[-extra:, -extra:] = np.diag(np.concatenate(self.corner))
            total = wide
        value = complex(np.linalg.slogdet(total)[0])
        # Inertia alone, its roots at -omega - i k omega: on the stable side, none on the contour.
        reference = (rates + self.omega) ** (2 * size)
        phase = np.exp(-1j * np.angle(reference).sum())
        return complex(value * phase)

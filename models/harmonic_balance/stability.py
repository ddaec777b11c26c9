"""Stability of a steady state, fractional memory included: counting exponents that grow.

A disturbance exp(s t) p(t), p periodic, obeys J(s) p = 0, with the linear part of harmonic k at
s + i k omega. The number of roots with Re s > 0 and |Im s| <= omega/2 follows from the argument
principle: the phase of det J along the imaginary axis, relative to that of the inertia alone.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from models.checks import Array
from models.harmonic_balance.friction import rules
from models.harmonic_balance.problem import SHARP, dynamic_stiffness, make_problem, relative_motion
from models.harmonic_balance.steady_state import SteadyState, unknowns_of

Complex = NDArray[np.complex128]

_SMOOTH_HARMONICS = 20
_LARGEST_TURN = 0.6  # rad between neighbouring points of the contour
_CLOSEST = 1e-9


def unstable_exponents(state: SteadyState) -> int:
    """Return the number of growing exponents; zero for a stable state.

    Parameters
    ----------
    state : SteadyState
        From `steady_state` or a point of a branch.

    Returns
    -------
    int

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
        rubs = bool(state.held.any() or np.abs(state.friction).any())
        own = state.coefficients.shape[0] - 1
        harmonics = own if rubs else min(own, _SMOOTH_HARMONICS)
        problem = make_problem(state.structure, state.drive, harmonics)
        problem = replace(problem, sharpest=SHARP[-1])
        unknowns = unknowns_of(state)[:, : problem.samples]
        self.problem, self.omega = problem, state.omega
        count = problem.samples
        self.k = np.arange(-harmonics, harmonics + 1)
        phase = 2.0 * np.pi * np.arange(count) / count
        self.samples = np.exp(1j * np.outer(phase, self.k))
        self.coefficients = self.samples.conj().T / count
        mean = np.sinc(self.k / count)
        self.from_cells = self.coefficients / mean[:, None]
        moved, velocity = relative_motion(problem, unknowns, state.omega)
        friction = state.friction if rubs else np.zeros_like(moved)
        found = rules(problem, unknowns, friction, state.omega)
        self.by_x: list[Complex | None] = []
        self.by_v: list[Complex | None] = []
        lines, columns, corner = [], [], []
        for j, law in enumerate(problem.forces):
            direction = problem.structure.directions[j]
            slope_x, slope_v = law.slopes(moved[j], velocity[j])
            by_v = self._carried(slope_v)
            rule = found[j]
            if rule is not None:
                held = np.nonzero(state.held[j])[0]
                across = rule.neighbour[held]
                own_part = rule.own[held, None] * self.samples[held]
                mixed = own_part + rule.across[held, None] * self.samples[across]
                lines += [np.multiply.outer(direction, row) for row in mixed]
                columns += [np.outer(direction, self.from_cells[:, i]).ravel() for i in held]
                corner += [-value for value in rule.yields[held]]
                if law.stribeck:
                    falling = law.limit(velocity[j])[1] * np.sign(friction[j])
                    falling = np.where(state.held[j], 0.0, falling)
                    rubbed = self.from_cells @ (falling[:, None] * self.samples)
                    by_v = np.asarray(rubbed if by_v is None else by_v + rubbed)
            self.by_x.append(self._carried(slope_x))
            self.by_v.append(by_v)
        self.lines, self.columns, self.corner = np.array(lines), np.array(columns), corner

    def _carried(self, slope: Array) -> Complex | None:
        if not slope.any():
            return None
        return np.asarray(self.coefficients @ (slope[:, None] * self.samples))

    def sign(self, s: complex) -> complex:
        """Return the phase factor of det J(s) over that of the inertia, moved off the axis."""
        structure, count = self.problem.structure, self.k.size
        size = structure.size
        rates = s + 1j * self.omega * self.k
        matrix = np.zeros((size, count, size, count), dtype=np.complex128)
        for j, direction in enumerate(structure.directions):
            dyad = np.outer(direction, direction)
            for carried, factor in ((self.by_x[j], np.ones(count)), (self.by_v[j], rates)):
                if carried is not None:
                    own = carried * factor
                    matrix += dyad[:, None, :, None] * own[None, :, None, :]
        diagonal = np.arange(count)
        matrix[:, diagonal, :, diagonal] += dynamic_stiffness(self.problem, rates)
        total = matrix.reshape(size * count, size * count)
        extra = len(self.corner)
        if extra:
            wide = np.zeros((total.shape[0] + extra,) * 2, dtype=np.complex128)
            wide[:-extra, :-extra] = total
            wide[-extra:, :-extra] = (self.lines * rates).reshape(extra, -1)
            wide[:-extra, -extra:] = self.columns.T
            wide[-extra:, -extra:] = np.diag(self.corner)
            total = wide
        value = complex(np.linalg.slogdet(total)[0])
        # Inertia alone, its roots at -omega - i k omega: on the stable side, none on the contour.
        reference = (rates + self.omega) ** (2 * size)
        phase = np.exp(-1j * np.angle(reference).sum())
        return complex(value * phase)

"""A structure with fractional devices as ordinary state equations, over a band."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike

from models.checks import Array
from models.linear.dynamic import Complex, dynamic_stiffness, structure_terms
from models.linear.oustaloup import import_control, oustaloup
from models.structure import Structure


@dataclass(frozen=True)
class RationalStructure:
    """dy/dt = A y + B load, x = C y: displacement, velocity, then the filters' states."""

    a: Array
    """(N, N) 1/s."""
    b: Array
    """(N, 1)."""
    c: Array
    """(n, N) displacements of all degrees of freedom."""
    band: tuple[float, float]
    """rad/s, where `error` holds."""
    error: float
    """Largest norm of the deviation of the displacements over that of the displacements."""

    def response(self, omega: ArrayLike) -> Complex:
        """Return displacements per unit of load at `omega` (K,) rad/s, (K, n)."""
        w = np.atleast_1d(np.asarray(omega, dtype=np.float64))
        shifted = 1j * w[:, None, None] * np.eye(self.a.shape[0]) - self.a
        states = np.linalg.solve(shifted, np.broadcast_to(self.b, (w.size, *self.b.shape)))
        return np.asarray((self.c @ states)[..., 0])

    def to_control(self) -> Any:
        """Return a `control.StateSpace`; needs the extra ``control``."""
        control = import_control()
        return control.ss(self.a, self.b, self.c, np.zeros((self.c.shape[0], 1)))


def rational_structure(
    structure: Structure,
    band: tuple[float, float],
    *,
    acts: Literal["force", "base"] = "force",
    at: int = 0,
    pairs: int = 15,
    margin: float = 10.0,
    refined: bool = True,
) -> RationalStructure:
    """Return state equations in which filters by `oustaloup` stand for the fractional terms.

    Parameters
    ----------
    structure : Structure
        Devices of one band each.
    band : tuple of float
        rad/s, where the filters are to hold.
    acts, at
        The load, as in `transfer_function`.
    pairs, margin, refined
        As in `oustaloup`.

    Returns
    -------
    RationalStructure
        Matrices of the state equations, SI.

    Raises
    ------
    InputError
        As `oustaloup` and `transfer_function`.

    Examples
    --------
    >>> from models.constitutive import FittedTerm, ForceModel
    >>> from models.structure import oscillator
    >>> law = ForceModel((FittedTerm("fractional-derivative", 0.3, {"order": 1.5}),))
    >>> rational_structure(oscillator(1.0, 1.0, law), (0.1, 10.0)).error < 0.01
    True
    """
    size = structure.size
    mass, damping, stiffness = np.zeros((3, size, size))
    # (fed by velocity, direct, output matrix, poles, residues) of each fractional term
    filters = []
    for order, matrix in structure_terms(structure):
        if order in (0.0, 1.0, 2.0):
            (stiffness, damping, mass)[int(order)][...] += matrix
            continue
        power = oustaloup(order, band, pairs=pairs, margin=margin, refined=refined)
        (damping if power.whole else stiffness)[...] += power.gain * matrix
        filters.append((power.whole, matrix, power.poles, power.residues))
    total = 2 * size + sum(p.size * size for _, _, p, _ in filters)
    a, b = np.zeros((total, total)), np.zeros((total, 1))
    a[:size, size : 2 * size] = np.eye(size)
    a[size : 2 * size, :size] = -np.linalg.solve(mass, stiffness)
    a[size : 2 * size, size : 2 * size] = -np.linalg.solve(mass, damping)
    first = 2 * size
    for whole, matrix, poles, residues in filters:
        for pole, residue in zip(poles, residues, strict=True):
            block = slice(first, first + size)
            # Each state follows its pole times faster or slower: fed by pole, read by residue/pole.
            rate = pole if pole > 0.0 else 1.0
            a[block, block] = -pole * np.eye(size)
            a[block, whole * size : (whole + 1) * size] = rate * np.eye(size)
            a[size : 2 * size, block] = -np.linalg.solve(mass, residue / rate * matrix)
            first += size
    load = -structure.mass.sum(axis=1) if acts == "base" else np.eye(size)[at]
    b[size : 2 * size, 0] = np.linalg.solve(mass, load)
    c = np.eye(size, total)
    trial = RationalStructure(a, b, c, band, np.nan)
    grid = np.geomspace(*band, 64 * pairs + 257)
    loads = np.broadcast_to(load[:, None], (grid.size, size, 1))
    exact = np.linalg.solve(dynamic_stiffness(structure, 1j * grid), loads)[..., 0]
    gap = np.linalg.norm(trial.response(grid) - exact, axis=1) / np.linalg.norm(exact, axis=1)
    return RationalStructure(a, b, c, band, 1.01 * float(gap.max()))

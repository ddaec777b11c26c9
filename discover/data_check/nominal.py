"""The four structures as a plan of tests meets them before any fit: terms, and a nominal force."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from discover.library.dictionary import Dictionary
from discover.regression.support import ProfiledFit, Support
from discover.selection.structures import FRACTIONAL, POWER, TURBULENT_EXPONENT
from discover.triangle import Triangle
from models.checks import Array

TELLING = math.log(20.0)
"""Nats from which a structure can be ruled out at 5 %."""

_FRICTION = "coulomb-friction"
_NOMINAL_ORDER = 1.5

_SUPPORTS = {
    "FOIM": Support((), free=(FRACTIONAL,)),
    "IOIM-linear": Support(("inertia", "viscous-damping")),
    "IOIM-laminar": Support(("inertia", "viscous-damping", "quadratic-damping")),
    "IOIM-turbulent": Support(("inertia", "viscous-damping"), fixed=((POWER, TURBULENT_EXPONENT),)),
}


def supports_of(dictionary: Dictionary) -> dict[str, Support]:
    """Return each structure's terms by its name, with friction where the dictionary has it."""
    if not dictionary.has(_FRICTION):
        return dict(_SUPPORTS)
    return {n: replace(s, plain=(*s.plain, _FRICTION)) for n, s in _SUPPORTS.items()}


def contains(larger: Support, smaller: Support) -> bool:
    """Return whether every force of `smaller` is one of `larger` too."""
    return set(smaller.ids) <= set(larger.ids)


def nominal_shapes(support: Support) -> tuple[float, ...]:
    """Return the value that each free shape is given before it is fitted."""
    return tuple(_NOMINAL_ORDER for _ in support.free)


def nominal_force(support: Support, triangle: Triangle, dictionary: Dictionary) -> Array:
    """Return coefficients (K,) on the dictionary's columns that make a structure's nominal force.

    Each of its terms but friction has an equal part in it, and it is as large as the measured one.
    """
    weights = ProfiledFit(triangle, dictionary).at(support, nominal_shapes(support)).weights
    size = np.linalg.norm(triangle.columns @ weights, axis=0)
    kept = np.array([i != _FRICTION for i in support.ids]) & (size > 0.0)
    combined = np.sum(weights[:, kept] / size[kept], axis=1)
    total = float(np.linalg.norm(triangle.columns @ combined))
    scale = float(np.linalg.norm(triangle.target)) / total if total > 0.0 else 0.0
    return np.asarray(scale * combined)


def gap_to(force: Array, model: Support, triangle: Triangle, dictionary: Dictionary) -> float:
    """Return half the squared misfit of `model` to a whitened force (m,), nats."""
    matrix = np.column_stack([triangle.columns, force])
    fit = ProfiledFit(replace(triangle, matrix=matrix), dictionary).fit(model)
    return 0.5 * fit.chi2

"""What a plan of tests can't tell apart: the expected gap between structures, before any fit.

Each structure is given a nominal force, in which its terms contribute equally and which is as large
as the measured one. The other structure is then fitted to that force: half the squared misfit over
the noise is the log-likelihood that the records would speak with if the first structure were true.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from itertools import combinations

import numpy as np

from discover.data_check.result import Inseparable
from discover.library.dictionary import Dictionary
from discover.regression.support import ProfiledFit, Support
from discover.selection.structures import FRACTIONAL, POWER, TURBULENT_EXPONENT
from discover.triangle import Triangle, WindowRows, triangle_of
from models.checks import Array

TELLING = math.log(20.0)
"""Nats from which a structure can be ruled out at 5 %."""

_FRICTION = "coulomb-friction"
_NOMINAL_ORDER = 1.5
_SAME_FREQUENCY = 0.02

_SUPPORTS = {
    "FOIM": Support((), free=(FRACTIONAL,)),
    "IOIM-linear": Support(("inertia", "viscous-damping")),
    "IOIM-laminar": Support(("inertia", "viscous-damping", "quadratic-damping")),
    "IOIM-turbulent": Support(("inertia", "viscous-damping"), fixed=((POWER, TURBULENT_EXPONENT),)),
}


def inseparable_pairs(
    windows: Sequence[WindowRows], dictionary: Dictionary
) -> tuple[Inseparable, ...]:
    """Return the pairs of structures that these tests can't tell apart at their noise.

    Parameters
    ----------
    windows : sequence of WindowRows
        Of the records that may be fitted.
    dictionary : Dictionary
        Of their columns.
    """
    triangle = triangle_of(windows)
    supports = {name: _with_friction(s, dictionary) for name, s in _SUPPORTS.items()}
    nominal = {name: _nominal_force(s, triangle, dictionary) for name, s in supports.items()}
    found = []
    for first, second in combinations(supports, 2):
        # Of two nested structures only the larger one can be told, by what the smaller one lacks.
        gaps = [
            _gap(nominal[truth], supports[model], triangle, dictionary)
            for truth, model in ((first, second), (second, first))
            if not _contains(supports[model], supports[truth])
        ]
        gap = min(gaps)
        if gap < TELLING:
            found.append(Inseparable((first, second), gap, _why(first, second, gap, windows)))
    return tuple(found)


def expected_gap(
    truth: str, model: str, windows: Sequence[WindowRows], dictionary: Dictionary
) -> float:
    """Return the nats by which `model` would be rejected on these tests if `truth` were true.

    Parameters
    ----------
    truth, model : str
        Names of structures.
    windows : sequence of WindowRows
        Of the tests.
    dictionary : Dictionary
        Of their columns.
    """
    triangle = triangle_of(windows)
    force = _nominal_force(_with_friction(_SUPPORTS[truth], dictionary), triangle, dictionary)
    return _gap(force, _with_friction(_SUPPORTS[model], dictionary), triangle, dictionary)


def _with_friction(support: Support, dictionary: Dictionary) -> Support:
    if not dictionary.has(_FRICTION):
        return support
    return replace(support, plain=(*support.plain, _FRICTION))


def _contains(larger: Support, smaller: Support) -> bool:
    return set(smaller.ids) <= set(larger.ids)


def _nominal_force(support: Support, triangle: Triangle, dictionary: Dictionary) -> Array:
    """Return the whitened force (m,) in which each term but friction has an equal part."""
    shapes = tuple(_NOMINAL_ORDER for _ in support.free)
    weights = ProfiledFit(triangle, dictionary).at(support, shapes).weights
    columns = triangle.columns @ weights
    size = np.linalg.norm(columns, axis=0)
    kept = np.array([i != _FRICTION for i in support.ids]) & (size > 0.0)
    force = np.sum(columns[:, kept] / size[kept], axis=1)
    total = float(np.linalg.norm(force))
    scale = float(np.linalg.norm(triangle.target)) / total if total > 0.0 else 0.0
    return np.asarray(scale * force)


def _gap(force: Array, model: Support, triangle: Triangle, dictionary: Dictionary) -> float:
    """Return half the squared misfit of `model` to a whitened force, nats."""
    matrix = np.column_stack([triangle.columns, force])
    fit = ProfiledFit(replace(triangle, matrix=matrix), dictionary).fit(model)
    return 0.5 * fit.chi2


def _why(first: str, second: str, gap: float, windows: Sequence[WindowRows]) -> str:
    count = len({w.record for w in windows})
    records = "the one record that may be fitted" if count == 1 else f"these {count} records"
    frequencies = np.array([w.frequency for w in windows])
    if "FOIM" in (first, second) and np.ptp(frequencies) < _SAME_FREQUENCY * frequencies.max():
        return (
            f"at a single frequency ({frequencies.mean():.3g} Hz) a fractional derivative is"
            f" exactly a mixture of velocity and acceleration: {first} and {second} need tests at"
            " several frequencies"
        )
    return (
        f"at their noise {records} would speak with only {gap:.2g} nats for the right one of"
        f" {first} and {second}, and {TELLING:.1f} are needed to rule one out at 5 %"
    )

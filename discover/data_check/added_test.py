"""The one test more that would best tell apart what a plan leaves open.

Each admissible sine test is added to the plan in thought: the structures' nominal forces are held,
its noise is that of the plan's tests relative to the force, and the expected gaps are taken again.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from discover.data_check.nominal import gap_to, nominal_force, supports_of
from discover.data_check.result import AddedTest, Pair
from discover.library.dictionary import Dictionary
from discover.next_test import admissible_tests, relative_noise, sine_rows
from discover.records import RigLimits
from discover.triangle import Triangle, WindowRows, reduce_rows, triangle_of
from models.checks import Array

_GAIN = 1.1  # a test that adds less than a tenth to the gap is not worth running


def added_test(
    pairs: Sequence[Pair],
    windows: Sequence[WindowRows],
    dictionary: Dictionary,
    limits: RigLimits | None,
) -> AddedTest | None:
    """Return the test that raises the least gap among inseparable pairs most.

    Parameters
    ----------
    pairs : sequence of Pair
        From `expected_pairs`.
    windows : sequence of WindowRows
        Of the same records.
    dictionary : Dictionary
        Of their columns.
    limits : RigLimits or None
        The rig's; what is not stated is what the tests so far have reached.

    Returns
    -------
    AddedTest or None
        None where nothing is inseparable, or no admissible test helps.
    """
    unsettled = [p for p in pairs if not p.separable]
    if not unsettled:
        return None
    triangle = triangle_of(windows)
    supports = supports_of(dictionary)
    nominal = {name: nominal_force(s, triangle, dictionary) for name, s in supports.items()}
    noise = relative_noise(windows)
    most = limits.max_force if limits is not None else None
    best: AddedTest | None = None
    for frequency, amplitude in zip(*admissible_tests(windows, limits), strict=True):
        rows = sine_rows(float(frequency), float(amplitude), dictionary)
        forces = {name: float(np.linalg.norm(rows @ c)) for name, c in nominal.items()}
        if most is not None and np.sqrt(2.0) * max(forces.values()) > most:
            continue
        gaps: list[tuple[float, tuple[str, str]]] = []
        for pair in unsettled:
            for g in pair.gaps:
                if g.word == "nested":
                    continue
                level = max(noise * forces[g.truth], 1e-300)
                both = _with(triangle, rows / level)
                force = both.columns @ nominal[g.truth]
                gaps.append((gap_to(force, supports[g.model], both, dictionary), pair.structures))
        least, structures = min(gaps)
        if best is None or least > best.nats:
            best = AddedTest(float(frequency), float(amplitude), structures, least)
    now = min(p.nats for p in unsettled)
    return best if best is not None and best.nats > _GAIN * now else None


def _with(triangle: Triangle, rows: Array) -> Triangle:
    """Return the triangle with whitened rows of columns added; its force is not used."""
    padded = np.column_stack([rows, np.zeros(rows.shape[0])])
    matrix = reduce_rows(np.concatenate([triangle.matrix, padded]))
    return replace(triangle, matrix=matrix, rows=triangle.rows + rows.shape[0])

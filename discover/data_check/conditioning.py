"""How well a plan of tests determines the parameters of each structure."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from discover.data_check.nominal import TELLING, Structure, structures
from discover.data_check.plan import Plan
from discover.data_check.result import Conditioning
from models.checks import Array

_ROUND_OFF = 1e-9  # of the greatest singular value: below it a column is a mixture of the others


def conditioning(plan: Plan) -> tuple[Conditioning, ...]:
    """Return rank and condition number of each structure on these tests."""
    found = []
    for structure in structures():
        values, least = _singular_values((structure,), plan)
        singular = values[-1] <= _ROUND_OFF * values[0]
        found.append(
            Conditioning(
                structure.name,
                structure.ids,
                columns=values.size,
                rank=int(np.sum(values > least)),
                condition=None if singular else float(values[0] / values[-1]),
            )
        )
    return tuple(found)


def joint_rank(several: Sequence[Structure], plan: Plan) -> tuple[int, int]:
    """Return the rank and the number of the distinct columns of several structures together."""
    values, least = _singular_values(several, plan)
    return int(np.sum(values > least)), values.size


def _singular_values(several: Sequence[Structure], plan: Plan) -> tuple[Array, float]:
    """Return the singular values (p,), falling, and the least that the tests would notice."""
    slopes = np.column_stack([s.slopes(plan) for s in several])
    columns = np.unique(slopes, axis=1)  # a term that two structures share is one column
    norms = np.linalg.norm(columns, axis=0)
    found = np.linalg.svd(columns / np.where(norms > 0.0, norms, 1.0), compute_uv=False)
    values = np.zeros(columns.shape[1])  # fewer rows than columns leave directions unseen
    values[: found.size] = found
    noticed = np.sqrt(2.0 * TELLING) / max(plan.size, 1e-300)
    return values, max(float(noticed), _ROUND_OFF * float(values[0]))

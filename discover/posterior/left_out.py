"""How well each record is predicted by the others: linear in the model's numbers, no new fit."""

from __future__ import annotations

import numpy as np

from discover.posterior.assess import Assessed, Assessor
from models.checks import Array, Indices


def left_out_growth(assessor: Assessor, assessed: Assessed) -> Array:
    """Return by how much more a model leaves of each record where the others alone are fitted.

    Parameters
    ----------
    assessor : Assessor
        Of the records.
    assessed : Assessed
        The model.

    Returns
    -------
    ndarray, shape (records,)
        Mean square over that of the record's force, less the same where all are fitted; not below
        0. The remainder that records share is not used to predict.
    """
    space, local = assessor.space, assessed.local
    curve = assessor.curve_of(local.model)
    here = space.given(assessed.place.sizes(space.own_unit))
    departing = local.slopes[:, :0] if curve is None else space.columns[:, curve.columns]
    wide = np.zeros(0) if curve is None else assessed.judged.scale * curve.spread
    target = local.target(space.sheet.target)[:, None]
    columns = np.concatenate([local.slopes, departing, target], axis=1)
    gram = here.within(columns)
    prior = np.diag(np.concatenate([local.spread, wide]) ** -2.0)
    records = np.array([u.record for u in space.sheet.units])
    total = gram.sum(axis=0)
    found = np.zeros(len(space.sheet.rows))
    for record in range(found.size):
        inside = records == record
        own = total - gram[inside].sum(axis=0)
        squares = []
        for some in (total, own):
            values = np.linalg.solve(some[:-1, :-1] + prior, some[:-1, -1])
            left = columns[inside, -1] - np.einsum("p,upr->ur", values, columns[inside, :-1])
            squares.append(_relative(assessor, np.flatnonzero(inside), left))
        found[record] = max(squares[1] - squares[0], 0.0)
    return found


def _relative(assessor: Assessor, units: Indices, left: Array) -> float:
    """Return the mean square of what is left in units, over that of their force."""
    sheet = assessor.space.sheet
    total = 0.0
    for u, own in zip(units, left, strict=True):
        unit = sheet.units[int(u)]
        size = sheet.rows[unit.record].size[unit.part]
        if unit.basis is None:
            shown = np.zeros(own.size)
            shown[: size.size] = size**-2.0
        else:
            shown = np.full(own.size, float(np.mean(size**-2.0)))
        total += float(np.sum(shown * own**2))
    return total

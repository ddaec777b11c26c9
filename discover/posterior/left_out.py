"""How well each record is predicted by the others: linear in the model's numbers, no new fit."""

from __future__ import annotations

import numpy as np

from discover.posterior.assess import Assessed, Assessor
from models.checks import Array, Indices

_FEWEST = 2  # records, or parts of one, for one to be left out


def left_out(assessor: Assessor, assessed: Assessed) -> tuple[Array, Array]:
    """Return what a model leaves of each record: fitted to all, and to the others alone.

    Of one record alone, parts that move alike are left out in turn.

    Parameters
    ----------
    assessor : Assessor
        Of the records.
    assessed : Assessed
        The model, at the numbers that predict best.

    Returns
    -------
    fitted, predicted : ndarray, shape (records,), or (parts,) of one record
        Mean square of what is left over that of the record's force. The remainder that records
        share is not used to predict.
    """
    space, local = assessed.space, assessed.local
    curve = assessor.curve_of(local.model)
    here = space.given(assessed.place.sizes(space.own_unit))
    departing = local.slopes[:, :0] if curve is None else space.columns[:, curve.columns]
    wide = np.zeros(0) if curve is None else assessed.judged.scale * curve.spread
    target = local.target(space.sheet.target)[:, None]
    columns = np.concatenate([local.slopes, departing, target], axis=1)
    gram = here.within(columns)
    prior = np.diag(np.concatenate([local.spread, wide]) ** -2.0)
    records = np.array([u.record for u in space.sheet.units])
    parts = records if records.max() > 0 else np.arange(records.size)
    total = gram.sum(axis=0)
    found = np.zeros((2, parts.max() + 1))
    for part in range(parts.max() + 1):
        inside = parts == part
        own = total - gram[inside].sum(axis=0)
        for place, some in enumerate((total, own)):
            values = np.linalg.solve(some[:-1, :-1] + prior, some[:-1, -1])
            left = columns[inside, -1] - np.einsum("p,upr->ur", values, columns[inside, :-1])
            found[place, part] = _relative(assessor, np.flatnonzero(inside), left)
    return found[0], found[1]


def predicts_better(assessor: Assessor, was: Assessed, now: Assessed) -> bool:
    """Tell whether a model predicts records that are left out better than another one.

    By more than the standard error of the mean over records; a lone part can't tell.
    """
    if len(assessor.space.sheet.units) < _FEWEST:
        return True
    before, after = (left_out(assessor, assessor.predicting(a))[1] for a in (was, now))
    gained = before - after
    return bool(np.mean(gained) > np.std(gained, ddof=1) / np.sqrt(gained.size))


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

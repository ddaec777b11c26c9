"""How well coefficients are known: by the noise, and by what records that are left out change."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from discover.naming.fit import ModelFit, inverse
from discover.naming.rows import RecordRows
from models.checks import Array

_NOISE = 1.2  # of chi-square a row, up to which only noise is left
_FEWEST = 4  # records or windows, that can tell how much they differ
_ALONE = 0.97  # of what all tell about a parameter: where one tells that, no other judges it


def standard_errors(rows: Sequence[RecordRows], fit: ModelFit) -> dict[int, float]:
    """Return each fitted coefficient's standard error, by its term's index, in its unit.

    Where more than noise is left, a wrong shape shows alike in all lines of a record and not anew
    in each: the error is then the jackknife's over whole records, or of few records over their
    windows (Efron and Stein 1981; here along the fit's tangents), at least the noise's. From too
    few of either it is the noise's, raised by what is left; likewise of a parameter that one record
    alone tells, as the one in which a stop is met.

    Parameters
    ----------
    rows : sequence of RecordRows
        Records that were fitted.
    fit : ModelFit
        To them.
    """
    free = fit.residual.size - len(fit.parameters)
    raised = max(fit.chi2 / max(free, 1), 1.0)
    variance = np.diagonal(fit.covariance)
    sizes = _parts(rows)
    if raised <= _NOISE or len(sizes) < _FEWEST:
        variance = raised * variance
    else:
        variance = _jackknife(sizes, fit, variance, raised)
    return {
        p.term: float(np.sqrt(max(value, 0.0)))
        for p, value in zip(fit.parameters, variance, strict=True)
        if p.shape is None
    }


def _parts(rows: Sequence[RecordRows]) -> list[int]:
    """Return how many rows belong together: a record's, or of few records a window's."""
    sizes = [r.target.size for r in rows]
    if len(rows) < _FEWEST and all(r.cycle_rows is None for r in rows):
        sizes = [2 * w.omega.size for r in rows for w in r.observation.windows]
    return sizes


def _jackknife(sizes: Sequence[int], fit: ModelFit, noise: Array, raised: float) -> Array:
    """Return the variances (P,) that leaving out each part of the rows in turn tells.

    At least those of the noise (P,); these `raised` where one part tells all.
    """
    ends = np.cumsum(sizes)[:-1]
    tangents = np.split(fit.tangents, ends, axis=1)
    left = np.split(fit.residual, ends)
    whole = fit.tangents @ fit.tangents.T
    told = np.diagonal(whole)
    alone = np.stack([np.sum(t**2, axis=1) > _ALONE * told for t in tangents])
    moved = np.stack([  # what a part alone tells stays as it is without it
        inverse(whole - t @ t.T + np.diag(np.where(own, told, 0.0))) @ (t @ part)
        for t, part, own in zip(tangents, left, alone, strict=True)
    ])
    found = (len(sizes) - 1.0) * np.mean(moved**2, axis=0)
    return np.asarray(np.maximum(found, np.where(alone.any(axis=0), raised, 1.0) * noise))

"""How well coefficients are known: by the noise, and by what records that are left out change."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from discover.naming.fit import ModelFit, inverse
from discover.naming.rows import RecordRows
from models.checks import Array

_NOISE = 1.2  # of chi-square a row, up to which only noise is left
_FEWEST = 4  # records, that can tell how much they differ


def standard_errors(rows: Sequence[RecordRows], fit: ModelFit) -> dict[int, float]:
    """Return each fitted coefficient's standard error, by its term's index, in its unit.

    Where more than noise is left, a wrong shape shows alike in all lines of a record and not anew
    in each: the error is then the jackknife's over whole records (Efron and Stein 1981; here along
    the fit's tangents), at least the noise's. From too few records it is the noise's, raised by
    what is left.

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
    if raised <= _NOISE or len(rows) < _FEWEST:
        variance = raised * variance
    else:
        variance = np.maximum(variance, _jackknife(rows, fit))
    return {
        p.term: float(np.sqrt(max(value, 0.0)))
        for p, value in zip(fit.parameters, variance, strict=True)
        if p.shape is None
    }


def _jackknife(rows: Sequence[RecordRows], fit: ModelFit) -> Array:
    """Return the variances (P,) that leaving out each record in turn tells."""
    ends = np.cumsum([r.target.size for r in rows])[:-1]
    tangents = np.split(fit.tangents, ends, axis=1)
    left = np.split(fit.residual, ends)
    whole = fit.tangents @ fit.tangents.T
    moved = np.stack([
        inverse(whole - t @ t.T) @ (t @ part) for t, part in zip(tangents, left, strict=True)
    ])
    return np.asarray((len(rows) - 1.0) * np.mean(moved**2, axis=0))

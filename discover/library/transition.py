"""The speed over which friction reverses, fitted beside linear terms."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.optimize import minimize_scalar

from models.checks import Array, InputError

_RANGE = (1e-4, 0.3)  # of the greatest speed: as the term's own bounds
_TRIALS = 25  # over the range, which holds less than one least misfit between two of them


def fitted_transition(speeds: Sequence[Array], others: Sequence[Array], force: Array) -> float:
    """Return the transition speed v_t of f0 tanh(v/v_t) that leaves the least squared misfit.

    For every trial the coefficients of friction and of all other columns are least squares
    (variable projection), so that the search has one dimension.

    Parameters
    ----------
    speeds : sequence of ndarray, shape (N_r,)
        m/s, of each record.
    others : sequence of ndarray, shape (N_r, K)
        The other columns.
    force : ndarray, shape (sum of N_r,)
        N.

    Returns
    -------
    float
        m/s, within the range that is searched: 1e-4 to 0.3 of the greatest speed.

    Examples
    --------
    >>> v = 0.1 * np.cos(0.01 * np.arange(1000))
    >>> force = 2500.0 * v + 400.0 * np.tanh(v / 0.004)
    >>> round(fitted_transition([v], [v[:, None]], force), 6)
    0.004
    """
    speed, rest = np.concatenate(speeds), np.concatenate(others)
    largest = float(np.abs(speed).max())
    if largest == 0.0:
        raise InputError("velocity", expected="not zero throughout", found="zero")
    basis = np.linalg.qr(rest / np.maximum(np.linalg.norm(rest, axis=0), 1e-300))[0]
    left = force - basis @ (basis.T @ force)

    def misfit(logarithm: float) -> float:
        column = np.tanh(speed / np.exp(logarithm))
        column = column - basis @ (basis.T @ column)
        return -float((column @ left) ** 2 / max(column @ column, 1e-300))

    low, high = (float(np.log(largest * share)) for share in _RANGE)
    trials = np.linspace(low, high, _TRIALS)
    best = int(np.argmin([misfit(t) for t in trials]))
    low, high = trials[max(best - 1, 0)], trials[min(best + 1, _TRIALS - 1)]
    found = minimize_scalar(misfit, bounds=(low, high), method="bounded", options={"xatol": 1e-6})
    return float(np.exp(found.x))

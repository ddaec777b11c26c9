"""How many terms: by leaving out groups of rows (records), or by an information criterion.

Leaving a group out needs no refit. With H_gg = Q_g Q_g^T, the group's block of the hat matrix, the
error of the prediction of group g by the others is (I - H_gg)^-1 e_g, and the misfit of the fit
without it is ||e||^2 - e_g^T (I - H_gg)^-1 e_g. Both are exact, and by Woodbury's identity they
need only a k x k solve a group.

References: D. M. Allen, *Technometrics* 16 (1974) 125-127; T. Hastie, R. Tibshirani, J. Friedman,
*The Elements of Statistical Learning*, 2009, section 7.10 (selection inside every fold, and the
one-standard-error rule); J. Chen, Z. Chen, *Biometrika* 95 (2008) 759-771 (extended BIC).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.special import gammaln

from discover.regression.best_subset import Subset, SubsetPath
from models.checks import Array

CRITERIA = ("ebic", "bic")
"""Names of the information criteria."""
_ALONE = 1e-10  # share of a direction that other groups hold, below which they say nothing of it
_WINDOW = 5.0  # correlation times over which the correlation is summed
_ROUND_OFF = 1e-26  # of the energy: a misfit below it is zero


@dataclass(frozen=True)
class LeftOut:
    """One subset fitted without each group in turn."""

    training: Array
    """(G,) squared misfit on the other groups."""
    prediction: Array
    """(G,) squared error on the group itself; inf where the others don't determine the fit."""


@dataclass(frozen=True)
class TermCount:
    """The number of terms chosen, and why."""

    size: int
    """Number of terms."""
    scores: Array
    """By number of terms: squared prediction error, or the criterion; inf where no subset is."""
    rule: str
    """"leave-group-out", "bic" or "ebic"."""


def leave_group_out(blocks: Sequence[Array], subset: Subset) -> LeftOut:
    """Return what each group says of the fit to the others.

    Parameters
    ----------
    blocks : sequence of ndarray, shape (m_g, K + 1)
        Rows, or the triangle, of each group; the target is the last column.
    subset : Subset
        Fitted to all of them.

    Returns
    -------
    LeftOut

    Examples
    --------
    >>> blocks = [np.array([[1.0, 1.0]]), np.array([[1.0, 3.0]]), np.array([[1.0, 5.0]])]
    >>> left = leave_group_out(blocks, Subset((0,), np.array([3.0]), 8.0))
    >>> left.prediction.round(9).tolist(), left.training.round(9).tolist()
    ([9.0, 0.0, 9.0], [2.0, 8.0, 2.0])
    """
    chosen = list(subset.indices)
    starts = np.concatenate(([0], np.cumsum([b.shape[0] for b in blocks])[:-1]))
    stacked = np.concatenate([b[:, chosen] for b in blocks])
    error = np.concatenate([b[:, -1] for b in blocks]) - stacked @ subset.coefficients
    own = np.add.reduceat(error**2, starts)
    total = float(own.sum())
    if not chosen:
        return LeftOut(total - own, own)
    norms = np.linalg.norm(stacked, axis=0)
    basis = np.linalg.qr(stacked / np.where(norms > 0.0, norms, 1.0))[0]
    share = np.add.reduceat(basis * error[:, None], starts)
    held = np.add.reduceat(basis[:, :, None] * basis[:, None, :], starts)
    values, vectors = np.linalg.eigh(np.eye(len(chosen)) - held)
    alone = values[:, 0] < _ALONE
    along = np.einsum("gji,gj->gi", vectors, share)
    change = along / np.where(alone[:, None], 1.0, values)
    # In the eigenvectors' axes: e^T H e and |Q (I - Q^T Q)^-1 Q^T e|^2, sums of squares alone.
    rise = np.sum(along * change, axis=1)
    moved = np.sum((1.0 - values) * change**2, axis=1)
    training = np.maximum(total - own - np.where(alone, 0.0, rise), 0.0)
    return LeftOut(training, np.where(alone, np.inf, own + 2.0 * rise + moved))


def by_leaving_out(path: SubsetPath, blocks: Sequence[Array]) -> TermCount:
    """Return the number of terms whose subsets predict a group best from the others.

    In every fold the subset is chosen anew among those that the path holds of its size, by its
    misfit without the group, so that a size does not profit from having seen what it predicts.
    The smallest number within one standard error of the best is taken.

    Parameters
    ----------
    path : SubsetPath
        On all groups; the more subsets of each size it keeps, the more exact the inner choice.
    blocks : sequence of ndarray, shape (m_g, K + 1)
        Rows or triangle of each group.

    Returns
    -------
    TermCount
    """
    groups = np.arange(len(blocks))
    errors = np.full((len(path.sizes), len(blocks)), np.inf)
    for size, subsets in enumerate(path.sizes):
        if not subsets:
            continue
        left = [leave_group_out(blocks, s) for s in subsets]
        inner = np.argmin(np.array([f.training for f in left]), axis=0)
        errors[size] = np.array([f.prediction for f in left])[inner, groups]
    # A group on which every size fails says nothing of the number.
    useful = np.isfinite(errors).any(axis=0)
    scores = errors[:, useful].sum(axis=1)
    floored = np.maximum(scores, _ROUND_OFF * path.energy)
    best = int(np.argmin(floored))
    size = best
    for smaller in range(best):
        if np.isfinite(scores[smaller]):
            rise = errors[smaller, useful] - errors[best, useful]
            if rise.sum() <= np.std(rise, ddof=1) * np.sqrt(rise.size):
                size = smaller
                break
    return TermCount(size, scores, "leave-group-out")


def by_criterion(
    path: SubsetPath, candidates: int, *, samples: float, criterion: str = "ebic"
) -> TermCount:
    """Return the number of terms of least information criterion.

    Parameters
    ----------
    path : SubsetPath
        On all rows.
    candidates : int
        Number of columns searched.
    samples : float
        Effective number of samples: fewer than rows where residuals are correlated in time.
    criterion : str
        "ebic", which charges for the number of subsets of each size, or "bic", which does not.

    Returns
    -------
    TermCount
    """
    scores = np.full(len(path.sizes), np.inf)
    for size, subsets in enumerate(path.sizes):
        if subsets:
            misfit = max(subsets[0].misfit, _ROUND_OFF * path.energy, np.finfo(float).tiny)
            scores[size] = samples * np.log(misfit / samples) + size * np.log(samples)
            if criterion == "ebic":
                scores[size] += 2.0 * (
                    gammaln(candidates + 1) - gammaln(size + 1) - gammaln(candidates - size + 1)
                )
    return TermCount(int(np.argmin(scores)), scores, criterion)


def independent_samples(path: SubsetPath, columns: Array, target: Array) -> float:
    """Return how many samples count for a criterion: those of what the fullest subset leaves.

    Parameters
    ----------
    path : SubsetPath
        On all rows.
    columns : ndarray, shape (N, K)
        All candidates, rows in order of time.
    target : ndarray, shape (N,)
        What they explain.

    Returns
    -------
    float
        At least 2.
    """
    fullest = next(s[0] for s in reversed(path.sizes) if s)
    left = target - columns[:, list(fullest.indices)] @ fullest.coefficients
    return max(effective_samples(left), 2.0)


def effective_samples(residual: Array) -> float:
    """Return the number of independent samples that a correlated residual is worth.

    The number of samples over the integrated autocorrelation time, summed up to five times itself
    (A. D. Sokal, in *Functional Integration*, 1997, 131-192).

    Parameters
    ----------
    residual : ndarray, shape (N,)
        In order of time.

    Returns
    -------
    float
        From 1 to N.

    Examples
    --------
    >>> white = np.random.default_rng(0).normal(size=5000)
    >>> bool(4000 < effective_samples(white) <= 5000)
    True
    >>> bool(effective_samples(np.repeat(white, 10)) < 6000)
    True
    """
    size = residual.size
    centred = residual - residual.mean()
    energy = float(centred @ centred)
    if energy == 0.0:
        return float(size)
    spectrum = np.fft.rfft(centred, 2 * size)
    correlation = np.fft.irfft(np.abs(spectrum) ** 2)[:size] / energy
    times = 2.0 * np.cumsum(correlation) - 1.0
    within = np.arange(size) >= _WINDOW * times
    time = float(times[np.argmax(within)]) if within.any() else float(size)
    return float(size / min(max(time, 1.0), size))

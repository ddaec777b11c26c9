"""How well each support predicts a record that it was not fitted to.

Where models err by far more than the noise, none is true, and the question that remains is which
predicts new tests best. Leaving out each record in turn answers it without refitting: with the
shapes held, the left-out record's residual follows from the full fit's by a small linear solve.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.special import softmax

from discover.regression.support import SupportFit
from discover.selection.materiality import record_power
from discover.triangle import WindowRows
from models.checks import Array

_DRAWS = 400


@dataclass(frozen=True)
class Predictions:
    """Leave-one-record-out errors of several fits."""

    errors: Array
    """(S, R) squared relative error of each fit on each record, left out."""
    noise: Array
    """(R,) squared relative noise of each record, as far as it shows in the lines."""

    @property
    def mean(self) -> Array:
        """(S,) mean over records."""
        result: Array = self.errors.mean(axis=1)
        return result

    @property
    def noise_share(self) -> float:
        """Noise in the best fit's error: 1 where noise is the limit, near 0 where models are."""
        return float(min(self.noise.mean() / max(self.mean.min(), 1e-300), 1.0))

    def only(self, fits: Sequence[int] | Array) -> Predictions:
        """Return the predictions of some of the fits."""
        return Predictions(self.errors[np.asarray(fits, dtype=int)], self.noise)

    def parsimonious(self, parameters: Array) -> int:
        """Return the fit with the fewest parameters that is within one standard error of the best.

        Parameters
        ----------
        parameters : ndarray, shape (S,)
            Number of parameters of each fit.
        """
        best = int(self.mean.argmin())
        excess = self.errors - self.errors[best]
        spread = excess.std(axis=1, ddof=1) / np.sqrt(self.errors.shape[1])
        near = excess.mean(axis=1) <= spread
        rank = np.lexsort((self.mean, parameters))
        return int(next(i for i in rank if near[i]))

    def shares(
        self, groups: Sequence[str], rng: np.random.Generator, *, witnesses: float = 1.0
    ) -> dict[str, float]:
        """Return the probability that each group's fit is the one that predicts.

        Model errors are taken as normal, of unknown size, and two a record (size and phase) as
        independent where each record is a witness of its own: the likelihood of a fit falls with
        the power `records * witnesses` of its mean square error. It is averaged over redrawn
        records by the Bayesian bootstrap (records weighted by a Dirichlet draw, flat for
        independent witnesses; the fewer they are, the more the weights spread).
        """
        count = self.errors.shape[1]
        weights = rng.dirichlet(np.full(count, witnesses), size=_DRAWS)
        logs = -count * witnesses * np.log(np.maximum(weights @ self.errors.T, 1e-300))
        mean = softmax(logs, axis=1).mean(axis=0)
        names = np.array(groups)
        return {str(n): float(mean[names == n].sum()) for n in np.unique(names)}


def leave_out(windows: Sequence[WindowRows], fits: Sequence[SupportFit]) -> Predictions:
    """Return the leave-one-record-out errors of fits, each record counting alike.

    Parameters
    ----------
    windows : sequence of WindowRows
        Of at least two records.
    fits : sequence of SupportFit
        Their shapes are held.

    Returns
    -------
    Predictions
    """
    power = record_power(windows)
    records = sorted(power)
    rows = {
        r: np.concatenate(
            [w.matrix * np.sqrt(w.share / power[r]) for w in windows if w.record == r]
        )
        for r in records
    }
    noise = np.array(
        [
            sum(float(w.variance @ w.count) * w.share / power[r] for w in windows if w.record == r)
            for r in records
        ]
    )
    errors = np.empty((len(fits), len(records)))
    for index, fit in enumerate(fits):
        errors[index] = _left_out(list(rows.values()), fit.weights)
    return Predictions(errors, noise)


def _left_out(rows: list[Array], weights: Array) -> Array:
    columns = [r[:, :-1] @ weights for r in rows]
    norms = np.sqrt(sum(np.sum(c**2, axis=0) for c in columns))
    norms[norms == 0.0] = 1.0
    columns = [c / norms for c in columns]
    grams = np.array([c.T @ c for c in columns])
    sides = np.array([c.T @ r[:, -1] for c, r in zip(columns, rows, strict=True)])
    size = weights.shape[1]
    ridge = 1e-12 * np.eye(size)
    solutions = np.linalg.solve(
        grams.sum(axis=0) - grams + ridge, (sides.sum(axis=0) - sides)[..., None]
    )[..., 0]
    return np.array(
        [
            float(np.sum((r[:, -1] - c @ s) ** 2))
            for r, c, s in zip(rows, columns, solutions, strict=True)
        ]
    )

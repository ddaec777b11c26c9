"""Best subset as a regressor of scikit-learn."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike
from sklearn.base import BaseEstimator, RegressorMixin
from sklearn.utils.validation import check_is_fitted, validate_data

from discover.regression.best_subset import best_subsets
from discover.regression.term_count import CRITERIA, by_criterion, independent_samples
from models.checks import Array, number, one_of

_KEPT = 5  # subsets of each size


class InerterRegressor(RegressorMixin, BaseEstimator):  # type: ignore[misc]
    """Measured force as the best subset of columns of the motion, for scikit-learn.

    The force is F = sum_k theta_k phi_k with few terms: plain least squares on the subset that an
    exact search finds. A fluid inerter has no constant force: there is no intercept, a column of
    ones stands for one. Columns come from `InerterLibrary`; where its terms look only at the
    motion at the moment it may stand before this in a ``Pipeline``.

    Parameters
    ----------
    max_terms : int
        Greatest number of terms, forced ones included.
    forced : sequence of int
        Columns that are always in.
    nonnegative : sequence of int
        Columns whose coefficient can't be negative; `InerterLibrary.nonnegative` lists them.
    exclusive : sequence of sequence of int
        Groups of which at most one column is in; `InerterLibrary.exclusive` lists them.
    criterion : str
        "ebic", which charges for the number of subsets of each size, or "bic", which does not.

    Attributes
    ----------
    coef_ : ndarray, shape (n_features,)
        Coefficients, N over the columns' units, 0 where a column is not in.
    n_features_in_ : int
        Number of columns.
    support_ : ndarray of bool, shape (n_features,)
        Which columns are in.

    Examples
    --------
    >>> from sklearn.model_selection import GroupKFold, cross_validate
    >>> rng = np.random.default_rng(1)
    >>> columns = rng.normal(size=(400, 6))
    >>> force = 370.0 * columns[:, 1] + 40.0 * columns[:, 3] + rng.normal(size=400)
    >>> InerterRegressor().fit(columns, force).coef_.round(-1).tolist()
    [0.0, 370.0, 0.0, 40.0, 0.0, 0.0]
    >>> records = np.repeat(np.arange(4), 100)
    >>> found = cross_validate(
    ...     InerterRegressor(), columns, force, groups=records, cv=GroupKFold(4))
    >>> bool(found["test_score"].min() > 0.999)
    True
    """

    def __init__(
        self,
        max_terms: int = 4,
        *,
        forced: Sequence[int] = (),
        nonnegative: Sequence[int] = (),
        exclusive: Sequence[Sequence[int]] = (),
        criterion: str = "ebic",
    ) -> None:
        self.max_terms = max_terms
        self.forced = forced
        self.nonnegative = nonnegative
        self.exclusive = exclusive
        self.criterion = criterion

    def fit(self, X: ArrayLike, y: ArrayLike) -> Self:
        """Find the best subset.

        Parameters
        ----------
        X : array_like, shape (n_samples, n_features)
            Columns of the motion, in the order of time within each record.
        y : array_like, shape (n_samples,)
            Measured force, N.

        Returns
        -------
        InerterRegressor

        Raises
        ------
        InputError
            For parameters that don't fit the data, see `best_subsets`.
        """
        one_of("criterion", self.criterion, CRITERIA, where="InerterRegressor")
        columns, force = validate_data(
            self, X, y, dtype=np.float64, y_numeric=True, ensure_min_samples=2
        )
        count = columns.shape[1]
        most = min(self.max_terms, max(len(force) - 1, len(self.forced)))
        path = best_subsets(
            columns, force, max_terms=most, forced=self.forced, nonnegative=self.nonnegative,
            exclusive=self.exclusive, keep=_KEPT,
        )  # fmt: skip
        samples = number("effective samples", independent_samples(path, columns, force))
        size = by_criterion(path, count, samples=samples, criterion=self.criterion).size
        chosen = path.sizes[size][0]
        self.coef_: Array = np.zeros(count)
        self.coef_[list(chosen.indices)] = chosen.coefficients
        self.support_ = self.coef_ != 0.0
        return self

    def predict(self, X: ArrayLike) -> Array:
        """Return the force, (n_samples,) N, of columns (n_samples, n_features)."""
        check_is_fitted(self)
        columns: Any = validate_data(self, X, dtype=np.float64, reset=False)
        return np.asarray(columns @ self.coef_)

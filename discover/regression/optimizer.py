"""Best subset as a pysindy optimizer."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike
from pysindy.optimizers import BaseOptimizer

from discover.regression.best_subset import Subset, SubsetPath, best_subsets, compress
from discover.regression.term_count import (
    CRITERIA,
    TermCount,
    by_criterion,
    by_leaving_out,
    independent_samples,
)
from models.checks import Array, InputError, number, one_of

_KEPT = 32  # subsets of each size among which every fold chooses


class BestSubset(BaseOptimizer):  # type: ignore[misc]
    """Least squares on the best subset of columns, found by exact search.

    The number of terms is found by leaving out groups of rows (records) where `groups` are given,
    else by an information criterion. Coefficients are plain least squares on the subset.

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
    groups : array_like of int, shape (n_samples,), optional
        Record of each row. Rows that `EnsembleOptimizer` draws singly (bagging) belong to no
        record any more: leave `groups` out there.
    criterion : str
        "ebic", which charges for the number of subsets of each size, or "bic", which does not.
    effective_samples : float, optional
        Number of independent samples for the criterion. Where absent it is estimated from the
        residual's autocorrelation in time; with a triangle for rows it has to be given.

    Attributes
    ----------
    coef_ : ndarray, shape (n_targets, n_features)
        Coefficients, 0 where a column is not in.
    ind_ : ndarray of bool, shape (n_targets, n_features)
        Which columns are in.
    paths_ : tuple of SubsetPath
        For every target the best few subsets of every size.
    counts_ : tuple of TermCount
        For every target the number of terms and the scores of the others.
    history_ : list of ndarray, shape (n_targets, n_features)
        Coefficients with no term, one, two, ...

    Notes
    -----
    `forced`, `nonnegative` and `exclusive` are positions. ``EnsembleOptimizer`` with
    ``library_ensemble=True`` drops columns, which moves the others: leave them out there.

    Examples
    --------
    >>> rng = np.random.default_rng(1)
    >>> theta = rng.normal(size=(200, 12))
    >>> force = 3.0 * theta[:, 2] - 0.5 * theta[:, 7] + 0.1 * rng.normal(size=200)
    >>> found = BestSubset(max_terms=4).fit(theta, force)
    >>> np.flatnonzero(found.coef_[0]).tolist()
    [2, 7]
    """

    def __init__(
        self,
        max_terms: int = 4,
        *,
        forced: Sequence[int] = (),
        nonnegative: Sequence[int] = (),
        exclusive: Sequence[Sequence[int]] = (),
        groups: ArrayLike | None = None,
        criterion: str = "ebic",
        effective_samples: float | None = None,
    ) -> None:
        # The search scales columns itself and its coefficients need no second fit.
        super().__init__(max_iter=1, unbias=False)
        self.max_terms = max_terms
        self.forced = forced
        self.nonnegative = nonnegative
        self.exclusive = exclusive
        self.groups = groups
        self.criterion = criterion
        self.effective_samples = effective_samples

    def set_params(self, **params: Any) -> Self:
        """Set parameters and return self, as scikit-learn's searches rely on."""
        super().set_params(**params)
        return self

    def fit(
        self, x_: ArrayLike, y: ArrayLike, sample_weight: ArrayLike | None = None, **options: Any
    ) -> Self:
        """Find the best subset.

        Parameters
        ----------
        x_ : array_like, shape (n_samples, n_features)
            Columns, or those of a triangle.
        y : array_like, shape (n_samples,) or (n_samples, n_targets)
            Measured force.
        sample_weight : array_like, shape (n_samples,), optional
            Weights of the squared errors.
        **options
            None; pysindy's signature.

        Returns
        -------
        BestSubset

        Raises
        ------
        InputError
            For parameters that don't fit the data, see `best_subsets`.
        """
        force = np.asarray(y, dtype=np.float64)
        columns = np.asarray(x_, dtype=np.float64)
        # A guess spares the base class a singular value decomposition that nothing would use.
        targets = 1 if force.ndim == 1 else force.shape[1]
        self.initial_guess: Array | None = np.zeros((targets, columns.shape[-1]))
        try:
            super().fit(columns, force, sample_weight=sample_weight, **options)
        finally:
            self.initial_guess = None
        return self

    def _reduce(self, x: Array, y: Array) -> None:
        one_of("criterion", self.criterion, CRITERIA, where="BestSubset")
        if self.effective_samples is not None:
            number("effective_samples", self.effective_samples, above=1.0, where="BestSubset")
        elif self.groups is None and x.shape[0] <= x.shape[1] + 1:
            raise InputError(
                "effective_samples or groups",
                expected=f"given where rows are no more than a triangle of {x.shape[1]} columns",
                found="neither",
                where="BestSubset",
            )
        rows = [x] if self.groups is None else self._by_group(x)
        paths, counts, coefficients = [], [], []
        for target in np.asarray(y).T:
            sides = [target] if self.groups is None else self._by_group(target)
            blocks = [compress(np.column_stack(b)) for b in zip(rows, sides, strict=True)]
            stacked = np.concatenate(blocks)
            path = best_subsets(
                stacked[:, :-1],
                stacked[:, -1],
                max_terms=self.max_terms,
                forced=self.forced,
                nonnegative=self.nonnegative,
                exclusive=self.exclusive,
                keep=_KEPT,
            )
            count = self._count(path, blocks, x, target)
            paths.append(path)
            counts.append(count)
            coefficients.append([_spread(s[0] if s else None, x.shape[1]) for s in path.sizes])
        self.paths_: tuple[SubsetPath, ...] = tuple(paths)
        self.counts_: tuple[TermCount, ...] = tuple(counts)
        self.history_ = [np.array(step) for step in zip(*coefficients, strict=True)]
        chosen = [c[n.size] for c, n in zip(coefficients, counts, strict=True)]
        self.coef_ = np.array(chosen)
        self.iters = sum(len(s) for p in paths for s in p.sizes)

    def _by_group(self, rows: Array) -> list[Array]:
        labels = np.asarray(self.groups)
        if labels.shape != (rows.shape[0],):
            raise InputError(
                "groups",
                expected=f"one label for each of {rows.shape[0]} rows",
                found=f"shape {labels.shape}",
                where="BestSubset",
            )
        names = np.unique(labels)
        if names.size < 2:
            raise InputError(
                "groups", expected="at least two records", found="one", where="BestSubset"
            )
        return [rows[labels == name] for name in names]

    def _count(
        self, path: SubsetPath, blocks: Sequence[Array], x: Array, target: Array
    ) -> TermCount:
        if self.groups is not None:
            return by_leaving_out(path, blocks)
        samples = self.effective_samples
        if samples is None:
            samples = independent_samples(path, x, target)
        return by_criterion(path, x.shape[1], samples=float(samples), criterion=self.criterion)


def _spread(subset: Subset | None, count: int) -> Array:
    coefficients = np.zeros(count)
    if subset is not None:
        coefficients[list(subset.indices)] = subset.coefficients
    return coefficients

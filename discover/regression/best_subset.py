"""Best subsets of columns by exact search: for every number of terms the few that fit best.

The rows are first reduced to a triangle by QR. The search then goes depth first over subsets and
keeps, at every depth, the columns that may still join orthogonal to those that are in. No Gram
matrix is formed, so nearly collinear columns (neighbouring fractional orders) keep their accuracy;
a step costs one pass over short columns, whatever the number of samples.

References: G. M. Furnival, R. W. Wilson, *Technometrics* 16 (1974) 499-511 (the search);
A. Bjorck, *BIT* 7 (1967) 1-21 (least squares by modified Gram-Schmidt).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import comb

import numpy as np
from numpy.typing import ArrayLike, NDArray

from discover.regression.least_squares import reduce_rows, solve
from models.checks import Array, InputError, finite_array
from models.compiled import compiled

_ROWS_AT_ONCE = 4096  # that are reduced to a triangle together
_DEPENDENT = 1e-24  # squared length left of a unit column that the others make up
_CANCELS = 1e-6  # part of the misfit below which it is formed from the residual itself
_MOST_SUBSETS = 200_000_000  # that one search compares: some minutes
_MOST_GROUPS = 62  # bits of a whole number, one each
_SUMS_IN_ANY_ORDER = {"reassoc", "contract"}  # so that the processor sums several at a time


@dataclass(frozen=True)
class Subset:
    """Least squares on some of the columns."""

    indices: tuple[int, ...]
    """Columns that are in, rising."""
    coefficients: Array
    """(k,) theirs, in the columns' own units."""
    misfit: float
    """||A c - y||^2."""


@dataclass(frozen=True)
class SubsetPath:
    """The best subsets of every size."""

    sizes: tuple[tuple[Subset, ...], ...]
    """By number of terms, from none on; each best first. Empty where no subset of that size
    holds the forced columns, meets the signs and is independent."""
    energy: float
    """||y||^2."""

    def best(self, size: int) -> Subset | None:
        """Return the best subset of a size, or None where there is none."""
        return self.sizes[size][0] if self.sizes[size] else None


@compiled(cache=True, nogil=True, fastmath=_SUMS_IN_ANY_ORDER)
def _signs_hold(  # pragma: no cover - compiled
    members: NDArray[np.int64],
    along: Array,
    upper: Array,
    diagonal: Array,
    positive: NDArray[np.bool_],
    coefficient: Array,
) -> bool:
    """Solve for the members' coefficients, last one first; return whether they meet the signs."""
    for a in range(members.size - 1, -1, -1):
        total = along[a]
        for b in range(a + 1, members.size):
            total -= upper[a, members[b]] * coefficient[b]
        coefficient[a] = total / diagonal[a]
        if positive[members[a]] and coefficient[a] < 0.0:
            return False
    return True


@compiled(cache=True, nogil=True, fastmath=_SUMS_IN_ANY_ORDER)
def _insert(  # pragma: no cover - compiled
    best: Array, subsets: NDArray[np.int64], value: float, members: NDArray[np.int64]
) -> None:
    """Put a subset into the kept ones of its size, best first; the last of them goes."""
    # Number by number: what numba makes of rows takes ten times as long to compile.
    place = best.size - 1
    while place > 0 and best[place - 1] > value:
        best[place] = best[place - 1]
        for n in range(members.size):
            subsets[place, n] = subsets[place - 1, n]
        place -= 1
    best[place] = value
    for n in range(members.size):
        subsets[place, n] = members[n]


@compiled(cache=True, nogil=True, fastmath=_SUMS_IN_ANY_ORDER)
def _search(  # pragma: no cover - compiled
    columns: Array,
    target: Array,
    forced: int,
    positive: NDArray[np.bool_],
    groups: NDArray[np.int64],
    most: int,
    keep: int,
) -> tuple[Array, NDArray[np.int64]]:
    """Return misfits (most + 1, keep), inf where empty, and subsets (most + 1, keep, most).

    Parameters: unit columns (K, m), the `forced` ones first; target (m,); sign constraints (K,);
    bits (K,) of the exclusive groups that each column is in; greatest size; how many to keep.
    """
    # The loop over columns stands here whole: views of them passed on cost half its time again.
    count, length = columns.shape
    left = np.empty((most, count, length))  # columns orthogonal to those chosen, by depth
    power = np.empty((most, count))  # their squared lengths
    slope = np.empty((most, count))  # and their products with the residual
    upper = np.empty((most, count))  # the chosen column's share in the later ones
    residual = np.empty((most + 1, length))
    misfit = np.empty(most + 1)
    along = np.empty(most)
    diagonal = np.empty(most)
    used = np.zeros(most + 1, np.int64)
    chosen = np.full(most + 1, -1, np.int64)
    coefficient = np.empty(most)
    unit = np.empty(length)
    best = np.full((most + 1, keep), np.inf)
    subsets = np.zeros((most + 1, keep, most), np.int64)

    squares = 0.0
    for n in range(length):
        residual[0, n] = target[n]
        squares += target[n] * target[n]
    misfit[0] = squares
    for i in range(count):
        squares, product = 0.0, 0.0
        for n in range(length):
            value = columns[i, n]
            left[0, i, n] = value
            squares += value * value
            product += value * target[n]
        power[0, i] = squares
        slope[0, i] = product

    depth = 0
    while depth >= 0:
        chosen[depth] += 1
        j = chosen[depth]
        if j >= (depth + 1 if depth < forced else count):
            depth -= 1
            continue
        if used[depth] & groups[j] or power[depth, j] <= _DEPENDENT:
            continue
        size = depth + 1
        diagonal[depth] = np.sqrt(power[depth, j])
        along[depth] = slope[depth, j] / diagonal[depth]
        value = misfit[depth] - along[depth] * along[depth]
        if value < _CANCELS * misfit[depth]:
            share = slope[depth, j] / power[depth, j]
            value = 0.0
            for n in range(length):
                rest = residual[depth, n] - share * left[depth, j, n]
                value += rest * rest
        if size >= forced and value < best[size, keep - 1]:
            members = chosen[:size]
            if _signs_hold(members, along, upper, diagonal, positive, coefficient):
                _insert(best[size], subsets[size], value, members)
        if size == most:
            continue

        total = 0.0
        for n in range(length):
            unit[n] = left[depth, j, n] / diagonal[depth]
            rest = residual[depth, n] - along[depth] * unit[n]
            residual[size, n] = rest
            total += rest * rest
        misfit[size] = total
        used[size] = used[depth] | groups[j]
        for i in range(j + 1, count):
            if used[size] & groups[i]:
                continue
            share = 0.0
            for n in range(length):
                share += unit[n] * left[depth, i, n]
            upper[depth, i] = share
            squares, product = 0.0, 0.0
            for n in range(length):
                rest = left[depth, i, n] - share * unit[n]
                left[size, i, n] = rest
                squares += rest * rest
                product += rest * residual[size, n]
            power[size, i] = squares
            slope[size, i] = product
        chosen[size] = j
        depth = size
    return best, subsets


def compress(matrix: Array) -> Array:
    """Return a triangle with the same least-squares problems as rows (N, K + 1), block by block.

    Examples
    --------
    >>> rows = np.random.default_rng(0).normal(size=(10_000, 3))
    >>> small = compress(rows)
    >>> small.shape, bool(np.allclose(small.T @ small, rows.T @ rows))
    ((3, 3), True)
    """
    size = max(_ROWS_AT_ONCE, 4 * matrix.shape[1])
    if matrix.shape[0] <= size:
        return reduce_rows(matrix)
    parts = [
        np.linalg.qr(matrix[start : start + size], mode="r")
        for start in range(0, matrix.shape[0], size)
    ]
    return reduce_rows(np.concatenate(parts))


def _indices(name: str, values: Sequence[int], count: int) -> NDArray[np.int64]:
    indices = np.atleast_1d(np.asarray(values))
    if indices.size == 0:
        return np.empty(0, np.int64)
    if indices.ndim != 1 or not np.issubdtype(indices.dtype, np.integer):
        raise InputError(name, expected="column indices", found=repr(values))
    outside = (indices < 0) | (indices >= count)
    if outside.any():
        raise InputError(
            name, expected=f"column indices from 0 to {count - 1}", found=f"{indices[outside][0]}"
        )
    return np.unique(indices).astype(np.int64)


def _checked(
    columns: ArrayLike, target: ArrayLike, max_terms: int, keep: int
) -> tuple[Array, Array]:
    matrix = finite_array("columns", columns, ndim=2)
    force = finite_array("target", target, ndim=1)
    if force.size != matrix.shape[0]:
        raise InputError("target", expected=f"of length {matrix.shape[0]}", found=f"{force.size}")
    for name, value in (("max_terms", max_terms), ("keep", keep)):
        if isinstance(value, bool) or not isinstance(value, int | np.integer) or value < 1:
            raise InputError(name, expected="a whole number >= 1", found=repr(value))
    return matrix, force


def _group_bits(
    exclusive: Sequence[Sequence[int]], count: int, forced: NDArray[np.int64]
) -> NDArray[np.int64]:
    if len(exclusive) > _MOST_GROUPS:
        raise InputError(
            "exclusive", expected=f"at most {_MOST_GROUPS} groups", found=f"{len(exclusive)}"
        )
    bits = np.zeros(count, np.int64)
    for position, group in enumerate(exclusive):
        members = _indices("exclusive", group, count)
        clash = np.intersect1d(members, forced)
        if clash.size > 1:
            raise InputError(
                "forced", expected="at most one column of an exclusive group", found=f"{clash}"
            )
        bits[members] |= np.int64(1) << position
    return bits


def best_subsets(
    columns: ArrayLike,
    target: ArrayLike,
    *,
    max_terms: int = 4,
    forced: Sequence[int] = (),
    nonnegative: Sequence[int] = (),
    exclusive: Sequence[Sequence[int]] = (),
    keep: int = 5,
) -> SubsetPath:
    """Return, for every number of terms, the subsets of columns with the least squared misfit.

    Parameters
    ----------
    columns : array_like, shape (N, K)
        Candidate columns, or the first K columns of a triangle that stands for them.
    target : array_like, shape (N,)
        What they explain.
    max_terms : int
        Greatest number of terms, forced ones included.
    forced : sequence of int
        Columns that stand in every subset.
    nonnegative : sequence of int
        Columns whose coefficient can't be negative. A subset whose least squares breaks that is
        no candidate: its best admissible point lies on a smaller subset, which is one.
    exclusive : sequence of sequence of int
        Groups of which at most one column may stand in a subset.
    keep : int
        How many subsets of each size are returned.

    Returns
    -------
    SubsetPath
        Exact: every admissible subset was compared. Subsets whose columns depend on each other
        to round-off are left out.

    Raises
    ------
    InputError
        For shapes, indices or options that make no sense, more than 2e8 subsets, or forced
        columns that depend on each other or break their signs in every subset.

    Examples
    --------
    >>> rng = np.random.default_rng(0)
    >>> columns = rng.normal(size=(50, 6))
    >>> path = best_subsets(columns, 2.0 * columns[:, 1] - columns[:, 4], max_terms=3)
    >>> path.best(2).indices, path.best(2).coefficients.round(9).tolist()
    ((1, 4), [2.0, -1.0])
    """
    matrix, force = _checked(columns, target, max_terms, keep)
    count = matrix.shape[1]
    held = _indices("forced", forced, count)
    signs = np.zeros(count, np.bool_)
    signs[_indices("nonnegative", nonnegative, count)] = True
    bits = _group_bits(exclusive, count, held)
    most = min(max_terms, count)
    if held.size > most:
        raise InputError("max_terms", expected=f"at least {held.size} (forced)", found=f"{most}")
    free = count - held.size
    subsets = sum(comb(free, k) for k in range(most - held.size + 1))
    if not exclusive and subsets > _MOST_SUBSETS:
        raise InputError(
            "max_terms", expected=f"small enough for {free} columns", found=f"{subsets:.1e} subsets"
        )

    triangle = compress(np.column_stack([matrix, force]))
    small, right = triangle[:, :-1], triangle[:, -1]
    norms = np.linalg.norm(small, axis=0)
    scale = float(np.linalg.norm(right))
    order = np.concatenate([held, np.setdiff1d(np.arange(count), held)])
    # A zero column stays zero, and the search passes it over as a dependent one.
    units = np.ascontiguousarray((small / np.where(norms > 0.0, norms, 1.0)).T[order])
    found, members = _search(
        units, right / (scale or 1.0), held.size, signs[order], bits[order], most, keep
    )
    sizes: list[tuple[Subset, ...]] = [_empty(scale**2) if held.size == 0 else ()]
    for size in range(1, most + 1):
        kept = [order[members[size, k, :size]] for k in np.flatnonzero(np.isfinite(found[size]))]
        fits = [_fit(small, right, np.sort(indices)) for indices in kept]
        sizes.append(tuple(sorted(fits, key=lambda s: s.misfit)))
    if not any(sizes):
        raise InputError(
            "forced", expected="independent columns whose signs can be met", found=f"{held}"
        )
    return SubsetPath(tuple(sizes), scale**2)


def _empty(energy: float) -> tuple[Subset, ...]:
    return (Subset((), np.empty(0), energy),)


def _fit(small: Array, right: Array, indices: NDArray[np.int64]) -> Subset:
    coefficients, misfit = solve(small[:, indices], right)
    return Subset(tuple(int(i) for i in indices), coefficients, misfit)

"""How far the best structure stays from the data: the error that none of them explains.

On a measured device every structure is wrong by a little, and noise alone would then reject them
all and choose the most complex. What the best one leaves, above the noise, is added to the noise:
by harmonic in sine tests, by part of the band in others, in proportion to each record's force.
It is found in overlapping groups of neighbouring records and taken low among them, so that the
groups that straddle a boundary between bands do not count.
A model's error changes slowly from test to test: neighbours that err alike are not independent
witnesses, so the error's variance is raised by what their correlation takes from the count.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from discover.library.dictionary import Dictionary
from discover.regression.support import ProfiledFit, Support, SupportFit
from discover.selection.drift import with_zero_drift
from discover.selection.materiality import relative_triangle
from discover.triangle import WindowRows
from models.checks import Array, Indices

_FEWEST, _MOST = 4, 9  # tests in a group of neighbours
_QUANTILE = 0.35  # over groups: those that straddle a boundary err by more than the others
_MOST_CORRELATED = 0.8
_INFORMATIVE = 4  # blocks of a window that carry a model's error: the lowest harmonics


def _residual(
    windows: Sequence[WindowRows], dictionary: Dictionary, supports: Sequence[Support]
) -> tuple[list[Array], float]:
    """Return the best support's residual rows by window, and the share of freedom left."""
    engine = ProfiledFit(relative_triangle(windows), dictionary)
    fits = [engine.fit(s) for s in supports]
    informative = 2.0 * sum(min(w.count.size, _INFORMATIVE) for w in windows)

    def cost(fit: SupportFit) -> float:
        spent = fit.support.parameters * np.log(informative) / informative
        return float(np.log(max(fit.chi2, 1e-300)) + spent)

    best = min([f for f in fits if f.valid] or fits, key=cost)
    combined = best.combined
    residual = [w.matrix[:, -1] - w.matrix[:, :-1] @ combined for w in windows]
    return residual, max(1.0 - best.support.parameters / informative, 0.25)


@dataclass(frozen=True)
class _Share:
    """A group's misfit above the noise."""

    excess: Array
    """(B,) by block, relative to the force's power."""
    error: Array
    """(B,) its standard error."""
    product: float
    """Sum over neighbours of the product of their relative errors at the fundamental."""
    square: float
    """Sum over the same windows of the squares."""


def _share(
    windows: Sequence[WindowRows], dictionary: Dictionary, supports: Sequence[Support]
) -> _Share:
    residual, freedom = _residual(windows, dictionary, supports)
    size = max(w.count.size for w in windows)
    excess, error, power = np.zeros(size), np.zeros(size), np.zeros(size)
    relative = []
    for window, rows in zip(windows, residual, strict=True):
        blocks = window.count.size
        found = np.bincount(window.block, weights=rows**2, minlength=blocks) / freedom
        expected = window.variance * window.count
        excess[:blocks] += found - expected
        error[:blocks] += 2.0 * window.count * window.variance**2
        power[:blocks] += window.power * window.count
        relative.append(rows[window.block == 1][:2] / np.sqrt(window.power))
    safe = np.maximum(power, 1e-300)
    product, square = _alike(relative)
    return _Share(excess / safe, np.sqrt(error) / safe, product, square)


def _alike(relative: Sequence[Array]) -> tuple[float, float]:
    """Return the sums over neighbours of their errors' products and mean squares."""
    product, square = 0.0, 0.0
    for one, two in pairwise(relative):
        if one.size == two.size:
            product += float(one @ two)
            square += 0.5 * float(one @ one + two @ two)
    return product, square


def witnesses(product: float, square: float) -> float:
    """Return how many independent witnesses a test is, from sums over neighbours' errors.

    Of errors whose neighbours correlate by r, n count as n (1 - r) / (1 + r).
    """
    correlation = float(np.clip(product / square if square else 0.0, 0.0, _MOST_CORRELATED))
    return (1.0 - correlation) / (1.0 + correlation)


def witnesses_of(windows: Sequence[WindowRows], fit: SupportFit, coordinate: Array) -> float:
    """Return how many independent witnesses of a fit's error a test is, between 1/9 and 1."""
    relative = []
    for index in np.argsort(coordinate, kind="stable"):
        w = windows[int(index)]
        rows = w.matrix[w.block == min(1, int(w.block.max()))]
        error = rows[:, -1] - rows[:, :-1] @ fit.combined
        relative.append(error[:2] / np.sqrt(max(w.power, 1e-300)))
    return witnesses(*_alike(relative))


def neighbours(coordinate: Array) -> list[Indices]:
    """Return overlapping groups of tests that follow one another along the coordinate."""
    order = np.argsort(coordinate, kind="stable")
    length = int(np.clip(order.size // 3, min(_FEWEST, order.size), _MOST))
    starts = range(0, max(order.size - length, 0) + 1, max(length // 3, 1))
    return [order[start : start + length] for start in starts]


def with_discrepancy(
    windows: Sequence[WindowRows],
    dictionary: Dictionary,
    coordinate: Array,
    supports: Sequence[Support],
) -> list[WindowRows]:
    """Return the windows with the model error that the best support leaves among neighbours.

    Parameters
    ----------
    windows : sequence of WindowRows
        Fitted windows.
    dictionary : Dictionary
        Of their columns, with one friction column.
    coordinate : ndarray, shape (W,)
        By which neighbours are found.
    supports : sequence of Support
        The models that compete; each group of neighbours takes the best.

    Returns
    -------
    list of WindowRows
        With `discrepancy` in N^2 such that a relative error of one is the found one.
    """
    windows = with_zero_drift(windows, dictionary)
    groups = neighbours(coordinate)
    shares = [_share([windows[i] for i in group], dictionary, supports) for group in groups]
    size = max(s.excess.size for s in shares)
    padded = np.array([np.pad(s.excess, (0, size - s.excess.size)) for s in shares])
    spread = np.array([np.pad(s.error, (0, size - s.error.size)) for s in shares])
    typical = np.quantile(padded, _QUANTILE, axis=0)
    certain = typical > 2.0 * np.median(spread, axis=0) / np.sqrt(max(len(groups) / 3.0, 1.0))
    level = np.where(certain, typical, 0.0)
    level /= witnesses(sum(s.product for s in shares), sum(s.square for s in shares))
    return [replace(w, discrepancy=level[: w.count.size] * w.power) for w in windows]

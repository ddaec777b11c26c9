"""How far the best structure stays from the data: the error that none of them explains.

On a measured device every structure is wrong by a little, and noise alone would then reject them
all and choose the most complex. What the best one leaves, above the noise, is added to the noise:
by harmonic in sine tests, by part of the band in others, in proportion to each record's force.
It is found in groups of neighbouring records, so that a boundary between bands does not count.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from discover.library.dictionary import Dictionary
from discover.regression.support import ProfiledFit, Support, SupportFit
from discover.selection.materiality import relative_triangle
from discover.triangle import WindowRows
from models.checks import Array

_GROUP = 9
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


def _share(
    windows: Sequence[WindowRows], dictionary: Dictionary, supports: Sequence[Support]
) -> tuple[Array, Array]:
    """Return by block the excess of the misfit over the noise, relative to power, and its error."""
    residual, freedom = _residual(windows, dictionary, supports)
    size = max(w.count.size for w in windows)
    excess, error, power = np.zeros(size), np.zeros(size), np.zeros(size)
    for window, rows in zip(windows, residual, strict=True):
        blocks = window.count.size
        found = np.bincount(window.block, weights=rows**2, minlength=blocks) / freedom
        expected = window.variance * window.count
        excess[:blocks] += found - expected
        error[:blocks] += 2.0 * window.count * window.variance**2
        power[:blocks] += window.power * window.count
    safe = np.maximum(power, 1e-300)
    return excess / safe, np.sqrt(error) / safe


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
    order = np.argsort(coordinate, kind="stable")
    groups = np.array_split(order, max(1, order.size // _GROUP))
    shares, errors = [], []
    for group in groups:
        share, error = _share([windows[i] for i in group], dictionary, supports)
        shares.append(share)
        errors.append(error)
    size = max(s.size for s in shares)
    padded = np.array([np.pad(s, (0, size - s.size)) for s in shares])
    spread = np.array([np.pad(e, (0, size - e.size)) for e in errors])
    median = np.median(padded, axis=0)
    certain = median > 2.0 * np.median(spread, axis=0) / np.sqrt(len(groups))
    level = np.where(certain, median, 0.0)
    return [replace(w, discrepancy=level[: w.count.size] * w.power) for w in windows]

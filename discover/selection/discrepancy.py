"""How far the richest model stays from the data: the error that no structure here explains.

On a measured device every structure is wrong by a little, and noise alone would then reject them
all and choose the most complex. What a rich model leaves, above the noise, is added to the noise:
by harmonic in sine tests, by part of the band in others, in proportion to each record's force.
It is found in groups of neighbouring records, so that a boundary between bands does not count.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from discover.library.dictionary import Dictionary
from discover.triangle import WindowRows
from models.checks import Array

_GROUP = 9
_ORDER_NODES = 5
_EXPONENT_NODES = 3


def rich_weights(dictionary: Dictionary) -> Array:
    """Return (K, k) of the rich model: every fixed term, some orders and exponents."""
    seen: set[str] = set()
    vectors = []
    for index, column in enumerate(dictionary.columns):
        if column.id not in seen:
            seen.add(column.id)
            vectors.append(np.eye(dictionary.size)[index])
    for family, nodes in (
        ("fractional-derivative", _ORDER_NODES),
        ("power-law-damping", _EXPONENT_NODES),
    ):
        found = dictionary.family(family)
        if found is None:
            continue
        values = np.linspace(found[0].lower, found[0].upper, nodes + 2)[1:-1]
        weights = np.zeros((dictionary.size, nodes))
        weights[found[1]] = found[0].weights(values)
        vectors.extend(weights.T)
    if dictionary.delay:
        vectors.append(np.eye(dictionary.size)[-1])
    return np.array(vectors).T


def _residual(windows: Sequence[WindowRows], weights: Array) -> tuple[list[Array], float]:
    """Return unwhitened residual rows by window, and the share of freedom that is left."""
    white = np.concatenate([w.whitened(0.0) for w in windows])
    columns, target = white[:, :-1] @ weights, white[:, -1]
    norms = np.linalg.norm(columns, axis=0)
    norms[norms == 0.0] = 1.0
    solution, _, rank, _ = np.linalg.lstsq(columns / norms, target, rcond=1e-8)
    solution /= norms
    residual = [w.matrix[:, -1] - w.matrix[:, :-1] @ (weights @ solution) for w in windows]
    informative = 2.0 * sum(min(w.count.size, 4) for w in windows)
    return residual, max(1.0 - float(rank) / informative, 0.25)


def _share(windows: Sequence[WindowRows], weights: Array) -> tuple[Array, Array]:
    """Return by block the excess of the misfit over the noise, relative to power, and its error."""
    residual, freedom = _residual(windows, weights)
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
    windows: Sequence[WindowRows], dictionary: Dictionary, coordinate: Array
) -> list[WindowRows]:
    """Return the windows with the model error that a rich model leaves in groups of neighbours.

    Parameters
    ----------
    windows : sequence of WindowRows
        Fitted windows.
    dictionary : Dictionary
        Of their columns, with one friction column.
    coordinate : ndarray, shape (W,)
        By which neighbours are found.

    Returns
    -------
    list of WindowRows
        With `discrepancy` in N^2 such that a relative error of one is the found one.
    """
    order = np.argsort(coordinate, kind="stable")
    groups = np.array_split(order, max(1, order.size // _GROUP))
    weights = rich_weights(dictionary)
    shares, errors = [], []
    for group in groups:
        share, error = _share([windows[i] for i in group], weights)
        shares.append(share)
        errors.append(error)
    size = max(s.size for s in shares)
    padded = np.array([np.pad(s, (0, size - s.size)) for s in shares])
    spread = np.array([np.pad(e, (0, size - e.size)) for e in errors])
    median = np.median(padded, axis=0)
    certain = median > 2.0 * np.median(spread, axis=0) / np.sqrt(len(groups))
    level = np.where(certain, median, 0.0)
    return [replace(w, discrepancy=level[: w.count.size] * w.power) for w in windows]

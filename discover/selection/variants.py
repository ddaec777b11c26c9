"""Terms whose shape has no family: the variant that fits best is kept, the others dropped."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from discover.library.dictionary import DELAY, Column, Dictionary
from discover.regression.support import solve
from discover.selection.materiality import relative_triangle
from discover.triangle import WindowRows
from models.checks import Array

_SIGNIFICANT = 6.0  # rise of the log likelihood ratio from which a shape is worth its parameter
_NODES = {"fractional-derivative": 13, "power-law-damping": 3}


def rich_weights(dictionary: Dictionary, chosen: dict[str, int] | None = None) -> Array:
    """Return (K, k) of a rich model: one variant of every term, some orders and exponents.

    Parameters
    ----------
    dictionary : Dictionary
        Of the columns.
    chosen : dict, optional
        Position of the variant of each term; the first of each where absent.
    """
    if chosen is None:
        chosen = {}
        for index, column in enumerate(dictionary.columns):
            chosen.setdefault(column.id, index)
    identity = np.eye(dictionary.size)
    vectors = [identity[i] for i in chosen.values()]
    for identifier, nodes in _NODES.items():
        found = dictionary.family(identifier)
        if found is not None:
            values = np.linspace(found[0].lower, found[0].upper, nodes + 2)[1:-1]
            weights = np.zeros((dictionary.size, nodes))
            weights[found[1]] = found[0].weights(values)
            vectors.extend(weights.T)
    if dictionary.has(DELAY):
        vectors.append(identity[-1])
    return np.array(vectors).T


def settle_variants(
    windows: Sequence[WindowRows], dictionary: Dictionary
) -> tuple[list[WindowRows], Dictionary]:
    """Return windows and dictionary with one variant of every term.

    Beside a rich model each variant is tried in turn; the first (for friction the one that jumps)
    stays unless another is better by more than its parameter is worth.
    """
    variants: dict[str, list[int]] = {}
    for index, column in enumerate(dictionary.columns):
        variants.setdefault(column.id, []).append(index)
    chosen = {identifier: indices[0] for identifier, indices in variants.items()}
    triangle = relative_triangle(windows)
    informative = 8.0 * len(windows)
    for identifier, indices in variants.items():
        if len(indices) == 1:
            continue
        misfits = []
        for index in indices:
            weights = rich_weights(dictionary, {**chosen, identifier: index})
            misfits.append(solve(triangle.columns @ weights, triangle.target)[1])
        best = int(np.argmin(misfits))
        ratio = informative * np.log(max(misfits[0], 1e-300) / max(misfits[best], 1e-300))
        if ratio > _SIGNIFICANT:
            chosen[identifier] = indices[best]
    columns: list[Column] = [dictionary.columns[i] for i in chosen.values()]
    small, kept = dictionary.restricted(columns)
    positions = [*kept, -1]
    return [replace(w, matrix=w.matrix[:, positions]) for w in windows], small

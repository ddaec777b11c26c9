"""Gradual boundaries: one band's model passing into the next one's over a range.

Between two bands the force may change over gradually, and a sharp search then makes bands of the
change itself. Here a test's force is (1 - w) of the lower model and w of the upper one, with w
rising along a logistic curve of the coordinate's logarithm. For every place and width the models'
coefficients follow from one linear solve, from products that are formed once for each test.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from discover.regression.support import SupportFit
from discover.segmentation import boundary_cost
from discover.selection.evidence import penalty
from discover.triangle import WindowRows
from models.checks import Array

_PLACES = 81
_WIDTHS = np.geomspace(0.1, 4.0, 20)
_TEN_TO_NINETY = float(2.0 * np.log(9.0))  # width of a logistic curve, in its scales
_DROP = 1.92  # of the log likelihood, to the ends of a 95 % interval
_PARAMETERS = 2  # place and width


@dataclass(frozen=True)
class Transition:
    """A gradual boundary."""

    place: float
    """Coordinate at which both models share alike."""
    interval: tuple[float, float]
    """95 %, of the place."""
    width: float
    """Range of the coordinate's natural logarithm from 10 % to 90 % of the upper model."""
    log_evidence: float
    """By the same criterion as a sharp division's."""

    def share(self, coordinate: Array) -> Array:
        """Return the upper model's share at each coordinate."""
        return logistic(np.log(coordinate) - np.log(self.place), self.width)


def logistic(distance: Array, width: float) -> Array:
    """Return a logistic curve that rises from 10 % to 90 % over `width`."""
    argument = np.clip(distance * (_TEN_TO_NINETY / width), -60.0, 60.0)
    return np.asarray(1.0 / (1.0 + np.exp(-argument)))


def find_transition(
    windows: Sequence[WindowRows], coordinate: Array, lower: SupportFit, upper: SupportFit
) -> Transition:
    """Return the best gradual change from one structure to another.

    Parameters
    ----------
    windows : sequence of WindowRows
        All tests, with their model error.
    coordinate : ndarray, shape (W,)
        Positive.
    lower, upper : SupportFit
        The outer bands' fits: their terms and shapes are taken, their coefficients refitted.

    Returns
    -------
    Transition
    """
    position = np.log(coordinate)
    places = np.linspace(position.min(), position.max(), _PLACES)[1:-1]
    products, size = _products(windows, lower.weights, upper.weights)
    misfit = np.array(
        [_misfit(products, size, logistic(position - places[:, None], w)) for w in _WIDTHS]
    )
    row, column = np.unravel_index(int(misfit.argmin()), misfit.shape)
    profile = -0.5 * misfit.min(axis=0)
    near = np.flatnonzero(profile > profile.max() - _DROP)
    rows = int(sum(w.count.sum() for w in windows))
    determinant = sum(w.log_determinant for w in windows)
    parameters = lower.support.parameters + upper.support.parameters + _PARAMETERS
    evidence = -0.5 * (float(misfit[row, column]) + determinant) - penalty(parameters, rows)
    evidence -= boundary_cost(len(windows))
    return Transition(
        float(np.exp(places[column])),
        (float(np.exp(places[near[0]])), float(np.exp(places[near[-1]]))),
        float(_WIDTHS[row]),
        evidence,
    )


def _products(windows: Sequence[WindowRows], lower: Array, upper: Array) -> tuple[Array, int]:
    """Return (W, n, n) products of each test's columns [lower | upper | force], and len(lower)."""
    blocks = [
        np.column_stack([w.whitened[:, :-1] @ lower, w.whitened[:, :-1] @ upper, w.whitened[:, -1]])
        for w in windows
    ]
    products = np.array([b.T @ b for b in blocks])
    return products, lower.shape[1]


def _misfit(products: Array, size: int, share: Array) -> Array:
    """Return the least squared misfit (P,) for shares (P, W) of the upper model."""
    count = products.shape[-1]
    scale = np.ones((*share.shape, count))
    scale[..., :size] = (1.0 - share)[..., None]
    scale[..., size:-1] = share[..., None]
    total = np.einsum("pwi,wij,pwj->pij", scale, products, scale, optimize=True)
    norms = np.sqrt(np.maximum(np.diagonal(total, axis1=1, axis2=2), 1e-300))
    unit = total / norms[:, :, None] / norms[:, None, :]
    left = unit[:, :-1, :-1] + 1e-12 * np.eye(count - 1)
    side = unit[:, :-1, -1:]
    explained = np.einsum("pik,pik->p", side, np.linalg.solve(left, side))
    return np.asarray(norms[:, -1] ** 2 * np.maximum(1.0 - explained, 0.0))

"""Products of rows under the covariance that models share, a curve of friction marginalised."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from discover.posterior.covariance import Further, Sizes
from discover.posterior.space import Part, Space
from models.checks import Array


@dataclass(frozen=True)
class Compared:
    """Products of columns, at S scales of the curve."""

    scales: Array
    """(S,) of the curve; one of 0 without a curve."""
    gram: Array
    """(S, T, T)."""
    log_normal: Array
    """(S,) log density of rows at its centre, without constants, nats."""


@dataclass(frozen=True)
class Comparison:
    """Columns to compare at many sizes, what does not depend on these made once."""

    space: Space
    """Of the records, with the curve's columns."""
    columns: Array
    """(U, T, R) to compare."""
    curve: Part | None
    """A term with a curve of its own, marginalised; None without."""
    _further: Further = field(init=False, repr=False)

    def __post_init__(self) -> None:
        """Set the columns aside."""
        object.__setattr__(self, "_further", Further(self.columns))

    def at(self, sizes: Sizes) -> Compared:
        """Return products of the columns, at every scale of the curve."""
        here = self.space.given(sizes)
        if self.curve is None:
            _, among = here.beside(here.kept(np.zeros(0, dtype=int), np.zeros(0)), self._further)
            return Compared(np.zeros(1), among[None], np.array([here.log_centre]))
        kept = here.kept(self.curve.columns, self.curve.spread)
        across, among = here.beside(kept, self._further)
        scales = np.array(self.curve.scales)
        strength, axes = kept.axes
        grown = 1.0 + scales[:, None] ** 2 * strength
        seen = axes.T @ across
        share = scales[:, None] ** 2 / grown
        gram = among - seen.T @ (share[:, :, None] * seen)
        normal = here.log_centre - 0.5 * np.sum(np.log(grown), axis=1)
        return Compared(scales, gram, normal)


def curve_given(
    space: Space, sizes: Sizes, left: Array, curve: Part, scale: float, slopes: Array
) -> tuple[Array, Array, Array]:
    """Return the mean (K,) and covariance (K, K) of a curve's coefficients, the rest given.

    And (K, P), how far the mean moves with each of the model's numbers.

    Parameters
    ----------
    space : Space
        Of the records, with the curve's columns.
    sizes : Sizes
        Of what no term explains.
    left : ndarray, shape (U, R)
        What the rest of a model leaves of the measured force.
    curve : Part
        A term with a curve of its own.
    scale : float
        Of the curve.
    slopes : ndarray, shape (U, P, R)
        Of the model's numbers.
    """
    here = space.given(sizes)
    kept = here.kept(curve.columns, curve.spread)
    across, _ = here.beside(kept, Further(np.concatenate([left[:, None], slopes], axis=1)))
    strength, axes = kept.axes
    covariance = (axes * (scale**2 / (1.0 + scale**2 * strength))) @ axes.T
    moved = covariance @ across
    return moved[:, 0], covariance, -moved[:, 1:]

"""A family of columns with a continuous shape parameter, held by its Chebyshev coefficients.

D^order x and |v|^p are entire functions of order and exponent. A few columns at Chebyshev nodes
therefore stand for every value between them to near round-off, so that after compression the
shape stays continuous at a cost that no longer depends on the number of samples.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import ArrayLike

from models.checks import Array


@cache
def _to_coefficients(count: int) -> Array:
    """Return the matrix from values at the nodes to Chebyshev coefficients."""
    unit = -np.cos(np.pi * np.arange(count) / (count - 1))
    return np.asarray(np.linalg.inv(chebyshev.chebvander(unit, count - 1)))


@dataclass(frozen=True)
class Family:
    """Columns c(q) = reference^-q f(q) for q in [lower, upper].

    Examples
    --------
    >>> family = Family("fractional-derivative", "order", 0.0, 2.0, 17, 1.0)
    >>> column = np.exp(family.nodes) @ family.weights([0.3])
    >>> bool(abs(column[0] - np.exp(0.3)) < 1e-14)
    True
    """

    id: str
    """The term."""
    parameter: str
    """Its shape parameter."""
    lower: float
    """Least value."""
    upper: float
    """Greatest value."""
    count: int
    """Number of nodes."""
    reference: float
    """Scale of the base (rad/s or m/s) by which columns are made dimensionless."""

    @property
    def nodes(self) -> Array:
        """Chebyshev points of the second kind, (count,), rising."""
        return self._value(-np.cos(np.pi * np.arange(self.count) / (self.count - 1)))

    def _value(self, unit: Array) -> Array:
        return 0.5 * (self.lower + self.upper) + 0.5 * (self.upper - self.lower) * unit

    def _unit(self, value: ArrayLike) -> Array:
        values = np.atleast_1d(np.asarray(value, dtype=np.float64))
        return (2.0 * values - self.lower - self.upper) / (self.upper - self.lower)

    def weights(self, values: ArrayLike) -> Array:
        """Return (count, G) weights that make columns at `values` from those at the nodes."""
        angle = np.arccos(np.clip(self._unit(values), -1.0, 1.0))
        basis = np.cos(np.arange(self.count)[:, None] * angle)
        return np.asarray(_to_coefficients(self.count).T @ basis)

    def slope(self, value: float) -> Array:
        """Return (count,) weights of the derivative of the column with respect to the value."""
        rising = chebyshev.chebder(np.eye(self.count), axis=0) * (2.0 / (self.upper - self.lower))
        basis = chebyshev.chebvander(self._unit(value), self.count - 2)
        return np.asarray((basis @ rising @ _to_coefficients(self.count))[0])

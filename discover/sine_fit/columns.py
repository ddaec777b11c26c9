"""Real columns of harmonics, known by what makes them: their products are sums of harmonics."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from discover.sine_fit.design import ComplexArray
from models.checks import Array, Indices


@dataclass(frozen=True)
class Columns:
    """Real columns ``Re(a t^m exp(i k w t))`` at samples, by what makes them."""

    harmonic: Indices
    """(C,) k."""
    power: Indices
    """(C,) m: 0 or 1."""
    factor: ComplexArray
    """(C,) a."""

    @property
    def size(self) -> int:
        """Number of columns."""
        return self.harmonic.size

    def followed_by(self, other: Columns) -> Columns:
        """Return these columns and others after them."""
        return Columns(
            np.concatenate([self.harmonic, other.harmonic]),
            np.concatenate([self.power, other.power]),
            np.concatenate([self.factor, other.factor]),
        )

    def products(self, sums: ComplexArray) -> Array:
        """Return the sums over samples of products of columns, (C, C).

        Parameters
        ----------
        sums : ndarray of complex, shape (3, 2 H + 1)
            Of ``t^m exp(i k w t)`` over samples; as many m as products need.
        """
        k, m, a = self.harmonic, self.power[:, None] + self.power, self.factor
        apart = k[:, None] - k
        behind = sums[m, np.abs(apart)]
        behind = np.where(apart < 0, behind.conj(), behind)
        ahead = sums[m, k[:, None] + k]
        return np.asarray(0.5 * (a[:, None] * (a * ahead + a.conj() * behind)).real)

    def along(self, sums: ComplexArray) -> Array:
        """Return products with columns of samples, (K, C), from their sums (M, K, H + 1)."""
        return np.asarray((self.factor * sums[self.power, :, self.harmonic].T).real)


def columns_of(orders: tuple[int, ...], *, trend: bool) -> Columns:
    """Return the mean, cosines and negative sines of harmonics, and a trend.

    Examples
    --------
    >>> columns_of((1, 3), trend=True).harmonic.tolist()
    [0, 1, 1, 3, 3, 0]
    """
    harmonic = [0, *(k for k in orders for _ in range(2)), *([0] if trend else [])]
    factor = [1.0, *(a for _ in orders for a in (1.0, 1j)), *([1.0] if trend else [])]
    power = [0] * (1 + 2 * len(orders)) + [1] * int(trend)
    return Columns(np.array(harmonic), np.array(power), np.array(factor, dtype=np.complex128))

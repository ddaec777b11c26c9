"""The lowest lines of long records, and records of them, without the rest of the spectrum.

Within a block of samples that is short against every period that is wanted, waves are polynomials
of the time to the last bit. So a few polynomials' sums over each block hold all that the lines see
of a record: one product of matrices, and short transforms from block to block.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.fft
from numpy.typing import NDArray

from models.checks import Array

_POLYNOMIALS = 18  # for up to half a turn in a block: what they miss is below the last bit
_NODES = 18  # of frequency, between which the polynomials' own lines are interpolated
_SHORTEST = 20  # samples of a block: of shorter ones all lines cost less
_AT_ONCE = 2**18  # samples of short records, whose blocks are summed together
_FEWEST = 4096  # samples of a record, likewise

Lines = NDArray[np.complex128]


@dataclass(frozen=True)
class LowestLines:
    """The lines 0 to `count` - 1 of records of a length, as `numpy.fft.rfft` gives them."""

    size: int
    """N, samples."""
    count: int
    """K, lines."""
    block: int
    """Samples of a block, which divides `size`; 0 where all lines are taken, as no block serves."""
    polynomials: Array
    """(B, J) on a block, orthonormal."""
    answers: Lines
    """(K, J) the polynomials' products with each line's wave, over a block."""

    def of(self, columns: Array) -> Lines:
        """Return the lines (..., K) of records (..., N)."""
        if not self.block:
            return np.asarray(scipy.fft.rfft(columns, axis=-1)[..., : self.count])
        rows = columns.reshape(-1, self.size // self.block, self.block)
        found = np.empty((rows.shape[0], self.count), dtype=np.complex128)
        some = max(_AT_ONCE // self.size, 1)
        for first in range(0, rows.shape[0], some):
            here = slice(first, first + some)
            each = scipy.fft.rfft(rows[here] @ self.polynomials, axis=1)[:, : self.count]
            np.einsum("rkj,kj->rk", each, self.answers, out=found[here])
        return found.reshape(*columns.shape[:-1], self.count)

    def series(self, lines: Lines, samples: int) -> Array:
        """Return the first samples (..., M) of records whose lines (..., K) are all they have."""
        if not self.block:
            return np.asarray(scipy.fft.irfft(lines, n=self.size, axis=-1)[..., :samples])
        rows = lines.reshape(-1, self.count)
        blocks = self.size // self.block
        wanted = -(-samples // self.block)
        found, back = np.empty((rows.shape[0], samples)), self.answers.conj()
        for row, series in zip(rows, found, strict=True):
            sums = row[:, None] * back
            each = scipy.fft.irfft(sums, n=blocks, axis=0)[:wanted] / self.block
            series[:] = (each @ self.polynomials.T).reshape(-1)[:samples]
        return found.reshape(*lines.shape[:-1], samples)


def lowest_lines(size: int, count: int) -> LowestLines:
    """Return what takes the lowest lines of records.

    Parameters
    ----------
    size : int
        N, samples of a record.
    count : int
        K, lines: from 0 on, at most N // 2 + 1.

    Notes
    -----
    To rounding the lines are those of the whole transform, at a few operations for each sample
    where the lines are few, and N has a divisor for the length of a block.

    Examples
    --------
    >>> x = np.random.default_rng(1).standard_normal(12_000)
    >>> lines = lowest_lines(12_000, 100)
    >>> bool(np.allclose(lines.of(x), np.fft.rfft(x)[:100], rtol=0.0, atol=1e-11))
    True
    >>> y = np.fft.irfft(np.fft.rfft(x)[:100], n=12_000)
    >>> bool(np.allclose(lines.series(lines.of(x), 5000), y[:5000], rtol=0.0, atol=1e-14))
    True
    """
    block = _block(size, count)
    if not block:
        none = np.zeros((0, 0))
        return LowestLines(size, count, 0, none, none.astype(np.complex128))
    middle = 0.5 * (block - 1)
    away = np.arange(block) - middle
    polynomials = np.linalg.qr(
        np.polynomial.legendre.legvander(away / (middle + 0.5), _POLYNOMIALS - 1)
    )[0]
    omega = 2.0 * np.pi * np.arange(count) / size
    place = 2.0 * omega / max(omega[-1], 1e-300) - 1.0
    nodes = np.polynomial.chebyshev.chebpts1(_NODES)
    angles = np.outer(0.5 * omega[-1] * (nodes + 1.0), away)
    known = np.exp(-1j * angles) @ polynomials
    between = np.linalg.solve(np.polynomial.chebyshev.chebvander(nodes, _NODES - 1), known)
    answers = np.polynomial.chebyshev.chebvander(place, _NODES - 1) @ between
    answers *= np.exp(-1j * omega * middle)[:, None]
    return LowestLines(size, count, block, polynomials, answers)


def _block(size: int, count: int) -> int:
    """Return the greatest length of blocks that divides the record, and turns by less than half."""
    most = size // (2 * count) if size >= _FEWEST else 0
    return next((b for b in range(most, _SHORTEST - 1, -1) if size % b == 0), 0)

"""Columns and sums of harmonics."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from models.checks import Array, finite_array

ComplexArray = NDArray[np.complex128]


def harmonic_design(
    time: ArrayLike, frequency: float, harmonics: int | Sequence[int], *, trend: bool = False
) -> Array:
    """Return the columns of a least-squares fit of harmonics.

    Parameters
    ----------
    time : array_like, shape (N,)
        Time, s.
    frequency : float
        Fundamental, Hz.
    harmonics : int or sequence of int
        The highest harmonic, or the harmonics themselves.
    trend : bool, optional
        Append a column ``t - mean(t)``.

    Returns
    -------
    ndarray, shape (N, 1 + 2 H) or (N, 2 + 2 H)
        One, then ``cos(k w t)`` and ``-sin(k w t)`` for each harmonic, so that the pair of a
        harmonic's coefficients is the real and the imaginary part of its phasor; then the trend.

    Examples
    --------
    >>> harmonic_design([0.0, 0.25], 1.0, 1).round(12).tolist()
    [[1.0, 1.0, -0.0], [1.0, 0.0, -1.0]]
    """
    t = finite_array("time", time, ndim=1)
    orders = range(1, harmonics + 1) if isinstance(harmonics, int) else harmonics
    design = np.empty((t.size, 1 + 2 * len(orders) + int(trend)), order="F")
    design[:, 0] = 1.0
    for position, wave in enumerate(_powers(np.exp(2j * np.pi * frequency * t), orders)):
        design[:, 1 + 2 * position] = wave.real
        np.negative(wave.imag, out=design[:, 2 + 2 * position])
    if trend:
        design[:, -1] = t - t.mean()
    return design


def harmonic_series(time: ArrayLike, frequency: float, coefficients: ArrayLike) -> Array:
    """Return ``Re sum_k c_k exp(2 pi i k f t)``.

    Parameters
    ----------
    time : array_like, shape (N,)
        Time, s.
    frequency : float
        Fundamental, Hz.
    coefficients : array_like, shape (H + 1,)
        Complex phasors c_0 to c_H.

    Returns
    -------
    ndarray, shape (N,)

    Examples
    --------
    >>> harmonic_series([0.0, 0.25], 1.0, [1.0, 2.0, 0.5]).round(12).tolist()
    [3.5, 0.5]
    """
    t = finite_array("time", time, ndim=1)
    phasors = np.asarray(coefficients, dtype=np.complex128)
    wave = np.exp(2j * np.pi * frequency * t)
    total = np.zeros(t.size, dtype=np.complex128)
    for c in phasors[::-1]:  # Horner: no power is formed
        total = total * wave + c
    return np.ascontiguousarray(total.real)


def _powers(base: ComplexArray, orders: Sequence[int]) -> Iterator[ComplexArray]:
    """Yield powers of unit phasors by repeated products (exact to a few ulp per step).

    They share one array: each is there until the next is asked for.
    """
    wave, reached = np.ones_like(base), 0
    for k in orders:
        if k < reached:
            wave[:], reached = 1.0, 0
        while reached < k:
            np.multiply(wave, base, out=wave)
            reached += 1
        yield wave

"""Derivatives of a signal by those of a window that vanishes at its ends."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from models.checks import Array


def windowed_derivatives(signal: Array, step: float) -> tuple[Array, NDArray[np.complex128]]:
    """Return a window, and transforms of it times a signal and its first two derivatives.

    With a window h that vanishes with its slope at both ends, integration by parts gives
    ``int h e v = -int (h e)' x`` and ``int h e a = int (h e)'' x`` exactly for every
    ``e = exp(-i w t)``.

    Parameters
    ----------
    signal : ndarray, shape (N,)
        x; its mean is taken off.
    step : float
        Sampling interval, s.

    Returns
    -------
    window : ndarray, shape (N,)
    transforms : ndarray of complex, shape (3, N // 2 + 1)

    Examples
    --------
    >>> t = np.arange(1001) / 200.0
    >>> window, (x, v, a) = windowed_derivatives(np.sin(3.0 * t), 0.005)
    >>> direct = np.fft.rfft(window * 3.0 * np.cos(3.0 * t))
    >>> bool(np.abs(v - direct).max() < 1e-3 * np.abs(direct).max())
    True
    """
    size = signal.size
    turn = 2.0 * np.pi / ((size - 1) * step)
    angle = turn * step * np.arange(size)
    # (1 - cos)^2 / 4, with its first two derivatives.
    window = 0.25 * (1.0 - np.cos(angle)) ** 2
    slope = 0.5 * turn * (1.0 - np.cos(angle)) * np.sin(angle)
    bend = 0.5 * turn**2 * (np.sin(angle) ** 2 + np.cos(angle) - np.cos(angle) ** 2)
    omega = 2.0 * np.pi * np.fft.rfftfreq(size, step)
    x = signal - signal.mean()
    plain, first, second = (np.fft.rfft(w * x) for w in (window, slope, bend))
    velocity = 1j * omega * plain - first
    acceleration = second - 2j * omega * first - omega**2 * plain
    return window, np.array([plain, velocity, acceleration])

"""Windows of spectra. The latest are kept, as a record is looked at with the same one again."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from scipy.special import i0

from models.fractional.orders import Array


@lru_cache(maxsize=4)
def kaiser_window(samples: int, beta: float) -> Array:
    r"""Return :math:`I_0(\beta\sqrt{1-s^2})/I_0(\beta)`, s from -1 to 1.

    Parameters
    ----------
    samples : int
    beta : float
        Side lobes lie about 8.7 beta + 8 dB below the main one, which is 2 beta / pi bins wide
        to each side at most.

    Returns
    -------
    ndarray, shape (samples,)
        Read-only.

    References
    ----------
    Kaiser, Schafer, IEEE Trans. Acoust. Speech Signal Process. 28 (1980) 105-107.

    Examples
    --------
    >>> kaiser_window(3, 6.0).round(3)
    array([0.015, 1.   , 0.015])
    """
    s = np.linspace(-1.0, 1.0, samples)
    return _kept(i0(beta * np.sqrt(1.0 - s**2)) / i0(beta))


@lru_cache(maxsize=4)
def hann_window(samples: int) -> Array:
    """Return the window of Hann, which is zero at both ends.

    Parameters
    ----------
    samples : int

    Returns
    -------
    ndarray, shape (samples,)
        Read-only.

    Examples
    --------
    >>> hann_window(5)
    array([0. , 0.5, 1. , 0.5, 0. ])
    """
    return _kept(np.hanning(samples))


def _kept(window: Array) -> Array:
    window.flags.writeable = False
    return window

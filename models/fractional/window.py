"""A window whose side lobes lie below any noise floor."""

from __future__ import annotations

import numpy as np
from scipy.special import i0

from models.fractional.orders import Array


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

    References
    ----------
    Kaiser, Schafer, IEEE Trans. Acoust. Speech Signal Process. 28 (1980) 105-107.

    Examples
    --------
    >>> kaiser_window(3, 6.0).round(3)
    array([0.015, 1.   , 0.015])
    """
    s = np.linspace(-1.0, 1.0, samples)[: -(-samples // 2)]
    rising = i0(beta * np.sqrt(1.0 - s**2)) / i0(beta)
    return np.concatenate([rising, rising[: samples // 2][::-1]])

"""Windows: one whose side lobes lie below any noise floor, and the raised cosine."""

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


def hann_window(samples: int) -> Array:
    """Return ``numpy.hanning``, to rounding: its cosines are products, block by block.

    Parameters
    ----------
    samples : int
        One or more.

    Examples
    --------
    >>> hann_window(5).round(12).tolist()
    [0.0, 0.5, 1.0, 0.5, 0.0]
    """
    if samples < 2:
        return np.ones(samples)
    block = int(np.ceil(np.sqrt(samples)))
    angle = 2.0 * np.pi / (samples - 1) * np.arange(block)
    inside = np.stack([np.cos(angle), -np.sin(angle)])
    turned = np.column_stack([np.cos(block * angle), np.sin(block * angle)])
    waves = (0.5 * turned @ inside).reshape(-1)[: -(-samples // 2)]
    rising = np.maximum(np.subtract(0.5, waves, out=waves), 0.0)
    return np.concatenate([rising, rising[: samples // 2][::-1]])

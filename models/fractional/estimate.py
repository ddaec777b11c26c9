"""Error of a derivative, estimated from the record itself."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from models.fractional.orders import Array

Scheme = Callable[[Array, float], Array]


def relative_rms(difference: Array, values: Array) -> Array:
    """Rms of (K, R, N) differences over the rms of the values, (K,).

    Examples
    --------
    >>> relative_rms(np.ones((1, 1, 4)), 2 * np.ones((1, 1, 4)))
    array([0.5])
    """
    over = tuple(range(1, values.ndim))
    size = np.sqrt(np.mean(values**2, axis=over))
    apart = np.sqrt(np.mean(difference**2, axis=over))
    return np.asarray(np.where(apart > 0.0, apart / np.maximum(size, 1e-300), 0.0))


def truncation_error(scheme: Scheme, x: Array, dt: float, values: Array, p: float) -> Array:
    """Estimate a scheme's relative rms error from coarser samplings of the same record.

    Every second and every fourth sample give two more results; how they approach each other
    shows the order of convergence that the record allows, up to the scheme's own.

    Parameters
    ----------
    scheme : callable
        Maps a record (R, n) and its sampling interval to values (K, R, n).
    x : ndarray, shape (R, N)
    dt : float
    values : ndarray, shape (K, R, N)
        The scheme's result at dt.
    p : float
        The scheme's order.

    Returns
    -------
    ndarray, shape (K,)
        Zero for records below 64 samples, which can't be thinned.

    Examples
    --------
    >>> def slope(x, dt):
    ...     return np.gradient(x, dt, axis=-1)[None]
    >>> x = np.sin(0.1 * np.arange(200))[None]
    >>> found = truncation_error(slope, x, 0.1, slope(x, 0.1), 2)[0]
    >>> bool(0.0005 < found < 0.01)
    True
    """
    if x.shape[-1] < 64:
        return np.zeros(values.shape[0])
    half = scheme(np.ascontiguousarray(x[:, ::2]), 2.0 * dt)
    quarter = scheme(np.ascontiguousarray(x[:, ::4]), 4.0 * dt)
    near = relative_rms(half - values[..., ::2], values)
    far = relative_rms(quarter - half[..., ::2], values)
    ratio = np.clip(far / np.maximum(near, 1e-300), math.sqrt(2.0), 2.0**p)
    return np.asarray(near / (ratio - 1.0))

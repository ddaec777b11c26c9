"""Checks of the arguments that every fractional operator shares."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from models.checks import InputError, finite_array, number

Array = NDArray[np.float64]

LOWEST_ORDER = -1.0
HIGHEST_ORDER = 2.0


def checked_orders(orders: float | Sequence[float] | ArrayLike) -> tuple[Array, bool]:
    """Return the orders as a vector and whether a single scalar was given.

    Parameters
    ----------
    orders : float or array_like, shape () or (K,)
        Orders of differentiation, each in [-1, 2]; negative orders integrate.

    Returns
    -------
    orders : ndarray, shape (K,)
    scalar : bool

    Raises
    ------
    InputError
        For an order outside [-1, 2], or more than one dimension.

    Examples
    --------
    >>> checked_orders(0.5)
    (array([0.5]), True)
    """
    vector = finite_array("order", orders)
    if vector.ndim > 1:
        raise InputError("order", expected="a number or a vector", found=f"shape {vector.shape}")
    flat = np.atleast_1d(vector)
    outside = (flat < LOWEST_ORDER) | (flat > HIGHEST_ORDER)
    if outside.any():
        raise InputError("order", expected="in [-1, 2]", found=f"{float(flat[outside][0])!r}")
    return flat, vector.ndim == 0


def checked_record(x: ArrayLike, dt: float, *, min_samples: int = 2) -> tuple[Array, float]:
    """Return the record as float64, shape (..., N), and its sampling interval in seconds.

    Raises
    ------
    InputError
        For values that are not finite, fewer than `min_samples` samples, or dt <= 0.

    Examples
    --------
    >>> checked_record([0, 1, 4], 0.5)
    (array([0., 1., 4.]), 0.5)
    """
    values = finite_array("x", x)
    if values.ndim == 0 or values.shape[-1] < min_samples:
        raise InputError(
            "x", expected=f"at least {min_samples} samples long", found=f"shape {values.shape}"
        )
    return values, number("dt", dt, above=0.0)

"""Fractional derivatives of records: the operator is asked for, the scheme chosen."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from models.checks import one_of
from models.fractional.band_limit import band_limited_derivative
from models.fractional.causal import causal_derivative
from models.fractional.orders import Array, checked_orders, checked_record
from models.fractional.result import KINDS
from models.fractional.spectral import spectral_derivative
from models.fractional.weights import BDF_STEPS


def derivative(
    x: ArrayLike, order: ArrayLike, dt: float, *, kind: str = "caputo", scheme: str = "auto"
) -> Array:
    """Differentiate sampled records to fractional orders.

    Examples
    --------
    >>> t = 0.01 * np.arange(200)
    >>> y = derivative(t**2, 1.0, 0.01)
    >>> bool(np.allclose(y, 2 * t))
    True
    """
    one_of("kind", kind, KINDS)
    values, step = checked_record(x, dt)
    orders, scalar = checked_orders(order)
    rows = values.reshape(-1, values.shape[-1])
    if kind == "weyl":
        out = spectral_derivative(rows, orders, step)
    elif kind == "grunwald-letnikov":
        out = causal_derivative(rows, orders, step, scheme="gl", caputo=False, corrected=False)
    else:
        chosen = "bdf6" if scheme == "auto" else one_of("scheme", scheme, BDF_STEPS)
        out = causal_derivative(rows, orders, step, scheme=chosen, caputo=kind == "caputo")
    shaped = out.reshape(orders.size, *values.shape)
    return shaped[0] if scalar else shaped


__all__ = ["band_limited_derivative", "derivative"]

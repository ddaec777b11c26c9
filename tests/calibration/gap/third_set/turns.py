"""Where a repeated path turns."""

from __future__ import annotations

import numpy as np
from numba import njit

from models.checks import Array


@njit(cache=True)
def way_since_turn(x: Array, passes: int) -> Array:
    """Return the way (N,) since the last turn along a path (N,) that is gone some times over, m."""
    result = np.zeros(x.size)
    turned, way = x[0], 1.0
    for _ in range(passes):
        for i in range(x.size):
            step = x[i] - x[i - 1]
            if step * way < 0.0:
                turned, way = x[i - 1], -way
            result[i] = abs(x[i] - turned)
    return result

"""Arrow's columns as numpy's, without pandas, which Arrow's own way loads for it."""

from __future__ import annotations

from typing import Any

import numpy as np

from models.checks import Array


def doubles(column: Any) -> Array:
    """Return a chunked column of doubles as an array (N,) of its own, NaN where there is none.

    Examples
    --------
    >>> import pyarrow
    >>> doubles(pyarrow.chunked_array([[1.0, None], [2.5]])).tolist()
    [1.0, nan, 2.5]
    """
    result = np.empty(len(column))
    first = 0
    for chunk in column.chunks:
        if not len(chunk):
            continue
        validity, values = chunk.buffers()
        span = slice(chunk.offset, chunk.offset + len(chunk))
        part = result[first : first + len(chunk)]
        part[:] = np.frombuffer(values, dtype=np.float64, count=span.stop)[span]
        if chunk.null_count:
            bits = np.unpackbits(
                np.frombuffer(validity, dtype=np.uint8), count=span.stop, bitorder="little"
            )
            part[bits[span] == 0] = np.nan
        first += len(chunk)
    return result

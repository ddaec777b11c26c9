"""Long arrays in blocks: what is made on the way stays in the processor's cache."""

from __future__ import annotations

from collections.abc import Iterator

BLOCK = 8192
"""Samples of a block."""


def blocks(start: int, stop: int, size: int = BLOCK) -> Iterator[slice]:
    """Yield consecutive slices from `start` to `stop`.

    Examples
    --------
    >>> list(blocks(0, 5, 2))
    [slice(0, 2, None), slice(2, 4, None), slice(4, 5, None)]
    """
    for first in range(start, stop, size):
        yield slice(first, min(first + size, stop))

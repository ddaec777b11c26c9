"""Work shared over the threads that `scipy.fft` may use."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from typing import TypeVar

import scipy.fft

Item = TypeVar("Item")
Value = TypeVar("Value")


def map_threads(function: Callable[[Item], Value], items: Sequence[Item]) -> list[Value]:
    """Apply `function` to every item, in as many threads as `scipy.fft.get_workers` says.

    One thread unless the caller sets more with `scipy.fft.set_workers`: processes are the
    usual way to use more cores here, and threads inside them would compete.

    Examples
    --------
    >>> map_threads(abs, [-1, 2, -3])
    [1, 2, 3]
    """
    threads = min(int(scipy.fft.get_workers()), len(items))
    if threads <= 1:
        return [function(item) for item in items]
    with ThreadPoolExecutor(threads) as pool:
        return list(pool.map(function, items))

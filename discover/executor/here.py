"""Work in this process, one item after the other."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import ClassVar

from discover.executor.interface import Lost, R, T


class Here:
    """Does the items in their order."""

    apart: ClassVar[bool] = False

    def finished(
        self, function: Callable[[T], R], items: Sequence[T]
    ) -> Iterator[tuple[int, R | Lost]]:
        """Yield each item's place and result; see `Executor`."""
        for place, item in enumerate(items):
            yield place, function(item)

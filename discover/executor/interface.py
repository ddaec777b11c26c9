"""What every executor does."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import ClassVar, Protocol, TypeVar

T = TypeVar("T")
R = TypeVar("R")

MOST_LOSSES = 2
"""Times that an item may take its worker down, running alone there, before it is given up."""


@dataclass(frozen=True)
class Lost:
    """What an item gives whose workers died: the memory ran out, or a library crashed."""

    reason: str
    """In words."""


class Executor(Protocol):
    """Does the same work on many items."""

    apart: ClassVar[bool]
    """True where another process does it, to which items travel, and results from it."""

    def finished(
        self, function: Callable[[T], R], items: Sequence[T]
    ) -> Iterator[tuple[int, R | Lost]]:
        """Yield the place of each item and what `function` made of it, as they are done.

        What is queued is cancelled where the iteration is left early, by an interrupt or an error
        of `function`. An item whose worker is lost is done again.

        Parameters
        ----------
        function : callable
            Of one item; of a module's top level, so that other processes find it.
        items : sequence
            What travels: names of files and small values.
        """
        ...

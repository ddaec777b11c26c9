"""What was evaluated last on each motion: it is often asked for again."""

from __future__ import annotations

from collections.abc import Callable, Hashable
from typing import Generic, TypeVar
from weakref import ReferenceType, ref

from models.constitutive import ForceModel
from models.motion import Motion

_MOST_KNOWN = 128  # motions
Value = TypeVar("Value")


class Last(Generic[Value]):
    """Of each motion the last value and what it was made for.

    What was made for a motion is forgotten with it. Threads may share one.
    """

    def __init__(self) -> None:
        self._known: dict[int, tuple[ReferenceType[Motion], Hashable, Value]] = {}

    def of(self, motion: Motion, key: Hashable, make: Callable[[], Value]) -> Value:
        """Return the value that `make` gives for a motion; the last one where the key is the same.

        Parameters
        ----------
        motion : Motion
            Whose value it is.
        key : hashable
            What else it depends on.
        make : callable
            Gives it.
        """
        known = self._known.get(id(motion))
        if known is not None and known[0]() is motion and known[1] == key:
            return known[2]
        value, owner = make(), id(motion)
        if owner not in self._known and len(self._known) >= _MOST_KNOWN:
            self._known.pop(next(iter(list(self._known))), None)  # by another thread already
        forgotten = ref(motion, lambda _: self._known.pop(owner, None))
        self._known[owner] = forgotten, key, value
        return value


def key_of(model: ForceModel) -> Hashable:
    """Return what tells a model's force from another's."""
    return tuple((t.term, t.coefficient, *t.shape.items()) for t in model.terms)

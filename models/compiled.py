"""Functions that numba compiles, where numba itself is loaded only when the first one is called."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Any, Generic, ParamSpec, TypeVar, cast

P = ParamSpec("P")
R = TypeVar("R")
_one_at_a_time = threading.RLock()


class _Compiled(Generic[P, R]):
    """Stands for a function until it is called, and for what it was compiled to from then on."""

    def __init__(self, function: Callable[P, R], options: dict[str, Any]) -> None:
        self._function = function
        self._options = options
        self._dispatcher: Callable[P, R] | None = None
        self.__doc__ = function.__doc__
        self.__name__ = function.__name__
        self.__wrapped__ = function
        self.__module__ = function.__module__

    def __call__(self, *args: P.args, **kwargs: P.kwargs) -> R:
        dispatcher = self._dispatcher or self.dispatcher()
        return dispatcher(*args, **kwargs)

    def dispatcher(self) -> Callable[P, R]:
        """Return numba's function, made now where it is the first time."""
        with _one_at_a_time:
            if self._dispatcher is None:
                from numba import njit

                # Those that it calls are looked up by their names, as numba's own.
                names = self._function.__globals__
                for name in self._function.__code__.co_names:
                    called = names.get(name)
                    if isinstance(called, _Compiled):
                        names[name] = called.dispatcher()
                compiled = njit(**self._options)(self._function)
                self._dispatcher = cast("Callable[P, R]", compiled)
            return self._dispatcher


def compiled(**options: Any) -> Callable[[Callable[P, R]], Callable[P, R]]:
    """Return the decorator ``numba.njit(**options)``, which costs nothing until the first call.

    Examples
    --------
    >>> @compiled()
    ... def doubled(value: float) -> float:
    ...     return 2.0 * value
    >>> doubled(1.5)
    3.0
    """

    def decorate(function: Callable[P, R]) -> Callable[P, R]:
        return _Compiled(function, options)

    return decorate

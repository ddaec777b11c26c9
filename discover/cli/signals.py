"""Ctrl-C and a polite kill as one interrupt, from the program's first moment to its last.

What stands here is loaded before anything else, so it imports next to nothing.
"""

from __future__ import annotations

import _thread
import signal
import sys
import time

TYPE_CHECKING = False  # as of typing, whose import costs the first interrupts
if TYPE_CHECKING:
    from sys import UnraisableHookArgs

_NUMBERS = (signal.SIGINT, signal.SIGTERM)
_PAUSE = 0.01  # s
_state = {"leaving": False, "interrupted": False}
_came = {"number": int(signal.SIGINT), "thread": 0}


def leaving() -> None:
    """Let no further interrupt disturb the way out."""
    _state["leaving"] = True


def interrupted() -> bool:
    """Tell whether an interrupt has come: a library may have made another error of it."""
    return _state["interrupted"]


def meet() -> None:
    """Raise an interrupt again that was caught on its way, as by a library that tries an import."""
    if _state["interrupted"] and not _state["leaving"]:
        raise KeyboardInterrupt


def _interrupt(number: int, frame: object) -> None:
    if not _state["leaving"]:
        _state["interrupted"] = True
        _came["number"] = number
        raise KeyboardInterrupt


def _swallowed(told: UnraisableHookArgs) -> None:
    """Send an interrupt again that came where Python lets nothing through, as in a finaliser."""
    if issubclass(told.exc_type, KeyboardInterrupt):
        _thread.start_new_thread(_interrupt_after_pause, ())
    else:
        sys.__unraisablehook__(told)


def _interrupt_after_pause() -> None:
    time.sleep(_PAUSE)  # the finaliser has to end first
    if hasattr(signal, "pthread_kill"):  # ends a system call that waits, too
        signal.pthread_kill(_came["thread"], _came["number"])
    else:  # Windows
        _thread.interrupt_main()


def begin() -> None:
    """Turn SIGINT and SIGTERM into `KeyboardInterrupt`.

    Signals that whoever started the program had it ignore stay ignored.
    """
    _state.update(leaving=False, interrupted=False)
    _came["thread"] = _thread.get_ident()  # handlers run in the main thread, which this is
    sys.unraisablehook = _swallowed
    for number in _NUMBERS:
        if signal.getsignal(number) != signal.SIG_IGN:
            signal.signal(number, _interrupt)


def end() -> None:
    """Ignore both signals: the answer is given, and Python needs a moment to end."""
    leaving()
    for number in _NUMBERS:  # Python takes handlers of its own away before it has ended
        signal.signal(number, signal.SIG_IGN)

"""One folder in the place of another in one step, and back to the earlier one after a crash."""

from __future__ import annotations

import ctypes
import errno
import os
import shutil
import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache
from pathlib import Path
from typing import Any

_AT_FDCWD, _EXCHANGE = -100, 2
_UNABLE = (errno.ENOSYS, errno.EINVAL, errno.ENOTSUP, errno.EPERM)
_KEPT = "kept"


def exchange(part: Path, target: Path) -> None:
    """Put the folder `part` in the place of `target`, whose content is gone then.

    In one system call where there is one. Elsewhere by two renames, between which no signal comes;
    what a power cut leaves there `recover` mends.
    """
    if not target.exists():
        part.rename(target)
        return
    if not _exchanged(part, target):  # else the earlier content is in `part` now
        rename_twice(part, target)


def rename_twice(part: Path, target: Path) -> None:
    """Do what `exchange` does, of two folders that are there, without the system call."""
    with without_signals():
        old = target.with_name(f".{target.name}-old-{os.getpid()}")
        old.mkdir()
        target.rename(old / _KEPT)
        try:
            part.rename(target)
        except OSError:
            (old / _KEPT).rename(target)
            raise
        finally:
            shutil.rmtree(old, ignore_errors=True)


def recover(target: Path) -> None:
    """Bring back what a run that was killed left beside `target`, and clear the rest away.

    To be called by who holds the folder's lock: nobody else works on it then.
    """
    if not target.parent.is_dir():
        return
    for old in target.parent.glob(f".{_literal(target.name)}-old-*"):
        if (old / _KEPT).is_dir() and not target.exists():
            (old / _KEPT).rename(target)
        shutil.rmtree(old, ignore_errors=True)
    for part in target.parent.glob(f".{_literal(target.name)}-part-*"):
        shutil.rmtree(part, ignore_errors=True)


def _literal(name: str) -> str:
    return "".join(f"[{c}]" if c in "*?[" else c for c in name)


@contextmanager
def without_signals() -> Iterator[None]:
    """Let no signal come but those that can't be held back; they are met afterwards."""
    if not hasattr(signal, "pthread_sigmask") or (
        threading.current_thread() is not threading.main_thread()
    ):
        yield
        return
    held = {signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGQUIT}
    before = signal.pthread_sigmask(signal.SIG_BLOCK, held)
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


# Kept: the C library has the function or not, as long as the process lives.
@cache
def _renameat2() -> Any:
    """Return the C library's function, None where there is none."""
    try:
        function = ctypes.CDLL(None, use_errno=True).renameat2
    except (OSError, AttributeError, TypeError):
        return None
    function.argtypes = [
        ctypes.c_int, ctypes.c_char_p, ctypes.c_int, ctypes.c_char_p, ctypes.c_uint
    ]  # fmt: skip
    return function


def _exchanged(first: Path, second: Path) -> bool:
    """Swap two paths in one system call; False where there is none for them."""
    function = _renameat2()
    if function is None:
        return False
    names = os.fsencode(first), os.fsencode(second)
    if function(_AT_FDCWD, names[0], _AT_FDCWD, names[1], _EXCHANGE) == 0:
        return True
    number = ctypes.get_errno()
    if number in _UNABLE:
        return False
    raise OSError(number, os.strerror(number), str(second))

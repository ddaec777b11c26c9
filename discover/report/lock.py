"""A lock on a folder of results, so that two runs never write into one."""

from __future__ import annotations

import hashlib
import os
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import IO

from models.checks import InputError

try:
    import fcntl
except ImportError:  # Windows: two runs into one folder are then the user's to avoid
    fcntl = None  # type: ignore[assignment]  # as the import would

_held: dict[str, int] = {}  # how often this process holds the lock of a folder


@contextmanager
def folder_lock(folder: Path) -> Iterator[None]:
    """Hold a folder for this process; what already holds it may ask again.

    The lock is a file in the system's temporary folder that the kernel lets go when the process
    ends, however it ends. It keeps apart the runs of one machine.

    Raises
    ------
    InputError
        Where another run holds it.
    """
    key = hashlib.sha256(os.fsencode(folder.resolve())).hexdigest()[:24]
    if key in _held or fcntl is None:
        _held[key] = _held.get(key, 0) + 1
        try:
            yield
        finally:
            _held[key] -= 1
            if not _held[key]:
                del _held[key]
        return
    path = Path(tempfile.gettempdir(), f"inerter-{os.getuid()}-{key}.lock")
    file = _locked(path, folder)
    _held[key] = 1
    try:
        yield
    finally:
        del _held[key]
        path.unlink(missing_ok=True)
        file.close()


def _locked(path: Path, folder: Path) -> IO[str]:
    """Return the lock's file, locked, or raise `InputError` that names who holds it."""
    while True:
        file = path.open("a+", encoding="ascii")
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            file.seek(0)
            owner = file.read(20).strip()
            file.close()
            found = "another run's" + (f" (process {owner})" if owner else "")
            raise InputError(
                "output", expected="free to write to", found=found, where=str(folder)
            ) from None
        if _is_at(file, path):
            file.truncate(0)
            file.write(str(os.getpid()))
            file.flush()
            return file
        file.close()  # whoever held it has taken its name away: begin anew


def _is_at(file: IO[str], path: Path) -> bool:
    try:
        return os.path.samestat(os.stat(path), os.fstat(file.fileno()))
    except FileNotFoundError:
        return False

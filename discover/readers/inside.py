"""Files inside a campaign's folder: found there and nowhere else, and digested."""

from __future__ import annotations

import os
import stat
from functools import lru_cache
from pathlib import Path
from typing import Any

from discover.readers.content import content_error
from models.checks import InputError, nearest, shown

_PIECE = 2**20  # bytes


def bytes_of(folder: Path, name: str, *, where: str) -> bytes:
    """Return a file's bytes if it lies inside the campaign folder, symbolic links followed."""
    target = path_of(folder, name, where=where)
    try:
        return target.read_bytes()
    except OSError as error:
        raise _not_read(name, error.strerror or "an unreadable file", where) from None


def path_of(folder: Path, name: str, *, where: str) -> Path:
    """Return a file's path if it lies inside the campaign folder, symbolic links followed."""
    root = folder.resolve()
    try:
        target = (root / name).resolve()
        inside = target.is_relative_to(root) and not Path(name).is_absolute()
        if inside and target.is_file():
            return target
        found = kind_of(target) if inside else "outside of it"
        if inside and not target.exists():
            found += nearest(name, _names(root, root.stat().st_mtime_ns))
    except OSError as error:
        found = error.strerror or "an unreadable file"
    except (ValueError, RuntimeError) as error:  # a zero byte in the name, a loop of links
        found = str(error)
    raise _not_read(name, found, where)


def _not_read(name: str, found: str, where: str) -> InputError:
    return InputError(
        f"file {shown(name)}", expected="in the campaign folder", found=found, where=where
    )


def kind_of(target: Path, file: str = "a file") -> str:
    """Return in words what lies at a path."""
    if not target.exists():
        return "nothing there"
    if target.is_file():
        return file
    mode = target.stat().st_mode
    kinds = ((stat.S_ISDIR, "a folder"), (stat.S_ISFIFO, "a pipe"), (stat.S_ISSOCK, "a socket"))
    return next((text for test, text in kinds if test(mode)), "a device")


@lru_cache(maxsize=1)
def _names(root: Path, changed: int) -> tuple[str, ...]:
    """Return what a folder holds that was `changed` then: looked at once for many missing files."""
    with os.scandir(root) as items:
        return tuple(item.name for item in items)


def framed(name: str, data: bytes) -> bytes:
    """Return bytes that no other division into files can give."""
    return _frame(name, len(data)) + data


def _frame(name: str, size: int) -> bytes:
    return f"{name}\0{size}\0".encode()


def digest_file(digest: Any, name: str, path: Path) -> None:
    """Let a file's bytes, framed as by `framed`, into a digest, without holding them."""
    try:
        with path.open("rb") as file:
            digest.update(_frame(name, os.fstat(file.fileno()).st_size))
            while data := file.read(_PIECE):
                digest.update(data)
    except OSError as error:
        raise content_error("readable", error, name) from None

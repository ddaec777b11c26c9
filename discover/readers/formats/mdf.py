"""ASAM MDF (.mf4, .mdf, .dat of version 3 and 4) as a source of columns (asammdf)."""

from __future__ import annotations

import contextlib
import gc
import io
import sys
from collections.abc import Iterator
from typing import Any

from discover.readers.content import content_error, optional_package
from discover.readers.file_format import FileFormat
from discover.readers.source import Book
from discover.readers.tree import Leaf, tree_book
from models.checks import InputError


def open_mdf(data: bytes, name: str) -> Book:
    """Open an MDF file: its channel groups are tests, each with its own time.

    Raises
    ------
    InputError
        Where it is not such a file, holds no numeric channel, or asammdf is missing.
    """
    asammdf = optional_package("asammdf", extra="mdf", name=name)
    with _silent_destructors():
        found = _read(asammdf, data, name)
        if isinstance(found, InputError):
            gc.collect()
            raise found
    return tree_book(name, found)


def _read(asammdf: Any, data: bytes, name: str) -> list[Leaf] | InputError:
    """Return what the file holds, or what is wrong with it when all of it is let go."""
    try:
        with asammdf.MDF(io.BytesIO(data)) as file:
            return list(_leaves(file))
    except Exception as error:  # the library lets errors of many kinds through
        return content_error("an MDF file", error, name)


@contextlib.contextmanager
def _silent_destructors() -> Iterator[None]:
    """Keep quiet the library's destructor, which complains of what was never built."""
    kept = sys.unraisablehook
    sys.unraisablehook = lambda _: None
    try:
        yield
    finally:
        sys.unraisablehook = kept


def _leaves(file: Any) -> Iterator[Leaf]:
    taken: set[str] = set()
    for index, group in enumerate(file.groups):
        path = str(getattr(group.channel_group, "acq_name", None) or "").strip()
        if not path or path in taken:
            path = f"{path or 'group'} {index + 1}"
        taken.add(path)
        times = None
        for number, _channel in enumerate(group.channels):
            if file.masters_db.get(index) == number:
                continue
            signal = file.get(group=index, index=number, ignore_invalidation_bits=True)
            if times is None:
                times = signal.timestamps
                yield Leaf((path, "time"), times, unit="s", role="time")
            yield Leaf((path, signal.name.strip()), signal.samples, unit=signal.unit.strip())


FORMAT = FileFormat((".mf4", ".mdf"), open_mdf)

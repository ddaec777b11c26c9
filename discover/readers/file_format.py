"""A kind of file: the ends of its name, and what opens it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from discover.readers.source import Book


@dataclass(frozen=True)
class FileFormat:
    """What a file of ``discover/readers/formats`` defines as ``FORMAT``."""

    suffixes: tuple[str, ...]
    """Ends of the file's name, in lower case, with the dot."""
    opens: Callable[[bytes, str], Book]
    """Opens a file from its bytes and its name as in ``campaign.toml``."""
    in_pieces: Callable[[Path, str], Book] | None = None
    """Opens a file at a path, a piece at a time; None where it has to be read whole."""
    pieces_of: tuple[str, ...] = ()
    """Suffixes that `in_pieces` is for; empty for all."""

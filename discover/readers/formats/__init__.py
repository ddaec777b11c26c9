"""Which files can be read, by the end of their name: one file here for each format.

To add one, write a file here that defines ``FORMAT``.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from importlib import import_module
from pathlib import Path, PurePath
from pkgutil import iter_modules

from discover.readers.file_format import FileFormat
from discover.readers.source import Book
from models.checks import InputError

FORMATS: tuple[FileFormat, ...] = tuple(
    import_module(f"{__name__}.{module}").FORMAT
    for module in sorted(info.name for info in iter_modules(__path__))
)
"""All of them, by the names of their files."""

OPENERS: Mapping[str, Callable[[bytes, str], Book]] = {
    suffix: one.opens
    for suffix, one in sorted(
        ((suffix, one) for one in FORMATS for suffix in one.suffixes), key=lambda pair: pair[0]
    )
}
"""What opens a file, by its suffix in lower case."""

IN_PIECES: Mapping[str, Callable[[Path, str], Book]] = {
    suffix: one.in_pieces
    for one in FORMATS
    if one.in_pieces is not None
    for suffix in one.pieces_of or one.suffixes
}
"""What opens a file of which a piece at a time can be read."""


def open_file(path: Path, name: str, *, where: str) -> Book:
    """Open a file that lies at a path; arguments and errors else as of `open_book`."""
    opener = IN_PIECES.get(PurePath(name).suffix.lower())
    if opener is None:
        return open_book(path.read_bytes(), name, where=where)
    return opener(path, name)


def open_book(data: bytes, name: str, *, where: str) -> Book:
    """Open a file by the end of its name.

    Parameters
    ----------
    data : bytes
        The file.
    name : str
        Its name as in ``campaign.toml``.
    where : str
        What names it, for messages.

    Raises
    ------
    InputError
        For a suffix that is none of `OPENERS`, and as the openers do.
    """
    suffix = PurePath(name).suffix.lower()
    opener = OPENERS.get(suffix)
    if opener is None:
        raise InputError(
            f"file {name!r}",
            expected="one of " + ", ".join(OPENERS),
            found=suffix or "no suffix",
            where=where,
        )
    return opener(data, name)

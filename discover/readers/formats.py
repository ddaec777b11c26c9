"""Which files can be read, by the end of their name."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path, PurePath

from discover.readers.excel import open_excel
from discover.readers.hdf5 import open_hdf5
from discover.readers.long_text import open_long_text
from discover.readers.lvm import is_lvm, open_lvm
from discover.readers.matlab import open_mat
from discover.readers.mdf import open_mdf
from discover.readers.numpy_archive import open_npz
from discover.readers.parquet import open_parquet
from discover.readers.source import Book
from discover.readers.tdms import open_tdms
from discover.readers.text_table import open_text
from discover.readers.uff import open_uff
from models.checks import InputError


def _open_any_text(data: bytes, name: str) -> Book:
    return open_lvm(data, name) if is_lvm(data) else open_text(data, name)


OPENERS: Mapping[str, Callable[[bytes, str], Book]] = {
    ".csv": _open_any_text,
    ".tsv": _open_any_text,
    ".txt": _open_any_text,
    ".dat": _open_any_text,
    ".asc": _open_any_text,
    ".lvm": _open_any_text,
    ".parquet": open_parquet,
    ".mat": open_mat,
    ".npz": open_npz,
    ".h5": open_hdf5,
    ".hdf5": open_hdf5,
    ".xlsx": open_excel,
    ".xlsm": open_excel,
    ".tdms": open_tdms,
    ".uff": open_uff,
    ".unv": open_uff,
    ".mf4": open_mdf,
    ".mdf": open_mdf,
}
"""What opens a file, by its suffix in lower case."""

IN_PIECES: Mapping[str, Callable[[Path, str], Book]] = {
    ".csv": open_long_text,
    ".tsv": open_long_text,
    ".parquet": open_parquet,
    ".h5": open_hdf5,
    ".hdf5": open_hdf5,
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

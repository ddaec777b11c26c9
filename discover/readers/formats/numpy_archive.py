"""numpy .npz archives as a source of columns."""

from __future__ import annotations

import io

import numpy as np

from discover.readers.content import check_unpacked, content_error
from discover.readers.file_format import FileFormat
from discover.readers.source import Book
from discover.readers.tree import plain_leaves, tree_book
from models.checks import InputError


def open_npz(data: bytes, name: str) -> Book:
    """Open a numpy archive; its names are the headers. Pickled objects are refused.

    Raises
    ------
    InputError
        Where it is not such an archive or holds no numeric vector.
    """
    check_unpacked(data, "an .npz archive", name)
    arrays: dict[str, object] = {}
    try:
        with np.load(io.BytesIO(data), allow_pickle=False) as archive:
            if not isinstance(archive, np.lib.npyio.NpzFile):
                raise content_error("an .npz archive", "a single array", name)
            for key in archive.files:
                arrays[key] = archive[key]
    except InputError:
        raise
    except Exception as error:  # numpy parses headers as Python: errors of many kinds
        raise content_error("an .npz archive", error, name) from None
    return tree_book(name, list(plain_leaves(arrays)), joint=".")


FORMAT = FileFormat((".npz",), open_npz)

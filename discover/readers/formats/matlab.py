"""MATLAB .mat files as a source of columns."""

from __future__ import annotations

import io

from scipy.io import loadmat

from discover.readers.content import content_error
from discover.readers.file_format import FileFormat
from discover.readers.formats.hdf5 import is_hdf5, open_hdf5
from discover.readers.mat_guard import damage
from discover.readers.source import Book
from discover.readers.tree import plain_leaves, tree_book


def open_mat(data: bytes, name: str) -> Book:
    """Open a MATLAB file; fields of structures are named ``data.time``, members ``runs(1)``.

    Version 7.3 is HDF5 and takes h5py.

    Raises
    ------
    InputError
        Where it is not such a file or holds no numeric vector.
    """
    if is_hdf5(data):
        return open_hdf5(data, name, joint=".")
    damaged = damage(data)
    if damaged:
        raise content_error("a whole MATLAB file", damaged, name)
    try:
        content = loadmat(io.BytesIO(data), simplify_cells=True)  # type: ignore[arg-type]  # stubs
    except Exception as error:  # scipy's parser lets errors of many kinds through
        raise content_error("a MATLAB file", error, name) from None
    kept = {key: value for key, value in content.items() if not key.startswith("__")}
    return tree_book(name, list(plain_leaves(kept)), joint=".")


FORMAT = FileFormat((".mat",), open_mat)

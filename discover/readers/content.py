"""What is wrong with a file's content, and which package it takes to read it."""

from __future__ import annotations

import importlib
import io
import zipfile
from types import ModuleType

from discover.readers.source import MOST_VALUES
from models.checks import InputError


def content_error(expected: str, found: str | BaseException, name: str) -> InputError:
    r"""Return the error of a file whose content is not what its name says.

    Examples
    --------
    >>> str(content_error("a Parquet file", ValueError("no magic\nat all"), "a.parquet"))
    'a.parquet: content must be a Parquet file, got no magic'
    """
    if isinstance(found, BaseException):
        lines = str(found).strip().splitlines() or [type(found).__name__]
        found = lines[0][:120]
    return InputError("content", expected=expected, found=found, where=name)


def optional_package(module: str, *, extra: str, name: str) -> ModuleType:
    """Return a module of an optional dependency, or say what to install.

    Raises
    ------
    InputError
        Where it is not installed.
    """
    try:
        return importlib.import_module(module)
    except ImportError:
        raise InputError(
            f"package {module}",
            expected=f'installed to read this file (pip install "inerter-discovery[{extra}]")',
            found="none",
            where=name,
        ) from None


def check_unpacked(data: bytes, expected: str, name: str) -> None:
    """Refuse a zip archive that would unpack to more than memory holds.

    Raises
    ------
    InputError
        Where it would, or is no archive.
    """
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            size = sum(member.file_size for member in archive.infolist())
    except Exception as error:  # damaged archives raise errors of many kinds
        raise content_error(expected, error, name) from None
    if size > 8 * MOST_VALUES:
        raise content_error(expected, f"an archive of {size / 1e9:.3g} GB unpacked", name)

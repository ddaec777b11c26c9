"""A folder of results that is written whole or not at all."""

from __future__ import annotations

import json
import os
import shutil
import tempfile
from collections.abc import Mapping
from pathlib import Path

from models.checks import InputError

MANIFEST = ".inerter-files"
"""Names what was written, so that only that is ever replaced."""


def write_folder(
    path: str | Path, files: Mapping[str, str | bytes], *, fresh: bool = False
) -> Path:
    """Write `files` as the folder `path`, all of them or none.

    The files go to a temporary folder beside `path`, which then takes its place. Results of an
    earlier run are replaced; a folder that holds anything else is refused and left alone.

    Parameters
    ----------
    path : str or Path
        The folder.
    files : mapping
        Content by name inside the folder; a name may hold ``/``.
    fresh : bool
        Refuse any folder that is not empty, earlier results included.

    Returns
    -------
    Path
        The folder, absolute.

    Raises
    ------
    InputError
        Where the folder holds something else, is a file, or can't be written.

    Examples
    --------
    >>> with tempfile.TemporaryDirectory() as parent:
    ...     folder = write_folder(Path(parent, "out"), {"a.txt": "one", "figures/b.svg": "two"})
    ...     sorted(p.name for p in folder.rglob("*") if p.is_file() and p.name != MANIFEST)
    ['a.txt', 'b.svg']
    """
    target = Path(path).absolute()
    check_replaceable(target, fresh=fresh)
    try:
        target.parent.mkdir(parents=True, exist_ok=True)
        part = Path(tempfile.mkdtemp(prefix=f".{target.name}-", dir=target.parent))
        try:
            _fill(part, files, manifest=not fresh)
            _swap(part, target)
        finally:  # after the swap there is nothing left under this name
            shutil.rmtree(part, ignore_errors=True)
    except OSError as error:
        raise _unwritable(target, error) from None
    return target


def check_replaceable(path: str | Path, *, fresh: bool = False) -> None:
    """Refuse early, before any work, a folder that `write_folder` would refuse.

    Raises
    ------
    InputError
        As `write_folder`.
    """
    target = Path(path).absolute()
    where = str(path)
    if not target.exists():
        parent = next(p for p in target.parents if p.exists())
        if not parent.is_dir() or not os.access(parent, os.W_OK):
            raise InputError(
                "output", expected="in a writable folder", found=str(parent), where=where
            )
        return
    if not target.is_dir():
        raise InputError("output", expected="a folder", found="a file", where=where)
    found = {p.relative_to(target).as_posix() for p in target.rglob("*") if not p.is_dir()}
    if not found:
        return
    if fresh:
        raise InputError(
            "output",
            expected="a new or empty folder",
            found=f"one that holds {sorted(found)[0]}",
            where=where,
        )
    foreign = found - _listed(target) - {MANIFEST}
    if foreign:
        raise InputError(
            "output",
            expected="a new folder or one of earlier results",
            found=f"one that also holds {sorted(foreign)[0]}",
            where=where,
        )


def _listed(target: Path) -> set[str]:
    try:
        return set(json.loads((target / MANIFEST).read_text(encoding="utf-8")))
    except (OSError, ValueError):
        return set()


def _fill(part: Path, files: Mapping[str, str | bytes], *, manifest: bool) -> None:
    for name, content in files.items():
        place = part / name
        place.parent.mkdir(parents=True, exist_ok=True)
        place.write_bytes(content.encode("utf-8") if isinstance(content, str) else content)
    if manifest:
        (part / MANIFEST).write_text(json.dumps(sorted(files)) + "\n", encoding="utf-8")
    # mkdtemp makes it private; results are as readable as any other new folder.
    mask = os.umask(0)
    os.umask(mask)
    part.chmod(0o777 & ~mask)


def _swap(part: Path, target: Path) -> None:
    """Put `part` in the place of `target`; on failure the old folder comes back."""
    if not target.exists():
        part.rename(target)
        return
    old = Path(tempfile.mkdtemp(prefix=f".{target.name}-old-", dir=target.parent))
    target.rename(old / "kept")
    try:
        part.rename(target)
    except BaseException:  # an interrupt too must not lose the earlier results
        (old / "kept").rename(target)
        raise
    finally:
        shutil.rmtree(old, ignore_errors=True)


def _unwritable(target: Path, error: OSError) -> InputError:
    return InputError(
        "output", expected="writable", found=error.strerror or str(error), where=str(target)
    )

"""A folder of results that is written whole or not at all."""

from __future__ import annotations

import contextlib
import json
import os
import shutil
import tempfile
from collections.abc import Iterable, Mapping
from pathlib import Path, PurePosixPath

from discover.report.lock import folder_lock
from discover.report.swap import exchange, recover, without_signals
from models.checks import InputError

MANIFEST = ".inerter-files"
"""Names what was written, so that only that is ever replaced."""
_PART = ".inerter-part"


def write_folder(
    path: str | Path, files: Mapping[str, str | bytes], *, fresh: bool = False
) -> Path:
    """Write `files` as the folder `path`, all of them or none.

    The files go to a temporary folder beside `path`, which then takes its place. A folder that has
    to stay (a mount point, the working folder) is filled from a folder inside it. Results of an
    earlier run are replaced; a folder that holds anything else is refused and left alone, and so
    is one that another run writes to. A link to a folder stays a link.

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
    target = _target(path)
    with folder_lock(target):
        check_replaceable(path, fresh=fresh)
        try:
            target.parent.mkdir(parents=True, exist_ok=True)
            recover(target)
            if _in_place(target):
                _fill_in_place(target, files, manifest=not fresh)
            else:
                _fill_beside(target, files, manifest=not fresh)
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
    target = _target(path)
    where = str(path)
    if not target.exists():
        parent = next(p for p in target.parents if p.exists())
        if not parent.is_dir() or not os.access(parent, os.W_OK | os.X_OK):
            raise InputError(
                "output", expected="in a writable folder", found=str(parent), where=where
            )
        _make_one(target, parent)
        return
    if not target.is_dir():
        raise InputError("output", expected="a folder", found="a file", where=where)
    if not os.access(target, os.W_OK | os.X_OK):
        raise InputError("output", expected="writable", found="a folder that is not", where=where)
    found = {n for n in _content(target) if not n.startswith(f"{_PART}-")}
    if fresh and found:
        raise InputError(
            "output",
            expected="a new or empty folder",
            found=f"one that holds {sorted(found)[0]}",
            where=where,
        )
    listed = _listed(target)
    above = {p.as_posix() for name in listed for p in PurePosixPath(name).parents}
    foreign = {n for n in found - listed - {MANIFEST} if n.removesuffix("/") not in above}
    if foreign:
        raise InputError(
            "output",
            expected="a new folder or one of earlier results",
            found=f"one that also holds {sorted(foreign)[0]}",
            where=where,
        )
    _make_one(target, target if _in_place(target) else target.parent)


def _make_one(target: Path, parent: Path) -> None:
    """Make a folder where that of the results will be made, and take it away again.

    A file system that is read-only or full may not say so by its permissions.
    """
    prefix = f"{_PART}-" if parent == target else f".{target.name}-part-"
    try:
        with without_signals():
            os.rmdir(tempfile.mkdtemp(prefix=prefix, dir=parent))
    except OSError as error:
        raise _unwritable(target, error) from None


def _target(path: str | Path) -> Path:
    """Return the folder that is meant; of a link that to which it leads.

    Raises
    ------
    InputError
        Where links lead in a circle.
    """
    try:
        return Path(path).absolute().resolve()
    except (OSError, RuntimeError) as error:
        raise InputError("output", expected="a folder", found=str(error), where=str(path)) from None


def _content(target: Path) -> set[str]:
    """Return everything in a folder by name, folders with a slash at the end."""
    return {
        p.relative_to(target).as_posix() + ("/" if p.is_dir() and not p.is_symlink() else "")
        for p in target.rglob("*")
    }


def _listed(target: Path) -> set[str]:
    """Return what the manifest of earlier results names; nothing where it is damaged."""
    try:
        names = json.loads((target / MANIFEST).read_text(encoding="utf-8"))
    except (OSError, ValueError, RecursionError):
        return set()
    listed = names if isinstance(names, list) else []
    return {n for n in listed if isinstance(n, str) and _inside(PurePosixPath(n))}


def _inside(name: PurePosixPath) -> bool:
    return not name.is_absolute() and ".." not in name.parts and name != PurePosixPath(".")


def _in_place(target: Path) -> bool:
    """Return whether a folder has to stay the one that it is.

    So a mount point, the working folder or one above it, and one beside which nothing may be made.
    """
    if not target.exists():
        return False
    here = Path.cwd()
    if target == here or target in here.parents or os.path.ismount(target):
        return True
    return not os.access(target.parent, os.W_OK | os.X_OK)


def _fill_beside(target: Path, files: Mapping[str, str | bytes], *, manifest: bool) -> None:
    part = Path(tempfile.mkdtemp(prefix=f".{target.name}-part-", dir=target.parent))
    try:
        _fill(part, files)
        if manifest:
            _write_manifest(part, files)
        # mkdtemp makes it private; results are as readable as any other new folder.
        mask = os.umask(0)
        os.umask(mask)
        part.chmod(0o777 & ~mask)
        exchange(part, target)
    finally:  # after the exchange it holds what was there before, or is gone
        shutil.rmtree(part, ignore_errors=True)


def _fill_in_place(target: Path, files: Mapping[str, str | bytes], *, manifest: bool) -> None:
    """Fill a folder inside it, then move what is in there up, with no signal in between."""
    for left in target.glob(f"{_PART}-*"):
        shutil.rmtree(left, ignore_errors=True)
    part = Path(tempfile.mkdtemp(prefix=f"{_PART}-", dir=target))
    try:
        _fill(part, files)
        earlier = _listed(target)
        with without_signals():
            if manifest:  # first of both, so that nothing is foreign after a power cut
                _write_manifest(target, {*earlier, *files})
            for name in sorted(earlier - set(files)):
                (target / name).unlink(missing_ok=True)
            for name in files:
                (target / name).parent.mkdir(parents=True, exist_ok=True)
                (part / name).replace(target / name)
            above = {p for name in earlier for p in PurePosixPath(name).parents}
            for folder in sorted(above - {PurePosixPath(".")}, reverse=True):
                with contextlib.suppress(OSError):  # it still holds something
                    (target / folder).rmdir()
            if manifest:
                _write_manifest(target, files)
    finally:
        shutil.rmtree(part, ignore_errors=True)


def _fill(part: Path, files: Mapping[str, str | bytes]) -> None:
    for name, content in files.items():
        place = part / name
        place.parent.mkdir(parents=True, exist_ok=True)
        place.write_bytes(content.encode("utf-8") if isinstance(content, str) else content)


def _write_manifest(folder: Path, names: Iterable[str]) -> None:
    (folder / MANIFEST).write_text(json.dumps(sorted(names)) + "\n", encoding="utf-8")


def _unwritable(target: Path, error: OSError) -> InputError:
    return InputError(
        "output", expected="writable", found=error.strerror or str(error), where=str(target)
    )

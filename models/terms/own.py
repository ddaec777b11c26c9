"""A user's own term, read from a Python file and checked before anything is computed with it."""

from __future__ import annotations

import contextlib
import copyreg
import hashlib
import importlib.machinery
import importlib.util
import io
import sys
from dataclasses import replace
from functools import lru_cache
from pathlib import Path
from types import ModuleType
from typing import Any

from models.checks import InputError
from models.terms.guard import GuardedColumn, GuardedTransform, failure, probe
from models.terms.own_checks import check_fields, check_parameter, checked_trials
from models.terms.term import Term, TermSource

_SHOWN = 12


def read_term(path: str | Path) -> Term:
    """Return the ``TERM`` that a Python file defines, checked.

    The file stands alone: it may import installed packages, not its neighbours, since its hash is
    what identifies the term. Reading it runs it. Of `VARIANTS`, if it is there, each entry maps
    parameters to values in the units of their bounds: the shapes to try.

    Parameters
    ----------
    path : str or Path
        The file.

    Returns
    -------
    Term
        With its `source`. Its column or transform raises `InputError` for what is not finite.

    Raises
    ------
    InputError
        Where there is no such file, or it fails, or what it defines can't be a term.
    """
    file = Path(path)
    if not file.is_file():
        found = "a folder" if file.is_dir() else "no such file"
        raise InputError("effect", expected="a Python file", found=found, where=str(path))
    return _checked(file.resolve(), file.read_bytes())


# Kept: a content is run once in a process, so that a class which it defines stays the same class.
@lru_cache(maxsize=32)
def _checked(path: Path, content: bytes) -> Term:
    sha256 = hashlib.sha256(content).hexdigest()
    module = _run(path, content, sha256)
    term = getattr(module, "TERM", None)
    where = str(path)
    if not isinstance(term, Term):
        found = "nothing" if term is None else type(term).__name__
        raise InputError("TERM", expected="a models.terms.Term", found=found, where=where)
    check_fields(term, where=where)
    for parameter in term.parameters:
        check_parameter(parameter, where=where)
    column, transform = term.column, term.transform
    term = replace(
        term,
        harmonic=False,  # linear analysis knows the catalogue's terms only
        trials=checked_trials(term, getattr(module, "VARIANTS", ()), where=where),
        source=TermSource(path, sha256),
        column=column and GuardedColumn(term.id, where, column),
        transform=transform and GuardedTransform(term.id, where, transform),
    )
    probe(term, where=where)
    return term


def _run(path: Path, content: bytes, sha256: str) -> ModuleType:
    name = f"inerter_own_term_{sha256[:16]}"
    module = importlib.util.module_from_spec(
        importlib.machinery.ModuleSpec(name, None, origin=str(path))
    )
    module.__file__ = str(path)
    sys.modules[name] = module  # dataclasses look their module up
    try:
        with contextlib.redirect_stdout(io.StringIO()):
            exec(compile(content, str(path), "exec"), module.__dict__)
    except SyntaxError as error:
        del sys.modules[name]
        line = "" if error.lineno is None else f":{error.lineno}"
        raise InputError(
            "the file", expected="Python", found=str(error.msg), where=f"{path}{line}"
        ) from None
    except (Exception, SystemExit) as error:
        del sys.modules[name]
        raise failure("the file", "able to run", error, path=str(path)) from None
    return module


def same_file(term: Term, sha256: str, *, where: str = "") -> Term:
    """Return a user's term if its file has this hash.

    Raises
    ------
    InputError
        For another hash, or a term of the catalogue.
    """
    if term.source is None:
        found = "the catalogue's own term of that name"
    elif term.source.sha256 == sha256:
        return term
    else:
        found = f"{term.source.path} with sha256 {term.source.sha256[:_SHOWN]}…"
    raise InputError(
        f"the file of effect {term.id!r}", expected=f"the one with sha256 {sha256[:_SHOWN]}…",
        found=found, where=where,
    )  # fmt: skip


def restored(path: Path, sha256: str) -> Term:
    """Return a user's term in another process, which reads the same file again."""
    return same_file(read_term(path), sha256, where=str(path))


def _reduce(term: Term) -> Any:
    if term.source is None:
        return term.__reduce_ex__(2)
    return restored, (term.source.path, term.source.sha256)


copyreg.pickle(Term, _reduce)

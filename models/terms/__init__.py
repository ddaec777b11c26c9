"""The vocabulary: one file a term. To add one, write a file here that defines ``TERM``.

A user's own term stands in a file elsewhere: `load_term` reads it and `own_terms` adds it for the
length of a block.
"""

from collections.abc import Iterator
from contextlib import contextmanager
from importlib import import_module
from pathlib import Path
from pkgutil import iter_modules

from models.checks import InputError, one_of
from models.terms.own import read_term
from models.terms.scales import Scales
from models.terms.term import ForceOf, Parameter, Shape, Start, Term, TermSource

TERMS: dict[str, Term] = {
    term.id: term
    for module in sorted(info.name for info in iter_modules(__path__))
    if (term := getattr(import_module(f"{__name__}.{module}"), "TERM", None)) is not None
}
"""Every term by its id: the catalogue, and within `own_terms` the user's own."""

CATALOGUE = tuple(sorted(TERMS))
"""Ids that are always there."""


def find_term(identifier: str, *, where: str = "") -> Term:
    """Return the term called `identifier`, or raise `InputError` that lists all.

    Parameters
    ----------
    identifier : str
        Id in the vocabulary.
    where : str
        What an error names as the place.

    Returns
    -------
    Term

    Raises
    ------
    InputError
        For an id that is not there; the line lists all.

    Examples
    --------
    >>> find_term("inertia").unit
    'kg'
    """
    return TERMS[one_of("term", identifier, sorted(TERMS), where=where)]


def curves_of(term: Term, scales: Scales) -> list[tuple[str, Shape]]:
    """Return ids and shapes of a term's curves, the plainest first.

    Those of terms that mean nothing without it are among them.
    """
    own = term.curves(scales) if term.curves is not None else [term.shape({})]
    others = [
        (t.id, shape) for t in TERMS.values()
        if term.id in t.needs and t.curves is not None for shape in t.curves(scales)
    ]
    return [*((term.id, shape) for shape in own), *others]


def load_term(path: str | Path) -> Term:
    """Return a user's own term from a Python file that defines ``TERM``, checked.

    Parameters
    ----------
    path : str or Path
        The file, written as those of ``models/terms``. Reading it runs it.

    Returns
    -------
    Term
        For `own_terms`. It can be pickled: another process reads the file again.

    Raises
    ------
    InputError
        Where the file or what it defines is at fault, with the line where there is one.
    """
    term = read_term(path)
    if term.id in CATALOGUE:
        raise InputError(
            "id of TERM", expected="one that the catalogue does not have", found=repr(term.id),
            where=str(path),
        )  # fmt: skip
    return term


@contextmanager
def own_terms(*terms: Term) -> Iterator[None]:
    """Add terms to the vocabulary for the length of a ``with`` block.

    Parameters
    ----------
    *terms : Term
        From `load_term`. One that is there already, from the same file, is passed over.

    Raises
    ------
    InputError
        Where two terms have one id.

    Examples
    --------
    >>> drag = Term("air-drag", "N s^3/m^3", "c v^3", lambda motion, shape: motion.velocity**3)
    >>> with own_terms(drag):
    ...     find_term("air-drag").unit
    'N s^3/m^3'
    >>> "air-drag" in TERMS
    False
    """
    added: list[str] = []
    try:
        for term in terms:
            there = TERMS.get(term.id)
            if there is None:
                TERMS[term.id] = term
                added.append(term.id)
            elif not _same(there, term):
                raise InputError(
                    "effects", expected="of different ids", found=f"{term.id} twice",
                    where="" if term.source is None else str(term.source.path),
                )  # fmt: skip
        yield
    finally:
        for name in added:
            del TERMS[name]


def _same(one: Term, other: Term) -> bool:
    if one.source is None or other.source is None:
        return one == other
    return one.id == other.id and one.source.sha256 == other.source.sha256


__all__ = [
    "CATALOGUE",
    "TERMS",
    "ForceOf",
    "Parameter",
    "Scales",
    "Shape",
    "Start",
    "Term",
    "TermSource",
    "find_term",
    "load_term",
    "own_terms",
]

"""The vocabulary: one file a term. To add one, write a file here that defines ``TERM``."""

from importlib import import_module
from pkgutil import iter_modules

from models.checks import one_of
from models.terms.term import Parameter, Shape, Term

TERMS: dict[str, Term] = {
    term.id: term
    for module in sorted(info.name for info in iter_modules(__path__))
    if (term := getattr(import_module(f"{__name__}.{module}"), "TERM", None)) is not None
}
"""Every term by its id."""


def find_term(identifier: str, *, where: str = "") -> Term:
    """Return the term called `identifier`, or raise `InputError` that lists all.

    Examples
    --------
    >>> find_term("inertia").unit
    'kg'
    """
    return TERMS[one_of("term", identifier, sorted(TERMS), where=where)]


__all__ = ["TERMS", "Parameter", "Shape", "Term", "find_term"]

"""What a user's own term has to be, before it is evaluated."""

from __future__ import annotations

import re
from collections.abc import Mapping
from types import MappingProxyType
from typing import Any

from models.checks import InputError, number, one_of
from models.terms.term import Parameter, Shape, Term

SCALED_BY = ("", "displacement", "speed", "force")
_ID = re.compile(r"[a-z][a-z0-9]*(-[a-z0-9]+)*")
_VERDICTS = ("agrees", "unknown")
"""They stand beside effects."""
_KEYS = (
    "id", "coefficient", "unit", "std_error", "interval", "source", "order", "presliding",
)  # fmt: skip
"""Keys of a term in documents, and parameters that mean something to the fits."""


def check_fields(term: Term, *, where: str) -> None:
    """Check a term's name, what it gives, and that its parameters are named once.

    Raises
    ------
    InputError
        For the first thing that is wrong.
    """
    if not isinstance(term.id, str) or not _ID.fullmatch(term.id) or term.id in _VERDICTS:
        raise InputError(
            "id of TERM", expected="lower-case words joined by hyphens, not agrees or unknown",
            found=repr(term.id), where=where,
        )  # fmt: skip
    for name in ("unit", "summary"):
        if not isinstance(text := getattr(term, name), str):
            raise InputError(f"{name} of TERM", expected="text", found=repr(text), where=where)
    one_of("acts of TERM", term.acts, ("force", "input", "output"), where=where)
    if not callable(term.follows):
        one_of("follows of TERM", term.follows, ("motion", "path", "time"), where=where)
    wanted, other = ("column", "transform") if term.acts == "force" else ("transform", "column")
    if not callable(getattr(term, wanted)) or getattr(term, other) is not None:
        given = [n for n in ("column", "transform") if getattr(term, n) is not None]
        raise InputError(
            f"TERM that acts as {term.acts!r}", expected=f"given a function {wanted} alone",
            found=" and ".join(given) or "neither column nor transform", where=where,
        )  # fmt: skip
    if not isinstance(term.parameters, tuple) or not all(
        isinstance(p, Parameter) for p in term.parameters
    ):
        raise InputError(
            "parameters of TERM", expected="a tuple of Parameter", found=repr(term.parameters),
            where=where,
        )  # fmt: skip
    names = [p.name for p in term.parameters]
    twice = next((n for n in names if names.count(n) > 1), None)
    if twice is not None:
        raise InputError(
            "parameters of TERM", expected="each once", found=f"{twice} twice", where=where
        )
    try:
        term.unit.format(**dict.fromkeys(names, "1"))
    except (KeyError, IndexError, ValueError):
        raise InputError(
            "unit of TERM", expected="text with no braces but around parameters",
            found=repr(term.unit), where=where,
        ) from None  # fmt: skip


def check_parameter(parameter: Parameter, *, where: str) -> None:
    """Check a parameter's name and bounds.

    Raises
    ------
    InputError
        For the first thing that is wrong.
    """
    name = f"parameter {parameter.name!r} of TERM"
    if not isinstance(parameter.name, str) or not parameter.name.isidentifier():
        raise InputError(name, expected="named by a word", found=repr(parameter.name), where=where)
    if parameter.name in _KEYS:
        raise InputError(
            name, expected="named otherwise than " + ", ".join(_KEYS), found=parameter.name,
            where=where,
        )  # fmt: skip
    one_of(f"scaled_by of {name}", parameter.scaled_by, SCALED_BY, where=where)
    one_of(f"spacing of {name}", parameter.spacing, ("linear", "log"), where=where)
    lower = number(f"lower of {name}", parameter.lower, where=where)
    if parameter.spacing == "log":
        number(f"lower of {name} with log spacing", lower, above=0.0, where=where)
    number(f"upper of {name}", parameter.upper, above=lower, where=where)
    number(f"default of {name}", parameter.default, where=where)


def checked_trials(term: Term, given: Any, *, where: str) -> tuple[Shape, ...]:
    """Return the file's ``VARIANTS`` as a term's `trials`.

    Raises
    ------
    InputError
        For what is no list of mappings from the term's parameters to numbers.
    """
    if not isinstance(given, list | tuple) or not all(isinstance(v, Mapping) for v in given):
        raise InputError(
            "VARIANTS", expected="a list of mappings from parameter to value", found=repr(given),
            where=where,
        )  # fmt: skip
    known = [p.name for p in term.parameters]
    for variant in given:
        for key, value in variant.items():
            one_of("parameter in VARIANTS", key, known, where=where)
            number(f"{key} in VARIANTS", value, where=where)
    return tuple(MappingProxyType({k: float(x) for k, x in v.items()}) for v in given)

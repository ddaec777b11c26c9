"""Checks of input: one clear error that says what, where, expected and found."""

from __future__ import annotations

import difflib
import math
import unicodedata
from collections.abc import Iterable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]
Indices = NDArray[np.int_]

LONGEST = 400
"""Characters of any part of a message: files hold headers and fields of any length."""
LONGEST_LINE = 1900
"""Characters of a line on the terminal, with what a log puts before it."""

_LONGEST_NAME = 120


def printable(text: str, *, longest: int = LONGEST) -> str:
    r"""Return `text` fit for one line: control characters escaped, what is too long cut.

    Examples
    --------
    >>> printable("force\x1b[2J\n[kN]"), printable("abcdefgh", longest=6)
    ('force\\x1b[2J\\n[kN]', 'abcde…')
    """
    cut = text if len(text) <= longest else text[: longest - 1] + "…"
    return "".join(c if _plain(c) else c.encode("unicode_escape").decode() for c in cut)


def _plain(character: str) -> bool:
    return character.isprintable() or unicodedata.category(character) == "Zs"


def shown(value: object, *, longest: int = 80) -> str:
    """Return a value of a user's file as a message shows it, however large it is.

    Examples
    --------
    >>> shown("kN"), shown(10**5000), shown([1] * 99, longest=8)
    ("'kN'", 'a very large number', '[1, 1, …')
    """
    try:
        text = repr(value)
    except ValueError:  # Python writes no integer of thousands of digits
        return "a very large number"
    return printable(text, longest=longest)


class InputError(ValueError):
    """Input that can't be worked on.

    Parameters
    ----------
    what : str
        The thing that is wrong, by the name that the user knows it by.
    expected, found : str, optional
        What would have been right, and what was there.
    where : str, optional
        File, record, table or argument that holds it.

    Examples
    --------
    >>> str(InputError("order", expected="in [0, 2]", found="2.4", where="--orders"))
    '--orders: order must be in [0, 2], got 2.4'
    """

    def __init__(self, what: str, *, expected: str = "", found: str = "", where: str = "") -> None:
        what, found, where = (printable(part) for part in (what, found, where))
        expected = printable(expected, longest=2 * LONGEST)  # it may list what there is
        text = what
        if expected:
            text += f" must be {expected}"
        if found:
            text += f", got {found}" if expected else f": {found}"
        super().__init__(f"{where}: {text}" if where else text)
        self.what = what
        self.expected = expected
        self.found = found
        self.where = where

    def __reduce__(self) -> tuple[Any, ...]:
        """Return how another process makes the same error."""
        return _remade, (type(self), self.args), self.__dict__


def _remade(kind: type[InputError], args: tuple[str, ...]) -> InputError:
    error = kind.__new__(kind)
    error.args = args
    return error


class InputErrors(InputError):
    """Several things that can't be worked on, so that one run tells them all.

    Parameters
    ----------
    errors : iterable of InputError
        At least one.
    advice : str
        What to do about them.

    Examples
    --------
    >>> print(InputErrors([InputError("a.csv"), InputError("b.csv")], advice="mend both"))
    a.csv
    b.csv
    mend both
    """

    def __init__(self, errors: Iterable[InputError], *, advice: str) -> None:
        self.errors = tuple(errors)
        first = self.errors[0]
        super().__init__(first.what, expected=first.expected, found=first.found, where=first.where)
        self.lines = (*(str(error) for error in self.errors), printable(advice))

    def __str__(self) -> str:
        """Return one line an error, then the advice."""
        return "\n".join(self.lines)


def number(
    name: str,
    value: Any,
    *,
    above: float | None = None,
    at_least: float | None = None,
    below: float | None = None,
    at_most: float | None = None,
    where: str = "",
) -> float:
    """Return `value` as a finite float within the stated bounds, or raise `InputError`.

    Examples
    --------
    >>> number("rod_radius", 0.012, above=0.0)
    0.012
    """
    bounds = [
        text
        for limit, text in (
            (above, f"> {above}"),
            (at_least, f">= {at_least}"),
            (below, f"< {below}"),
            (at_most, f"<= {at_most}"),
        )
        if limit is not None
    ]
    expected = "a finite number" + (" " + " and ".join(bounds) if bounds else "")
    try:
        result = float(value)
    except (TypeError, ValueError, OverflowError):  # the last of integers beyond 1e308
        raise InputError(name, expected=expected, found=shown(value), where=where) from None
    outside = (
        not math.isfinite(result)
        or (above is not None and not result > above)
        or (at_least is not None and not result >= at_least)
        or (below is not None and not result < below)
        or (at_most is not None and not result <= at_most)
    )
    if outside:
        raise InputError(name, expected=expected, found=shown(value), where=where)
    return result


def stored_number(name: str, value: Any, *, where: str = "", size: float = 1e30) -> float:
    """Return a number of a document: neither text nor true, and of a size that can be squared.

    Examples
    --------
    >>> stored_number("coefficient", 3)
    3.0
    >>> stored_number("coefficient", True, where="model.json")
    Traceback (most recent call last):
        ...
    models.checks.InputError: model.json: coefficient must be a number, got True
    """
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise InputError(name, expected="a number", found=shown(value), where=where)
    return number(name, value, at_least=-size, at_most=size, where=where)


def finite_array(
    name: str, value: ArrayLike, *, ndim: int | None = None, min_size: int = 1, where: str = ""
) -> Array:
    """Return `value` as a float64 array (never a copy where none is needed), all finite.

    Examples
    --------
    >>> finite_array("x", [1, 2]).dtype
    dtype('float64')
    """
    try:
        result = np.asarray(value, dtype=np.float64)
    except (TypeError, ValueError):
        found = type(value).__name__
        raise InputError(name, expected="numeric", found=found, where=where) from None
    if ndim is not None and result.ndim != ndim:
        raise InputError(
            name, expected=f"{ndim}-dimensional", found=f"shape {result.shape}", where=where
        )
    if result.size < min_size:
        raise InputError(
            name, expected=f"at least {min_size} values", found=f"{result.size}", where=where
        )
    bad = ~np.isfinite(result)
    if bad.any():
        index = tuple(int(i) for i in np.argwhere(bad)[0])
        raise InputError(
            name,
            expected="finite throughout",
            found=f"{result[index]} at index {index[0] if len(index) == 1 else index}"
            f" ({int(bad.sum())} such values)",
            where=where,
        )
    return result


def nearest(text: str, choices: Iterable[str]) -> str:
    """Return " (did you mean 'x'?)" for a near name, else an empty string.

    What is longer than a name is near to none.

    Examples
    --------
    >>> nearest("frequncy", ["frequency", "file"])
    " (did you mean 'frequency'?)"
    >>> nearest("stribek", ["stiffness", "stribeck-friction"])
    " (did you mean 'stribeck-friction'?)"
    """
    if len(text) > _LONGEST_NAME:
        return ""
    names = [name for name in choices if len(name) <= _LONGEST_NAME]
    close = difflib.get_close_matches(text.lower(), names, n=1, cutoff=0.7)
    first = {n.partition("-")[0]: n for n in reversed(names)}
    close += [first[w] for w in difflib.get_close_matches(text.lower(), first, n=1, cutoff=0.7)]
    return f" (did you mean {close[0]!r}?)" if close else ""


def one_of(name: str, value: str, choices: Iterable[str], *, where: str = "") -> str:
    """Return `value` if it is one of `choices`, or raise `InputError` that lists them.

    Examples
    --------
    >>> one_of("convention", "paper", ("paper", "standard"))
    'paper'
    """
    listed = tuple(choices)
    if value not in listed:
        near = nearest(value, listed) if isinstance(value, str) else ""  # a user's file may err
        raise InputError(
            name, expected="one of " + ", ".join(listed), found=shown(value) + near, where=where
        )
    return value

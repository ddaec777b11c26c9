"""Whether the last row of a text was written to its end."""

from __future__ import annotations

from collections.abc import Sequence

from discover.readers.numerals import is_number
from models.checks import shown

BEFORE = 50
"""Rows above the last one that show how its last number would be written."""

_SHOWN = 60  # characters of a line


def is_cut(
    last: Sequence[str], before: Sequence[Sequence[str]], width: int, *, unended: bool
) -> bool:
    """Return whether the last row of samples is not whole as those above it are.

    It has too few fields; or, where the text does not end with the line, the last one is no
    number, or a number with fewer digits behind the mark than all above it have.

    Parameters
    ----------
    last : sequence of str
        The row's fields.
    before : sequence of sequence of str
        Fields of the rows above it, the nearest last; at least one.
    width : int
        Fields of a whole row.
    unended : bool
        Whether nothing ends the line.

    Examples
    --------
    >>> above = [["0.0", "1.250"], ["0.1", "1.375"]]
    >>> is_cut(["0.2"], above, 2, unended=True), is_cut(["0.2", "1."], above, 2, unended=True)
    (True, True)
    >>> is_cut(["0.2", "1.500"], above, 2, unended=True)
    False
    """
    if len(before[-1]) < width:
        return False  # which is for reading to complain of
    if len(last) < width or not unended:
        return len(last) < width
    end = last[width - 1]
    usual = {_digits(row[width - 1]) for row in before if len(row) >= width}
    return not is_number(end) or (len(usual) == 1 and _digits(end) < min(usual))


def _digits(field: str) -> int:
    """Return how many characters follow the last decimal mark; 0 where there is none."""
    place = max(field.rfind("."), field.rfind(","))
    return len(field) - place - 1 if place >= 0 else 0


def cut_text(line: int, text: str) -> str:
    """Return what to tell of a last line that was not written to its end.

    Examples
    --------
    >>> cut_text(12, "0.2;1.")
    "the last line, 12, is left out: '0.2;1.' is no whole row, as where the instrument was stopped;\
 the rest is read"
    """
    return (
        f"the last line, {line}, is left out: {shown(text[:_SHOWN])} is no whole row, as where"
        " the instrument was stopped; the rest is read"
    )

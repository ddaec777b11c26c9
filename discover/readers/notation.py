"""Decimal marks told from thousands separators, column by column, by what the fields show."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field

from models.checks import InputError, shown

_MARKS = (".", ",")
_OTHER = {".": ",", ",": "."}
_MARKED = re.compile(r"[+-]?[\d.,]*\d[\d.,]*(?:[eE][+-]?\d+)?")
_WHOLE = re.compile(r"[+-]?\d+")
_SHAPE = str.maketrans("0123456789", "1" * 10)  # fields that look alike tell the same
_SURELY_DECIMAL = rb"[.,](?!\d{3}(?!\d))|(?<!\d)0[.,]|\d{4}[.,]"
_GROUP = rb"\d[.,]\d{3}"
_GROUPS = 3  # digits between thousands separators


@dataclass
class Evidence:
    """What the fields of one column show of the marks in them, each with a field as an example."""

    decimal: dict[str, str] = field(default_factory=dict)
    """Marks that part decimals, surely."""
    thousands: dict[str, str] = field(default_factory=dict)
    """Marks that part thousands, surely."""
    either: dict[str, str] = field(default_factory=dict)
    """Marks before exactly three digits: they may be either."""
    plain: str = ""
    """A field of at most three digits without any mark."""
    long: bool = False
    """Whether a field has more than three digits in a row: thousands are not parted."""

    def take(self, text: str) -> None:
        """Take in a field; one that is no number tells nothing."""
        present = [mark for mark in _MARKS if mark in text]
        if not present and _WHOLE.fullmatch(text):
            if len(text.lstrip("+-")) > _GROUPS:
                self.long = True
            else:
                self.plain = self.plain or text
        if not present or not _MARKED.fullmatch(text):
            return
        if len(present) == 2:
            last = max(_MARKS, key=text.rfind)
            self.decimal.setdefault(last, text)
            self.thousands.setdefault(_OTHER[last], text)
            return
        mark = present[0]
        whole, _, part = text.lstrip("+-").partition(mark)
        if mark in part:
            self.thousands.setdefault(mark, text)
        elif len(part) == _GROUPS and 1 <= len(whole) <= _GROUPS and whole[0] != "0":
            self.either.setdefault(mark, text)
        else:
            self.decimal.setdefault(mark, text)


@dataclass(frozen=True)
class Notation:
    """How a column writes numbers."""

    decimal: str
    """What parts decimals."""
    thousands: str = ""
    """What parts thousands, "" for nothing."""
    example: str = ""
    """A field with thousands, or one that may have some."""
    beside: str = ""
    """A field of the same column that leaves open what the mark in `example` parts; else ""."""


def notations(rows: Iterable[Sequence[str]]) -> Mapping[int, Notation]:
    """Return how each column of a table writes its numbers.

    A mark that stands twice in a number, or before another mark, parts thousands; one before any
    other than three digits parts decimals. One that is always before three digits parts thousands
    where the other columns part decimals by the other mark. Where they do not tell, and other
    fields of the column have no mark, as ``1,030`` beside ``345``, both readings are open.

    Parameters
    ----------
    rows : iterable of sequence of str
        Fields by column.

    Examples
    --------
    >>> found = notations([("0,5", "-1.030", "1.250,5"), ("10,25", "345", "0,1")])
    >>> [(n.decimal, n.thousands) for n in found.values()]
    [(',', ''), (',', '.'), (',', '.')]
    """
    seen: dict[int, Evidence] = {}
    met = set()
    for row in rows:
        for index, text in enumerate(row):
            shape = (index, text.translate(_SHAPE), text.lstrip(" +-")[:1] == "0")
            if shape not in met:  # a million fields have some tens of shapes
                met.add(shape)
                seen.setdefault(index, Evidence()).take(text.strip())
    shown = {mark for column in seen.values() for mark in column.decimal}
    return {index: _notation(column, shown) for index, column in sorted(seen.items())}


def _notation(column: Evidence, shown: set[str]) -> Notation:
    """Return a column's notation, with the marks that surely part decimals in any column."""
    decimals = set(column.decimal) | {_OTHER[mark] for mark in column.thousands}
    if not decimals and len(column.either) == 1:
        (mark,) = column.either
        decimals = shown if shown == {_OTHER[mark]} else {mark}
        if not shown and column.plain and not column.long:
            return Notation(_OTHER[mark], "", column.either[mark], column.plain)
    if len(decimals) != 1 or decimals & set(column.thousands):
        return Notation(".")  # whose other fields are for reading to complain of
    (decimal,) = decimals
    parted = {**column.either, **column.thousands}.get(_OTHER[decimal], "")
    return Notation(decimal, _OTHER[decimal] if parted else "", parted)


def check_told(notation: Notation, header: str, where: str) -> None:
    """Refuse a column whose numbers can be read in two ways.

    Raises
    ------
    InputError
        With a field of each kind.
    """
    if notation.beside:
        raise InputError(
            header, expected="written so that thousands can be told from decimals",
            found=f"{notation.example!r} beside {notation.beside!r}; save the file again without"
            " thousands separators, or with as many decimals everywhere",
            where=where,
        )  # fmt: skip


def thousands_note(header: str, notation: Notation) -> str:
    """Return what to tell of a column with thousands separators.

    Examples
    --------
    >>> thousands_note("Kraft [N]", Notation(",", ".", "-1.030"))
    "column 'Kraft [N]' has thousands separators: '-1.030' is read as -1030"
    """
    plain = notation.example.replace(notation.thousands, "").replace(notation.decimal, ".")
    return (
        f"column {shown(header)} has thousands separators: {notation.example!r} is read as"
        f" {float(plain):.12g}"
    )


def may_have_thousands(body: bytes | memoryview, delimiter: str) -> bool:
    r"""Return whether a text's samples may hold thousands separators, in a few looks at its bytes.

    Examples
    --------
    >>> may_have_thousands(b"0,5;1,25\n", ";"), may_have_thousands(b'0.5,"1,250.5"\n', ",")
    (False, True)
    >>> may_have_thousands(b"12;345\n13;1,030\n", ";")
    True
    """
    if delimiter == ",":
        return re.search(rb'"\s*[+-]?\d+,\d', body) is not None
    if re.search(rb"[.]", body) and re.search(rb",", body):
        return True
    if re.search(rb"\d([.,])\d{3}\1\d{3}", body):
        return True
    # Every number that has a mark has three digits after it, and some number has none.
    return not re.search(_SURELY_DECIMAL, body) and re.search(_GROUP, body) is not None

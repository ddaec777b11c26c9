"""Which lines of a text hold numbers, and which hold nothing: in one look at its bytes."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from models.checks import Indices

Truths = NDArray[np.bool_]
Bytes = NDArray[np.uint8]

_DIGITS = b"0123456789"
_NUMERIC = _DIGITS + b'+-.,;eE \t"\n'
_BLANK = b' \t,;\n"'
_BLOCK = 1 << 16  # bytes that are looked at together
_FEW = 5_000  # lines that are looked at one by one


def line_kinds(data: bytes, starts: Indices) -> tuple[Truths, Truths]:
    r"""Return which lines (N,) are made of numbers, and which have nothing but blanks.

    Most lines begin with a number and nothing in them is foreign to numbers: that takes no look
    at each of their bytes.

    Parameters
    ----------
    data : bytes
        With one kind of line end.
    starts : ndarray, shape (N + 1,)
        Where lines begin, then the end.

    Examples
    --------
    >>> numeric, blank = line_kinds(b"a,b\n1,-2\n,,\n", np.array([0, 4, 9, 12]))
    >>> numeric.tolist(), blank.tolist()
    ([False, True, False], [False, False, True])
    """
    codes = np.frombuffer(data, dtype=np.uint8)
    own = np.ones(starts.size - 1, dtype=bool)
    own[np.searchsorted(starts, _foreign(data, codes), side="right") - 1] = False
    begins, last = starts[:-1], codes.size - 1
    numeric = own & _is_digit(codes[begins])
    second = begins + 1  # after a sign
    numeric |= own & (second < starts[1:]) & _is_digit(codes[np.minimum(second, last)])
    blank = np.zeros_like(own)
    rest = np.flatnonzero(own & ~numeric)
    if rest.size > _FEW:
        numeric[rest] = np.logical_or.reduceat(_is_digit(codes), begins)[rest]
        rest = rest[~numeric[rest]]
    for row in rest:
        line = data[starts[row] : starts[row + 1]]
        numeric[row] = len(line.translate(None, _DIGITS)) < len(line)
        blank[row] = not line.translate(None, _BLANK)
    return numeric, blank


def _is_digit(codes: Bytes) -> Truths:
    return np.asarray((codes >= ord("0")) & (codes <= ord("9")))


def _foreign(data: bytes, codes: Bytes) -> Indices:
    """Return the places of bytes that stand in no number nor between numbers."""
    outside = np.ones(256, dtype=bool)
    outside[np.frombuffer(_NUMERIC, dtype=np.uint8)] = False
    found = [np.zeros(0, dtype=np.int_)]
    for first in range(0, len(data), _BLOCK):
        block = slice(first, first + _BLOCK)
        if data[block].translate(None, _NUMERIC):
            found.append(np.flatnonzero(outside[codes[block]]) + first)
    return np.concatenate(found)

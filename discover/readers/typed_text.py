"""Text in one encoding, with the signs that numbers have in programs."""

from __future__ import annotations

import re

from discover.readers.content import content_error

_HEAD = 2**12  # bytes that show the encoding
_MOST_ZEROS = 0.05  # of the bytes that are a character's own, in UTF-16 of Latin letters
_MINUS = "−".encode()  # a dash as word processors and spreadsheets write it before a number
# Swiss and French: an apostrophe, a typographic one, a narrow or a plain blank that does not break.
_MARKS = (b"'", b"\xe2\x80\x99", b"\xe2\x80\xaf", b"\xc2\xa0", b"\xa0")
_GROUP = re.compile(rb"(?<=\d)(?:" + b"|".join(_MARKS) + rb")(?=\d{3}(?!\d))", re.DOTALL)
_NUMBER = re.compile(rb"\d(?:[\d.,]|'|\xe2\x80\x99|\xe2\x80\xaf|\xc2\xa0|\xa0)*")
_LONGEST = 40  # characters of a number


def as_utf8(data: bytes, name: str) -> bytes:
    r"""Return text without a mark of its encoding, with one kind of line end and plain minus signs.

    UTF-16 shows without its mark too: every other byte is zero.

    Raises
    ------
    InputError
        Where it is UTF-16 and is damaged.

    Examples
    --------
    >>> as_utf8("t;F\r\n1;−2\r\n".encode("utf-16-le"), "a.csv")
    b't;F\n1;-2\n'
    """
    encoding = "utf-16" if data[:2] in (b"\xff\xfe", b"\xfe\xff") else _unmarked(data[:_HEAD])
    if encoding:
        try:
            data = data.decode(encoding).encode()
        except UnicodeDecodeError as error:
            raise content_error("text in utf-16", str(error.reason), name) from None
    data = data.removeprefix(b"\xef\xbb\xbf")
    if b"\r" in data:
        data = data.replace(b"\r\n", b"\n").replace(b"\r", b"\n")
    return data.replace(_MINUS, b"-") if _MINUS in data else data


def _unmarked(head: bytes) -> str:
    """Return which UTF-16 a text without a mark is in, "" for none."""
    low, high = head[0::2], head[1::2]
    for own, other, name in ((low, high, "utf-16-le"), (high, low, "utf-16-be")):
        if other and own.count(0) <= _MOST_ZEROS * len(own) and other.count(0) > 0.5 * len(other):
            return name
    return ""


def without_thousands(data: bytes) -> tuple[bytes, tuple[str, ...]]:
    """Return text without apostrophes and unbreakable blanks between thousands, and what to tell.

    Examples
    --------
    >>> without_thousands(b"0.5;6'050.25")
    (b'0.5;6050.25', ("thousands separators are taken out: 6'050.25 is read as 6050.25",))
    """
    # Looking for a mark is far faster than for one between digits.
    first = _GROUP.search(data) if any(mark in data for mark in _MARKS) else None
    if first is None:
        return data, ()
    line = data[data.rfind(b"\n", 0, first.start()) + 1 : first.end() + _LONGEST]
    written = next(m[0] for m in _NUMBER.finditer(line) if _GROUP.search(m[0]))
    plain = _GROUP.sub(b"", written).decode()
    text = written.decode("utf-8", "replace")
    told = f"thousands separators are taken out: {text} is read as {plain}"
    return _GROUP.sub(b"", data), (told,)

"""A look over a MATLAB 5 file before scipy reads it: a damaged one can crash scipy's C code."""

from __future__ import annotations

import math
import struct
import zlib
from dataclasses import dataclass

_MATRIX, _COMPRESSED = 14, 15  # data types of an element
# Bytes of a value, by its data type.
_SIZES = {1: 1, 2: 1, 3: 2, 4: 2, 5: 4, 6: 4, 7: 4, 9: 8, 12: 8, 13: 8, 16: 1, 17: 2, 18: 4}
_CELL, _STRUCT, _CHAR = 1, 2, 4  # classes of arrays
_NUMERIC = range(6, 16)  # classes of arrays of numbers
_DEEPEST = 16  # cells and structures in each other
_LARGEST = 2**31  # bytes that one variable unpacks to


@dataclass(frozen=True)
class _Element:
    kind: int
    """Data type of the format's table 1-1."""
    start: int
    """Where its data begin."""
    size: int
    """Bytes of data."""
    after: int
    """Where the next element begins."""


def damage(data: bytes) -> str:
    r"""Return what is wrong with a MATLAB 5 file, or an empty string.

    Every element must lie inside the one that holds it, be of a type that belongs there, and hold
    as many values as its dimensions say. Files of other versions pass unseen.

    Parameters
    ----------
    data : bytes
        The file.

    Returns
    -------
    str

    Notes
    -----
    MathWorks, *MAT-File Format*, chapter 1 (Level 5).

    Examples
    --------
    >>> damage(b"MATLAB 5.0 MAT-file".ljust(124) + b"\x00\x01IM" + b"\x0e\x00\x00\x00\xff")
    'an element cut off at byte 128'
    """
    order = {b"IM": "<", b"MI": ">"}.get(data[126:128])
    if order is None or len(data) < 128 or 1 not in data[124:126]:
        return ""
    try:
        position = 128
        while position < len(data):
            element = _element(data, position, len(data), order)
            if element.kind == _COMPRESSED:
                packed = data[element.start : element.start + element.size]
                inside = zlib.decompressobj().decompress(packed, _LARGEST)
                _check_matrix(inside, _element(inside, 0, len(inside), order), order, 0)
                position = element.start + element.size  # compressed elements aren't padded
            else:
                _check_matrix(data, element, order, 0)
                position = element.after
    except zlib.error as error:
        return f"a compressed element that can't be unpacked ({error})"
    except ValueError as error:
        return str(error)
    return ""


def _element(data: bytes, position: int, end: int, order: str) -> _Element:
    """Return the element at a position, or raise ValueError where it can't be one."""
    if position + 8 > end:
        raise ValueError(f"an element cut off at byte {position}")
    kind, size = struct.unpack_from(order + "II", data, position)
    start = position + 8
    if kind >> 16:  # small form: four bytes of data inside the tag
        kind, size, start = kind & 0xFFFF, kind >> 16, position + 4
        if size > 4:
            raise ValueError(f"an impossible size at byte {position}")
        return _Element(kind, start, size, position + 8)
    if start + size > end:
        raise ValueError(f"an element cut off at byte {position}")
    after = start + size + (-size % 8 if kind != _COMPRESSED else 0)
    return _Element(kind, start, size, min(after, end))


def _expect(element: _Element, kinds: tuple[int, ...], what: str) -> None:
    if element.kind not in kinds:
        raise ValueError(f"{what} of type {element.kind} at byte {element.start}")


def _check_matrix(data: bytes, element: _Element, order: str, depth: int) -> None:
    """Raise ValueError where a matrix element or anything inside it is damaged."""
    _expect(element, (_MATRIX,), "a variable")
    if depth > _DEEPEST:
        raise ValueError(f"structures more than {_DEEPEST} deep")
    if element.size == 0:  # an empty cell
        return
    end = element.start + element.size
    flags = _element(data, element.start, end, order)
    _expect(flags, (6,), "array flags")
    if flags.size != 8:
        raise ValueError(f"array flags of {flags.size} bytes at byte {flags.start}")
    (word,) = struct.unpack_from(order + "I", data, flags.start)
    kind, is_complex = word & 0xFF, bool(word & 0x800)
    if kind not in (_CELL, _STRUCT, _CHAR, *_NUMERIC):
        raise ValueError(
            f"a variable of class {kind} (a table, object, function or sparse matrix): "
            "save plain vectors"
        )
    shape = _element(data, flags.after, end, order)
    _expect(shape, (5,), "dimensions")
    if shape.size < 8 or shape.size % 4:
        raise ValueError(f"dimensions of {shape.size} bytes at byte {shape.start}")
    sides = struct.unpack_from(f"{order}{shape.size // 4}i", data, shape.start)
    count = math.prod(sides)
    if min(sides) < 0 or count > element.size:
        raise ValueError(f"more values than bytes at byte {shape.start}")
    name = _element(data, shape.after, end, order)
    _expect(name, (1, 2, 16), "a name")
    if kind in (_CELL, _STRUCT):
        _check_members(data, name.after, end, order, count, kind, depth)
        return
    position = name.after
    for _ in range(2 if is_complex else 1):
        values = _element(data, position, end, order)
        _expect(values, tuple(_SIZES), "values")
        if kind != _CHAR and (values.kind >= 16 or values.size != count * _SIZES[values.kind]):
            raise ValueError(f"values that don't fill the dimensions at byte {values.start}")
        position = values.after


def _check_members(
    data: bytes, position: int, end: int, order: str, count: int, kind: int, depth: int
) -> None:
    """Raise ValueError where a cell's or a structure's members are damaged."""
    members = count
    if kind == _STRUCT:
        length = _element(data, position, end, order)
        _expect(length, (5,), "a length of field names")
        if length.size != 4:
            raise ValueError(f"a length of {length.size} bytes at byte {length.start}")
        (width,) = struct.unpack_from(order + "i", data, length.start)
        names = _element(data, length.after, end, order)
        _expect(names, (1,), "field names")
        if not 0 < width <= 4096 or names.size % width:
            raise ValueError(f"field names that don't fit at byte {names.start}")
        members = count * (names.size // width)
        position = names.after
    for _ in range(members):
        member = _element(data, position, end, order)
        _check_matrix(data, member, order, depth + 1)
        position = member.after

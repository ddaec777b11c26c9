"""Rows of numbers above columns without names that are no samples, as rates and gains."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from discover.readers.numerals import value
from models.checks import Array

SHOWN_BY = 40
"""Samples that show where the time begins."""

_FEWEST = 16  # samples
_MOST = 5  # such rows
_UNEVEN = 3.0  # times the usual step, which no step of time reaches


def leading_numbers(first: Sequence[Sequence[str]], last: Sequence[str], count: int) -> int:
    """Return how many rows stand above the samples, though they are as wide.

    Time shows it: some column rises evenly from a row on to the end of the table, but not from
    the rows above that one on. Where no column is time, no row can be told from a sample.

    Parameters
    ----------
    first : sequence of sequence of str
        Fields of the first rows, up to `SHOWN_BY` and some.
    last : sequence of str
        Fields of the last row.
    count : int
        Number of rows.

    Examples
    --------
    >>> rows = [["500", "2.5"], *([f"{0.1 * i:.1f}", "7"] for i in range(30))]
    >>> leading_numbers(rows, rows[-1], len(rows)), leading_numbers(rows[1:], rows[-1], 30)
    (1, 0)
    """
    width = len(first[0]) if first else 0
    if any(len(row) != width for row in (*first, last)):
        return 0
    numbers = np.array([[_number(f) for f in row] for row in (*first, last)])
    for above in range(min(_MOST, len(first) - _FEWEST) + 1):
        shown = numbers[above : min(above + SHOWN_BY, len(first))]
        if any(_is_time(shown[:, i], numbers[-1, i], count - above) for i in range(width)):
            return above
    return 0


def _number(field: str) -> float:
    found = value(field, "," if "," in field and "." not in field else ".")
    return np.nan if found is None else found


def _is_time(begin: Array, end: float, count: int) -> bool:
    """Return whether values rise evenly, and go on so until the last of all."""
    with np.errstate(invalid="ignore"):
        steps = np.diff(begin)
    usual = float(np.median(steps))
    if not (steps.min() > 0.0 and steps.max() < _UNEVEN * usual):
        return False
    mean = (end - begin[0]) / (count - 1)
    return bool(usual / _UNEVEN < mean < usual * _UNEVEN)

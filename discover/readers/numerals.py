"""Numbers and times of day as instruments write them."""

from __future__ import annotations

import datetime
import re

EMPTY = ("", "nan", "na", "n/a", "null", "none", "-", "#n/a")
"""Fields that hold nothing, in lower case."""

_CLOCK = re.compile(
    r"(?:(\d{4})-(\d\d?)-(\d\d?)[ T]|(\d\d?)[./](\d\d?)[./](\d{4}) )?"
    r"(\d\d?):(\d\d):(\d\d(?:[.,]\d{1,9})?)Z?"
)
_FIRST_DAY = datetime.date(2000, 1, 1).toordinal()  # from which days are counted


def value(field: str, decimal: str) -> float | None:
    """Return a field's number, NaN of an empty one, None of text; a time of day is in seconds.

    Examples
    --------
    >>> value("1,5", ","), value("12:00:01.5", "."), value("on", ".")
    (1.5, 43201.5, None)
    """
    text = field.strip()
    if text.lower() in EMPTY:
        return float("nan")
    try:
        return float(text.replace(decimal, "."))
    except ValueError:
        return clock_seconds(text)


def clock_seconds(text: str) -> float | None:
    """Return the seconds since midnight, or since 2000 where there is a date; None of other text.

    Examples
    --------
    >>> clock_seconds("2000-01-02 00:00:00.25"), clock_seconds("2.1.2000 00:00:01")
    (86400.25, 86401.0)
    """
    match = _CLOCK.fullmatch(text)
    if match is None:
        return None
    year, month, day, own_day, own_month, own_year, hours, minutes, seconds = match.groups()
    days = 0
    try:
        if year:
            days = datetime.date(int(year), int(month), int(day)).toordinal() - _FIRST_DAY
        elif own_year:
            in_year = sorted((int(own_month), int(own_day)), key=lambda n: n > 12)
            date = datetime.date(int(own_year), *in_year)
            days = date.toordinal() - _FIRST_DAY
    except ValueError:  # a 13th month
        return None
    rest = 3600 * int(hours) + 60 * int(minutes) + float(seconds.replace(",", "."))
    return 86400 * days + rest

"""Numbers and times of day as instruments write them."""

from __future__ import annotations

import datetime
import re

import numpy as np

from models.checks import Array

EMPTY = ("", "nan", "na", "n/a", "null", "none", "-", "#n/a")
"""Fields that hold nothing, in lower case."""

_GROUPED = re.compile(
    r"[+-]?\d{1,3}(?:(?:\.\d{3})+(?:,\d*)?|(?:,\d{3})+(?:\.\d*)?)"
)  # with thousands separators
_CLOCK = re.compile(
    r"(?:(\d{4})-(\d\d?)-(\d\d?)[ T]|(\d\d?)[./](\d\d?)[./](\d{4}) )?"
    r"(\d\d?):(\d\d):(\d\d(?:[.,]\d{1,9}|:\d{3})?)(?:Z|([+-])(\d\d):?(\d\d)|\s?([AaPp])\.?[Mm]\.?)?"
)
_CLOCK_FORM = re.compile(
    r"(?:[ymd./-]+[ t])?h{1,2}:[mn]{1,2}:s{1,2}(?:[.,:]?[0fsmuz]{1,9})?(?: ?(?:tt|am/pm))?"
)
_DECIMAL = str.maketrans(",:", "..")  # milliseconds may follow another colon
DAY = 86400.0
"""s."""
_FIRST_DAY = datetime.date(2000, 1, 1).toordinal()  # from which days are counted


def value(field: str, decimal: str, thousands: str = "") -> float | None:
    """Return a field's number, NaN of an empty one, None of text; a time of day is in seconds.

    Examples
    --------
    >>> value("1,5", ","), value("12:00:01.5", "."), value("on", ".")
    (1.5, 43201.5, None)
    >>> value("-1.030,5", ",", "."), value("1.03,5", ",", ".")
    (-1030.5, None)
    """
    text = field.strip()
    if text.lower() in EMPTY:
        return float("nan")
    if thousands and thousands in text:
        if not _GROUPED.fullmatch(text):
            return None
        text = text.replace(thousands, "")
    try:
        return float(text.replace(decimal, "."))
    except ValueError:
        return clock_seconds(text)


def is_number(field: str) -> bool:
    """Return whether a field is a number or a time of day, whatever its marks.

    Examples
    --------
    >>> is_number("1,5"), is_number("1.030,25"), is_number("12:00:01"), is_number("1.2.3")
    (True, True, True, False)
    """
    try:
        float(field.replace(",", "."))
    except ValueError:
        return bool(_GROUPED.fullmatch(field)) or clock_seconds(field) is not None
    return True


def clock_seconds(text: str) -> float | None:
    """Return the seconds since midnight, or since 2000 where there is a date; None of other text.

    An offset from universal time, as ``+01:00``, is taken off where there is a date, so that a
    clock that is put back for winter goes on; without a date it is passed over.

    Examples
    --------
    >>> clock_seconds("2000-01-02 00:00:00.25"), clock_seconds("2.1.2000 00:00:01")
    (86400.25, 86401.0)
    >>> clock_seconds("12:00:01 AM"), clock_seconds("1:00:00.5 pm"), clock_seconds("00:00:01:250")
    (1.0, 46800.5, 1.25)
    >>> clock_seconds("2000-01-01 03:00:01+02:00"), clock_seconds("2000-01-01 02:00:01+01:00")
    (3601.0, 3601.0)
    """
    match = _CLOCK.fullmatch(text)
    if match is None:
        return None
    year, month, day, own_day, own_month, own_year, hours, minutes, seconds = match.groups()[:9]
    sign, off_hours, off_minutes, half = match.groups()[9:]
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
    hour = int(hours) if half is None else int(hours) % 12 + 12 * (half in "Pp")
    rest = 3600 * hour + 60 * int(minutes) + float(seconds.translate(_DECIMAL))
    if sign and (year or own_year):
        rest -= float(f"{sign}1") * (3600 * int(off_hours) + 60 * int(off_minutes))
    return 86400 * days + rest


def is_clock_form(text: str) -> bool:
    """Return whether a text says how times of day are written: no unit, but no other one's name.

    Examples
    --------
    >>> is_clock_form("hh:mm:ss"), is_clock_form("HH:MM:SS.fff"), is_clock_form("m:s")
    (True, True, False)
    """
    return _CLOCK_FORM.fullmatch(text.strip().lower()) is not None


def past_midnight(times: Array) -> Array:
    """Return times of day that go on where the clock passes midnight, s.

    Examples
    --------
    >>> past_midnight(np.array([86399.0, 86399.5, 0.0, 0.5])).tolist()
    [86399.0, 86399.5, 86400.0, 86400.5]
    """
    days = np.cumsum(np.diff(times, prepend=times[:1]) < -0.5 * DAY)
    return np.asarray(times + DAY * days, dtype=np.float64)

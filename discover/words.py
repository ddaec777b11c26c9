"""Numbers, units and names as a person reads them."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

THIN_SPACE = "\u202f"

_NAMES = {
    "inertia": "inertance",
    "quadratic-damping": "quadratic damping, v|v|",
    "power-law-damping": "power-law damping, |v|\u2060ᵖ",
    "coulomb-friction": "Coulomb friction, sign\u00a0v",
    "stribeck-friction": "Stribeck friction",
    "force-offset": "force offset",
    "time-delay": "delay between channels",
    "sensor-clipping": "force limit",
}

_PREFIXED = ("m", "m/s", "s")
_SMALL = ((1e-5, "µ", 1e6), (0.1, "m", 1e3))  # below which values are told in such parts

COORDINATES = {"dean": "Dean number", "speed": "speed amplitude", "frequency": "frequency"}
"""What bands lie on, in words."""
COORDINATE_UNITS = {"speed": " m/s", "frequency": " Hz"}
"""Of its values, with a space before; none of a Dean number."""


def term_name(identifier: str) -> str:
    """Return a term's id as words.

    Examples
    --------
    >>> term_name("viscous-damping"), term_name("inertia")
    ('viscous damping', 'inertance')
    """
    return _NAMES.get(identifier, identifier.replace("-", " "))


def short_name(identifier: str) -> str:
    """Return a term's id as words without its law, for lists.

    Examples
    --------
    >>> short_name("power-law-damping")
    'power-law damping'
    """
    return term_name(identifier).partition(",")[0]


def significant(value: float | None, digits: int = 4) -> str:
    """Return `value` to `digits` significant digits, without needless zeros; "–" for none.

    Examples
    --------
    >>> significant(371.249), significant(0.00021), significant(2.5e-7), significant(None)
    ('371.2', '0.00021', '2.5×10⁻⁷', '–')
    """
    if value is None or not math.isfinite(value):
        return "–"
    if value == 0.0:
        return "0"
    size = math.floor(math.log10(abs(value)))
    if size < -4 or size > 8:
        mantissa = f"{value / 10.0**size:.{digits - 1}f}".rstrip("0").rstrip(".")
        power = str(size).translate(str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"))
        return f"{mantissa}×10{power}".replace("-", "−")
    places = digits - 1 - size
    text = f"{round(value, places):,.{max(0, places)}f}".replace(",", THIN_SPACE)
    if "." in text:
        text = text.rstrip("0").rstrip(".")
    return text.replace("-", "−")


_RAISED = str.maketrans("-.0123456789", "⁻·⁰¹²³⁴⁵⁶⁷⁸⁹")


def raised(unit: str) -> str:
    """Return a unit with raised exponents, for pictures.

    Examples
    --------
    >>> raised("N s^2/m^2"), raised("kg")
    ('N s²/m²', 'kg')
    """
    return re.sub(r"\^(-?[\d.]+)", lambda found: found[1].translate(_RAISED), unit)


def percent(value: float | None) -> str:
    """Return a percentage to three digits at most.

    Examples
    --------
    >>> percent(2.2104).replace(THIN_SPACE, " "), percent(None)
    ('2.21 %', '–')
    """
    return "–" if value is None else f"{significant(value, 3)}{THIN_SPACE}%"


def remainder_text(remainder: Mapping[str, Any]) -> str:
    """Return what no term explains, with its interval.

    Examples
    --------
    >>> remainder_text({"value": 0.5, "interval": [0.3, 0.7]}).split()
    ['0.5', '%', '(0.3', 'to', '0.7', '%)']
    >>> remainder_text({"value": 0.0, "interval": [0.0, 0.0]})
    'none'
    """
    low, high = remainder["interval"]
    if not high:
        return "none"
    return f"{percent(remainder['value'])} ({significant(low, 3)} to {percent(high)})"


def left_over(amount: str, *, several: bool) -> str:
    """Return what no term explains as a sentence says it: over several records, each alike.

    Examples
    --------
    >>> left_over("0.3 %", several=True)
    'of the force, beyond noise, 0.3 %; every record counts alike'
    """
    return f"of the force, beyond noise, {amount}" + "; every record counts alike" * several


def probability(value: float | None) -> str:
    """Return a probability in percent that never rounds to a certainty it is not.

    Examples
    --------
    >>> [probability(p).replace(THIN_SPACE, " ") for p in (0.8123, 0.9999, 0.0004)]
    ['81 %', '> 99 %', '< 1 %']
    """
    if value is None:
        return "–"
    if value > 0.995:
        return f"> 99{THIN_SPACE}%"
    return f"< 1{THIN_SPACE}%" if value < 0.005 else f"{100.0 * value:.0f}{THIN_SPACE}%"


_MOST_DIGITS = 10
_MOST_NAMES = 4  # files, of which the same is said


def odds(nats: float) -> str:
    """Return a log Bayes factor as odds.

    Examples
    --------
    >>> [odds(n) for n in (0.0, 0.6, 3.0, 5.0, 400.0)]
    ['1 to 1', '1.8 to 1', '20 to 1', '150 to 1', 'over 1000 to 1']
    """
    most = math.log(1000.0)
    return "over 1000 to 1" if nats > most else f"{significant(math.exp(nats), 2)} to 1"


def interval(ends: Sequence[float | None] | None, digits: int = 3) -> str:
    """Return an interval in words, None for an end that is open; "" where there is none.

    Examples
    --------
    >>> interval([84.01, 117.3]), interval([84.01, None]), interval([None, None])
    ('84 to 117', 'at least 84', 'undetermined')

    Ends that would look alike have the digits that tell them apart.

    >>> interval([119.97, 120.03]), interval([2.0, 2.0])
    ('119.97 to 120.03', '2 to 2')
    """
    if not ends:
        return ""
    low, high = ends
    if low is None and high is None:
        return "undetermined"
    if low is None:
        return f"at most {significant(high, digits)}"
    if high is None:
        return f"at least {significant(low, digits)}"
    shown = [(significant(low, n), significant(high, n)) for n in range(digits, _MOST_DIGITS)]
    first, last = next((s for s in shown if s[0] != s[1]), shown[0])
    return f"{first} to {last}"


_KINDS = {"transient": "from rest", "trajectory": "sweep, random or other"}


def zero_possible(ends: Sequence[float | None] | None) -> bool:
    """Return whether an interval holds zero: the size is then not told from none.

    Examples
    --------
    >>> zero_possible([-0.01, 0.03]), zero_possible([0.01, None]), zero_possible(None)
    (True, False, False)
    """
    if not ends:
        return False
    low, high = ends
    return (low is None or low <= 0.0) and (high is None or high >= 0.0)


def in_parts(value: float | None, unit: str) -> tuple[str, float]:
    """Return the unit that an SI value reads well in, and what to multiply it by.

    Examples
    --------
    >>> in_parts(-0.0008, "s"), in_parts(0.0008, "N")
    (('ms', 1000.0), ('N', 1.0))
    """
    if unit not in _PREFIXED or not value:
        return unit, 1.0
    return next(((p + unit, f) for most, p, f in _SMALL if abs(value) < most), (unit, 1.0))


def quantity(
    value: float, unit: str, ends: Sequence[float | None] | None = None, digits: int = 3
) -> str:
    """Return an SI value with its unit and its interval, small ones in thousandths or less.

    Parameters
    ----------
    value : float
        In `unit`.
    unit : str
        SI unit; "1" or "" for a plain number.
    ends : sequence of float or None
        Of the interval, None where it is open; None where there is none.
    digits : int
        Significant ones.

    Examples
    --------
    >>> quantity(0.00226, "m/s", [0.0016, None]), quantity(8.6e-6, "m"), quantity(0.5, "s")
    ('2.26 mm/s (at least 1.6)', '8.6 µm', '0.5 s')
    >>> quantity(0.01, "1")
    '0.01'

    The value has the digits that show it within its interval.

    >>> quantity(9002.87, "N/m", [9001.4, 9004.2]).replace(THIN_SPACE, " ")
    '9 003 N/m (9 001 to 9 004)'
    """
    shown, factor = in_parts(value, unit)
    spread = [None if e is None else factor * e for e in ends] if ends else None
    text = significant(factor * value, _digits_within(factor * value, spread, digits))
    if shown not in ("", "1"):
        text += f" {shown}"
    return f"{text} ({interval(spread, digits)})" if spread else text


def _digits_within(value: float, ends: Sequence[float | None] | None, digits: int) -> int:
    """Return the number of significant digits, some at least, that keep a value in its interval."""
    low, high = ends or (None, None)
    for n in range(digits, _MOST_DIGITS):
        shown = float(f"{value:.{n - 1}e}")
        if (low is None or low <= shown) and (high is None or shown <= high):
            return n
    return digits


def listed(items: Iterable[str], last: str = "and") -> str:
    """Return items as a list in a sentence.

    Examples
    --------
    >>> listed(["a", "b", "c"])
    'a, b and c'
    """
    parts = list(items)
    if len(parts) < 2:
        return "".join(parts)
    return f"{', '.join(parts[:-1])} {last} {parts[-1]}"


def some_of(names: Sequence[str]) -> str:
    """Return the first names of many, and how many more there are.

    Examples
    --------
    >>> some_of(["a.csv", "b.csv"]), some_of([f"{i}.csv" for i in range(12)])
    ('a.csv, b.csv', '0.csv, 1.csv, 2.csv, 3.csv and 8 more')
    """
    most = len(names) if len(names) <= _MOST_NAMES + 1 else _MOST_NAMES
    more = f" and {len(names) - most} more" if most < len(names) else ""
    return ", ".join(names[:most]) + more


def model_names(given: Sequence[str]) -> list[str]:
    """Return models' names as pictures have room for: of a ``model.json`` that of its folder.

    Where two would be alike they stay as given.

    Examples
    --------
    >>> model_names(["foim", "inerter-out/discover-rig/model.json", "mine.json"])
    ['foim', 'discover-rig', 'mine']
    >>> model_names(["a/x/model.json", "b/x/model.json"])
    ['a/x/model.json', 'b/x/model.json']
    """
    short = []
    for name in given:
        *folders, file = name.replace("\\", "/").split("/")
        inside = file == "model.json" and folders
        short.append(folders[-1] if inside else file.removesuffix(".json"))
    return [s if short.count(s) == 1 else g for s, g in zip(short, given, strict=True)]


def kind_name(kind: str) -> str:
    """Return a record's kind in words.

    Examples
    --------
    >>> kind_name("sine"), kind_name("trajectory")
    ('sine', 'sweep, random or other')
    """
    return _KINDS.get(kind, kind)


def counted(number: int, noun: str) -> str:
    """Return a number with its noun.

    Examples
    --------
    >>> counted(1, "record"), counted(12, "record")
    ('1 record', '12 records')
    """
    return f"{number} {noun}{'' if number == 1 else 's'}"


def coordinate_name(document: Mapping[str, Any]) -> str:
    """Return the coordinate that bands lie on, a Dean number with its convention.

    Examples
    --------
    >>> coordinate_name({"coordinate": "dean", "dean_check": {"convention": "standard"}})
    'Dean number (standard convention)'
    """
    name = COORDINATES[str(document["coordinate"])]
    if document["coordinate"] == "dean":
        return f"{name} ({document['dean_check']['convention']} convention)"
    return name


def coordinate_value(value: float, coordinate: str) -> str:
    """Return a value of the coordinate with its unit.

    Examples
    --------
    >>> coordinate_value(98.02, "dean"), coordinate_value(0.1227, "speed")
    ('98', '0.123 m/s')
    """
    return significant(value, 3) + COORDINATE_UNITS.get(coordinate, "")


def band_range(band: Mapping[str, Any], coordinate: str) -> str:
    """Return where a band lies, in words.

    Examples
    --------
    >>> band_range({"lower": None, "upper": 98.0}, "dean")
    'below 98'
    >>> band_range({"lower": 0.775, "upper": 3.16}, "frequency")
    'from 0.775 Hz to 3.16 Hz'
    """
    lower, upper = band.get("lower"), band.get("upper")
    if lower is None and upper is None:
        return "everywhere"
    if lower is None and upper is not None:
        return f"below {coordinate_value(upper, coordinate)}"
    if lower is not None and upper is None:
        return f"above {coordinate_value(lower, coordinate)}"
    return (
        f"from {coordinate_value(float(lower or 0.0), coordinate)} to "
        f"{coordinate_value(float(upper or 0.0), coordinate)}"
    )


def spread(ends: Sequence[float]) -> str:
    """Return a range, or its one value where both ends read the same.

    Examples
    --------
    >>> spread([0.1, 15.0]), spread([0.306, 0.306])
    ('0.1 to 15', '0.306')
    """
    low, high = (significant(e, 3) for e in ends)
    return low if low == high else f"{low} to {high}"


def capitalize_first(text: str) -> str:
    """Return text with its first letter raised and the rest as it is.

    Examples
    --------
    >>> capitalize_first("iOIM and FOIM")
    'IOIM and FOIM'
    """
    return text[:1].upper() + text[1:]


def named_line(line: str) -> tuple[str, str]:
    """Return a line of an answer as its name and its sentence.

    Examples
    --------
    >>> named_line("Structure: one band")
    ('Structure', 'One band')
    """
    name, _, text = line.partition(": ")
    return name, capitalize_first(text)


def error_lines(document: Mapping[str, Any]) -> list[str]:
    """Return what is wrong with the data, which no answer can repair."""
    return _finding_lines(document, "error", "Error in the data")


def warning_lines(document: Mapping[str, Any]) -> list[str]:
    """Return what a reader of the answer has to know, for the terminal."""
    return _finding_lines(document, "warning", "Warning")


def _finding_lines(document: Mapping[str, Any], level: str, name: str) -> list[str]:
    return [
        f"{name}: {f['record'] + ': ' if f.get('record') else ''}{f['text']}"
        for f in document.get("findings", ())
        if f["level"] == level
    ]

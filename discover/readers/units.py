"""Units at the edge: everything a user writes is converted to SI here, by pint."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np
import pint

from models.checks import Array, InputError, number, shown

SI_UNITS = {
    "time": "s",
    "frequency": "Hz",
    "length": "m",
    "speed": "m/s",
    "acceleration": "m/s^2",
    "force": "N",
    "mass": "kg",
    "stiffness": "N/m",
    "density": "kg/m^3",
    "dynamic viscosity": "Pa*s",
    "pressure": "Pa",
    "temperature": "K",
}
"""Every kind of quantity that a campaign may hold, with its SI unit."""

ROTARY = (
    "of a rotary machine give N m as N and rad as m: "
    "then all results that say N, m and kg are in N m, rad and kg m^2"
)
"""What to do with torques and angles."""

SMALLEST, LARGEST = 1e-30, 1e30
"""In SI: beyond them a square is no number."""

_NUMBER = re.compile(r"\s*([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)(?![.\d])")
_TORQUE = re.compile(r"\b([kmM]?)N ?m\b")  # as it is mostly written
_OTHER = {
    "m^2/s": "kinematic viscosity",
    "m^2": "area",
    "N*m": "torque or energy",
    "V": "voltage",
    "A": "current",
    "N*s/m": "damping",
    "W": "power",
}
# A power only of a unit and of one digit: pint would else work on 9^9^9^9 for ever.
_UNIT = re.compile(
    r"(?!.*[\d.]\s*(?:\^|\*\*))(?!.*(?:\^|\*\*)\s*[+-]?\d\d)(?:[^\W\d]|[°%(]|1?\s*/)[\w\s*/^().+-]*"
)
_USUAL = {
    "time": "s ms us ns min",
    "length": "m mm cm um in ft",
    "speed": "m/s mm/s cm/s in/s ft/s",
    "acceleration": "m/s^2 m/s² mm/s^2 mm/s² in/s^2 ft/s^2",
    "force": "N kN mN MN lbf kgf kip",
    "temperature": "degC degF °C °F K",
}  # as laboratories write them, of which displays and printers may write the case otherwise
_ANGLES = ("radian", "degree", "revolution", "revolutions_per_minute", "revolutions_per_second")


# Kept: to read the file of all known units takes longer than to read a small campaign.
@lru_cache(maxsize=1)
def _registry() -> pint.UnitRegistry[Any]:
    return pint.UnitRegistry()


def _tidy(text: str) -> str:
    tidy = text.replace("·", "*").replace("⋅", "*").replace("−", "-").strip()
    return _TORQUE.sub(r"\1N*m", tidy)


@dataclass(frozen=True)
class _Conversion:
    """SI value = value * factor / divisor + offset; a divisor keeps 12 mm exactly 0.012 m."""

    factor: float
    divisor: float
    offset: float


# Kept: each record states the same few units, and each is a small number.
@lru_cache(maxsize=512)
def _conversion(text: str, kind: str) -> _Conversion:
    """Return how a unit of the right dimension converts, or raise ValueError with why not."""
    tidy = _tidy(text)
    match = None if tidy.startswith("1/") else _NUMBER.match(tidy)
    scale, name = (float(match.group(1)), tidy[match.end() :].strip()) if match else (1.0, tidy)
    if len(name) > 60 or not _UNIT.fullmatch(name):
        raise ValueError(f"{text!r}, which is not a unit")
    registry = _registry()
    unit = _parsed(name)
    target = SI_UNITS[kind]
    wanted = registry.parse_units(target).dimensionality
    if unit is None or unit.dimensionality != wanted:
        usual = [own for own in _USUAL.get(kind, "").split() if own.lower() == name.lower()]
        if len(usual) > 1:
            raise ValueError(f"{text!r}, which may be {' or '.join(usual)}")
        unit = _parsed(usual[0]) if usual else unit
    if unit is None:
        raise ValueError(f"{text!r}, which is not a known unit")
    if unit.dimensionality != wanted:
        raise ValueError(f"{text!r}, a unit of {_dimension(unit)}{_hint(unit, kind)}")
    if kind == "frequency" and any(key in unit._units for key in _ANGLES):
        turn = float(registry.Quantity(scale, unit).to("radian/second").magnitude)
        return _Conversion(turn / (2.0 * math.pi), 1.0, 0.0)
    zero = float(registry.Quantity(0.0, unit).to(target).magnitude)
    factor = (float(registry.Quantity(1.0, unit).to(target).magnitude) - zero) * scale
    if zero:
        return _Conversion(round(factor, 12), 1.0, zero)
    inverse = round(1.0 / factor) if 0.0 < factor < 1.0 else 0
    if inverse and math.isclose(inverse * factor, 1.0, rel_tol=1e-12):
        return _Conversion(1.0, float(inverse), 0.0)
    return _Conversion(factor, 1.0, 0.0)


def _hint(unit: Any, kind: str) -> str:
    """Return what may have been meant by a unit that does not measure `kind`, in brackets."""
    if kind == "acceleration" and str(unit) in ("gram", "gauss"):
        return " (standard gravity is g_0)"
    torque = unit.dimensionality == _registry().parse_units("N*m").dimensionality
    if (torque and kind == "force") or any(key in unit._units for key in _ANGLES):
        return f" ({ROTARY})"
    return ""


def _parsed(name: str) -> Any:
    """Return pint's unit of a name, written out with a capital too; None where there is none."""
    for written in (name, name.lower()) if len(name) > 2 and name.isalpha() else (name,):
        try:
            unit = _registry().parse_units(written)
            unit.dimensionality  # noqa: B018 - which looks every part of it up
        except Exception:  # pint's parser lets errors of many kinds through
            continue
        return unit
    return None


def _dimension(unit: Any) -> str:
    """Return what a unit measures, in words where it is a common kind."""
    names = [(name, kind) for kind, name in SI_UNITS.items()] + list(_OTHER.items())
    for name, kind in names:
        if unit.dimensionality == _registry().parse_units(name).dimensionality:
            return kind
    if unit.dimensionless:
        return "angle" if any(key in unit._units for key in _ANGLES) else "nothing (dimensionless)"
    return str(unit.dimensionality).replace("[", "").replace("]", "")


def check_unit(text: object, kind: str, *, name: str, where: str) -> str:
    """Return a unit as written if it measures `kind`, or raise `InputError`.

    Examples
    --------
    >>> check_unit("kN", "force", name="force", where="campaign.toml")
    'kN'
    """
    expected = f"in a unit of {kind} such as {SI_UNITS[kind]!r}"
    if not isinstance(text, str):
        raise InputError(name, expected=expected, found=shown(text), where=where)
    try:
        _conversion(text, kind)
    except ValueError as error:
        raise InputError(name, expected=expected, found=str(error), where=where) from None
    return text


def measures(text: str, kind: str) -> bool:
    """Return whether a text is a unit of a kind.

    Examples
    --------
    >>> measures("kN", "force"), measures("kN", "length"), measures("Force", "force")
    (True, False, False)
    >>> measures("KN", "force"), measures("MM", "length"), measures("mn", "force")
    (True, True, False)
    """
    try:
        _conversion(text, kind)
    except ValueError:
        return False
    return True


def same_unit(first: str, second: str, kind: str) -> bool:
    """Return whether two checked units are the same.

    Examples
    --------
    >>> same_unit("kN", "1e3 N", "force")
    True
    """
    probe = np.array([1.0, 2.0])
    return bool(np.allclose(to_si(probe, first, kind), to_si(probe, second, kind), rtol=1e-12))


def turns_sign(first: str, second: str, kind: str) -> bool:
    """Return whether a checked unit is another one with the sign turned.

    Examples
    --------
    >>> turns_sign("kN", "-1 kN", "force"), turns_sign("kN", "-1 N", "force")
    (True, False)
    """
    probe = np.array([1.0, 2.0])
    return bool(np.allclose(to_si(probe, first, kind), -to_si(probe, second, kind), rtol=1e-12))


def to_si(values: Array, unit: str, kind: str) -> Array:
    """Return values in SI from a unit that `check_unit` has passed.

    Parameters
    ----------
    values : ndarray
        As measured.
    unit : str
        Such as "mm", "kN" or "degC" (whose offset is applied).
    kind : str
        A key of `SI_UNITS`.

    Returns
    -------
    ndarray of the same shape, always new

    Examples
    --------
    >>> to_si(np.array([20.0]), "degC", "temperature").tolist()
    [293.15]
    """
    how = _conversion(unit, kind)
    return np.asarray(values * how.factor / how.divisor + how.offset, dtype=np.float64)


def quantity(value: object, kind: str, *, name: str, where: str) -> float:
    """Return a number with a unit, such as ``"27 mPa*s"``, in SI.

    Parameters
    ----------
    value : object
        As read from ``campaign.toml``: a string of a number and a unit.
    kind : str
        What it must measure: a key of `SI_UNITS`.
    name, where : str
        The key and its table, for messages.

    Raises
    ------
    InputError
        Where it is not a number with a unit, or measures something else.

    Examples
    --------
    >>> round(quantity("5 g_0", "acceleration", name="max_acceleration", where="[rig]"), 5)
    49.03325
    """
    expected = f'a number with a unit of {kind}, such as "1 {SI_UNITS[kind]}"'
    text = value if isinstance(value, str) else ""
    match = _NUMBER.match(_tidy(text))
    unit = _tidy(text)[match.end() :].strip() if match else ""
    if match is None or not unit:
        raise InputError(name, expected=expected, found=shown(value), where=where)
    try:
        _conversion(unit, kind)
    except ValueError as error:
        raise InputError(name, expected=expected, found=str(error), where=where) from None
    si = number(name, float(to_si(np.array([float(match.group(1))]), unit, kind)[0]), where=where)
    if si and not SMALLEST <= abs(si) <= LARGEST:
        raise InputError(
            name, expected=f"of a size from {SMALLEST:g} to {LARGEST:g} {SI_UNITS[kind]}",
            found=f"{si:.3g}", where=where,
        )  # fmt: skip
    return si


def weight_unit(text: str) -> str | None:
    """Return the force that one of a unit of mass weighs, as a unit; None of any other text.

    Examples
    --------
    >>> weight_unit("LBS"), weight_unit("kg"), weight_unit("N")
    ('lbs*g_0', 'kg*g_0', None)
    """
    written = [name for name in (text, text.lower()) if measures(f"{name}*g_0", "force")]
    return f"{written[0]}*g_0" if written and measures(text, "mass") else None


def is_unit(text: str) -> bool:
    """Return whether text is the name of a unit, of whatever kind.

    Examples
    --------
    >>> is_unit("kN"), is_unit("mm/s"), is_unit("Force"), is_unit("12 mm")
    (True, True, False, False)
    """
    tidy = _tidy(text)
    if len(tidy) > 20 or not _UNIT.fullmatch(tidy):
        return False
    usual = (own.lower() for units in _USUAL.values() for own in units.split())
    return _parsed(tidy) is not None or tidy.lower() in usual

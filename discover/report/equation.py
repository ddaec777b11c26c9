"""A model as an equation with its numbers, in MathML: one element a term, so that lines may break.

MathML Core, W3C: browsers draw it without any script or font of the page.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

from markupsafe import Markup, escape

from discover.shape_words import shape
from discover.words import percent, quantity, short_name, significant
from models.terms.between_tests import ONLY

Entry = Mapping[str, Any]

_X = Markup("<mi>x</mi>")
_V = Markup("<mi>v</mi>")
_A = Markup("<mi>a</mi>")
_CURVE = Markup("<mrow><mi>s</mi><mo>(</mo>{}<mo>,</mo>{}<mo>)</mo></mrow>").format(_X, _V)
_SPEED = Markup("<mrow><mo>|</mo>{}<mo>|</mo></mrow>").format(_V)
_SIGN = Markup("<mrow><mi>sgn</mi><mo>(</mo>{}<mo>)</mo></mrow>").format(_V)


def equation(terms: Sequence[Entry]) -> Markup:
    """Return the force as a sum of terms with their numbers, in SI.

    Displacement, velocity and acceleration are x, v and a; s is a curve of friction from -1 to 1.
    Terms of which each test has its own are one, by name.

    Parameters
    ----------
    terms : sequence of mapping
        As in a document: ``id``, ``coefficient``, shape parameters.

    Examples
    --------
    >>> str(equation([{"id": "stiffness", "coefficient": -20.0}])).count("<math>")
    2
    >>> own = [{"id": "force-offset", "coefficient": 3.0, "only": k} for k in (1.0, 2.0)]
    >>> str(equation(own)).count("force offset of each test")
    1
    """
    parts = [_math(Markup('<mi>F</mi><mo form="infix">=</mo>'))]
    changes = []
    own = dict.fromkeys(str(t["id"]) for t in terms if _of_one_test(t))
    for term in terms:
        if _of_one_test(term):
            continue
        if term["id"] in _CHANGES:
            changes.append(term)
            continue
        first = len(parts) == 1
        parts.append(_math(_signed(float(term["coefficient"]), first=first) + _factor(term)))
    for name in own:
        if name not in _CHANGES:
            sign = Markup('<mo form="infix">+</mo>' if len(parts) > 1 else "")
            parts.append(_math(sign + _each(name)))
    if len(parts) == 1:
        parts.append(_math(Markup("<mn>0</mn>")))
    said = [_CHANGES[c["id"]](float(c["coefficient"])) for c in changes]
    said += [f"{short_name(name)} of each test" for name in own if name in _CHANGES]
    text = Markup(", ").join(escape(s) for s in said)
    return Markup(" ").join(parts) + (Markup(", ") + text if said else Markup(""))


def symbols(terms: Sequence[Entry]) -> str:
    """Return what the letters of these terms' equations stand for.

    Parameters
    ----------
    terms : sequence of mapping
        As in a document, of all bands that are shown.

    Examples
    --------
    >>> symbols([{"id": "viscous-damping", "coefficient": 1.0}])
    'In SI units: x, v and a are displacement, velocity and acceleration.'
    """
    told = ["In SI units: x, v and a are displacement, velocity and acceleration."]
    ids = {str(t["id"]) for t in terms}
    if "fractional-derivative" in ids:
        told.append("D with a power is the fractional derivative of that order.")
    curved = any(t["id"] == "coulomb-friction" and _friction(t) == _CURVE for t in terms)
    if curved or "stribeck-friction" in ids:
        told.append("s(x, v) is the curve, from −1 to 1, by which friction reverses.")
    return " ".join(told)


def _of_one_test(term: Entry) -> bool:
    return float(term.get(ONLY.name, 0.0)) > 0.0


def _each(name: str) -> Markup:
    return Markup("<mtext>{} of each test</mtext>").format(short_name(name))


def _math(inside: Markup) -> Markup:
    return Markup("<math><mrow>{}</mrow></math>").format(inside)


def _signed(value: float, *, first: bool) -> Markup:
    sign = "−" if value < 0.0 else "" if first else "+"
    number = Markup('<mn>{}</mn><mspace width="0.17em"/>').format(significant(abs(value), 4))
    form = "prefix" if first else "infix"
    return (Markup('<mo form="{}">{}</mo>').format(form, sign) if sign else Markup("")) + number


def _power(base: Markup, exponent: object) -> Markup:
    return Markup("<msup>{}<mn>{}</mn></msup>").format(base, significant(float(str(exponent)), 3))


def _fractional(term: Entry) -> Markup:
    return _power(Markup("<mi>D</mi>"), term["order"]) + _X


def _power_law(term: Entry) -> Markup:
    return _power(_SPEED, term["exponent"]) + _SIGN


def _asymmetric(term: Entry) -> Markup:
    power = float(term.get("power", 1.0))
    size = _SPEED if power == 1.0 else _power(_SPEED, power)
    side = {1.0: " of v > 0", -1.0: " of v < 0"}.get(float(term.get("side", 0.0)), "")
    return size + (Markup("<mtext>{}</mtext>").format(side) if side else Markup(""))


def _stribeck(term: Entry) -> Markup:
    """Return the fall with speed, its number in it, times the friction's curve."""
    speed = significant(float(term["stribeck_velocity"]), 3)
    ratio = Markup("<mrow>{}<mo>/</mo><mn>{}</mn></mrow>").format(_V, speed)
    squared = Markup("<msup><mrow><mo>(</mo>{}<mo>)</mo></mrow><mn>2</mn></msup>").format(ratio)
    form = int(term.get("form", 0.0))
    if form == 2:
        below = Markup("<mrow><mn>1</mn><mo>+</mo>{}</mrow>").format(squared)
        return Markup("<mfrac>{}{}</mfrac>").format(_CURVE, below)
    power = Markup("<mrow><mo>|</mo>{}<mo>|</mo></mrow>").format(ratio) if form else squared
    fall = Markup("<mi>exp</mi><mo>(</mo><mo form='prefix'>−</mo>{}<mo>)</mo>").format(power)
    return fall + _CURVE


def _friction(term: Entry) -> Markup:
    return _CURVE if shape(term) or term.get("parts") else _SIGN


def _named(term: Entry) -> Markup:
    return Markup("<mtext> × {}</mtext>").format(short_name(str(term["id"])))


def _spring(power: int) -> Callable[[Entry], Markup]:
    """Return how a spring of a power is written; by name where it closes or levels off."""
    return lambda term: _named(term) if shape(term) else _power(_X, power)


_FACTORS: Mapping[str, Callable[[Entry], Markup]] = {
    "inertia": lambda _: _A,
    "viscous-damping": lambda _: _V,
    "quadratic-damping": lambda _: _SPEED + _V,
    "power-law-damping": _power_law,
    "fractional-derivative": _fractional,
    "coulomb-friction": _friction,
    "asymmetric-damping": _asymmetric,
    "stribeck-friction": _stribeck,
    "stiffness": lambda _: _X,
    "quadratic-stiffness": _spring(2),
    "cubic-stiffness": _spring(3),
    "force-offset": lambda _: Markup(""),
}
"""How a term is written after its coefficient; others by name."""


def _delayed(seconds: float) -> str:
    return f"read {quantity(abs(seconds), 's')} {'early' if seconds < 0.0 else 'late'}"


_CHANGES: Mapping[str, Callable[[float], str]] = {
    "time-delay": _delayed,
    "sensor-gain": lambda gain: f"read with a gain off by {percent(100.0 * gain)}",
    "series-compliance": lambda c: f"through a spring in series of {significant(c, 3)} m/N",
    "backlash": lambda _: "through a joint with play",
    "cavitation": lambda _: "limited in one direction by torn oil",
    "sensor-clipping": lambda _: "read by a channel that saturates",
}
"""What acts on the motion or on the whole force, and so is no summand."""


def _factor(term: Entry) -> Markup:
    return _FACTORS.get(str(term["id"]), _named)(term)

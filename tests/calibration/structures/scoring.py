"""An answer beside the truth: what a study document gets right."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from tests.calibration.structures.case import Case, Truth

Document = Mapping[str, Any]

NAMED = 0.5
"""Probability from which an extra counts as named."""
WITHIN = 1.5
"""Factor within which a remainder's size is right."""
_CORE_TERMS = (
    "inertia", "viscous-damping", "quadratic-damping", "power-law-damping", "fractional-derivative",
)
_FRICTION = ("coulomb-friction", "stribeck-friction", "hysteresis")
_SAME = {
    "skew": "time-delay", "delay": "time-delay", "offset": "force-offset", "gain": "sensor-gain",
}
_EDGE = 1e-6  # relative: a boundary is inside a bracket whose end was rounded


@dataclass(frozen=True)
class Outcome:
    """One campaign's answer, judged; None where a question isn't asked."""

    key: str
    """Of the case."""
    set: str
    """Of the case."""
    kind: str
    """Of device."""
    friction: str
    """Law."""
    twist: str
    """Of the plan."""
    effect: str
    """Hidden one, or ""."""
    seed: int
    """Of the case."""
    nats: float
    """By which the nearest rival misses the records."""
    seconds: float = 0.0
    """That the study took."""
    worked: float = 0.0
    """Processor time of that, s."""
    failure: str = ""
    """Error that ended it; everything asked is then wrong."""
    commit: str = ""
    """Of the code that answered."""
    bands: int = 0
    """Stated."""
    core_right: bool = False
    """Every stated band has its core; of a segmented device, and their number is right."""
    core_listed: bool = False
    """The same with the cores that are stated as not ruled out."""
    stated: float | None = None
    """Least of the bands' probabilities."""
    bands_right: bool = False
    """Their number."""
    brackets: tuple[bool, ...] = ()
    """Of each true boundary: a stated bracket holds it."""
    coordinate_right: bool | None = None
    """Asked of devices with boundaries whose records tell it."""
    gradual_right: bool | None = None
    """A gradual boundary is found as one: asked of devices that have one."""
    sharp_right: bool | None = None
    """No width is stated: asked of devices with sharp boundaries only."""
    orders: tuple[bool, ...] = ()
    """The interval holds the true order, of each band whose core is right."""
    exponents: tuple[bool, ...] = ()
    """Likewise for exponents that are free."""
    inertances: tuple[bool, ...] = ()
    """Likewise."""
    without_interval: int = 0
    """Orders stated without an interval."""
    error_ratio: float | None = None
    """Relative error over the true noise; None for moving records, compared within their band."""
    own_ratio: float | None = None
    """Relative error over the stated noise."""
    extra_right: bool | None = None
    """The hidden extra is named."""
    false_extras: tuple[str, ...] = ()
    """Named and not hidden."""
    remainder: float | None = None
    """Stated, over the true size; None where none is stated or nothing outside is hidden."""
    remainder_right: bool | None = None
    """Within the factor of either definition of its size; asked outside the catalogue."""
    remainder_covers: bool | None = None
    """Its interval holds either; asked where an interval is stated."""
    answer: str = ""
    """What was stated, in short."""


def score(
    case: Case, document: Document | None, *, seconds: float = 0.0, worked: float = 0.0,
    failure: str = "", commit: str = "",
) -> Outcome:
    """Return the outcome of a case.

    Parameters
    ----------
    case : Case
        What was asked.
    document : mapping, optional
        ``study.json``; None where the study failed.
    seconds, worked : float
        That the study took, and its processor time.
    failure : str
        The error that ended it.
    commit : str
        Of the code that answered.
    """
    truth = case.truth
    asked: dict[str, Any] = dict(
        key=case.key, set=case.set, kind=case.kind, friction=case.friction, twist=case.twist,
        effect=case.effect, seed=case.seed, nats=truth.nats, seconds=seconds, worked=worked,
        failure=failure, commit=commit, brackets=tuple(False for _ in truth.boundaries),
        coordinate_right=False if truth.boundaries and truth.coordinate_told else None,
        gradual_right=False if truth.gradual else None,
        sharp_right=False if truth.boundaries and not truth.gradual else None,
        extra_right=False if case.set == "one-extra" else None,
        remainder_right=False if case.set == "outside" else None,
    )
    if document is None:
        return Outcome(**asked)
    bands: Sequence[Mapping[str, Any]] = document["bands"]
    matched = [_true_band(band, truth) for band in bands]
    own = [_core(b) == truth.cores[k] for b, k in zip(bands, matched, strict=True)]
    listed = [
        right or truth.cores[k] in _listed(b)
        for b, k, right in zip(bands, matched, own, strict=True)
    ]
    number = len(bands) == len(truth.cores)
    in_place = number and matched == list(range(len(bands)))
    whole = in_place or len(truth.cores) == 1
    core_right = whole and all(own)
    asked |= dict(
        bands=len(bands),
        core_right=core_right,
        core_listed=whole and all(listed),
        stated=_stated(bands),
        bands_right=number,
        brackets=_brackets(document, truth),
        own_ratio=_own_ratio(document),
        answer=_answer(document),
        **_intervals(bands, truth, core_right=core_right, number=number),
    )
    if case.twist != "moving":
        asked["error_ratio"] = float(document["relative_error_percent"]) / truth.noise_percent
    if asked["coordinate_right"] is not None:
        asked["coordinate_right"] = (
            len(bands) > 1 and _coordinate(document) == truth.coordinate
        )
    widths = [b.get("width") for b in document.get("boundaries", ())]
    if truth.gradual:
        asked["gradual_right"] = any(widths) and any(asked["brackets"])
    elif truth.boundaries:
        asked["sharp_right"] = not any(widths)
    asked |= _effects(document, case, truth)
    return Outcome(**asked)


def _core(band: Mapping[str, Any]) -> str:
    return str(band.get("core") or band["structure"])


def _listed(band: Mapping[str, Any]) -> set[str]:
    return {str(e["structure"]) for e in band.get("equivalents", ())}


def _true_band(band: Mapping[str, Any], truth: Truth) -> int:
    """Return the true band that holds most of a stated band's records."""
    files = set(band["records"])
    shared = [len(files & set(own)) for own in truth.members]
    return shared.index(max(shared))


def _stated(bands: Sequence[Mapping[str, Any]]) -> float | None:
    found = [b["probability"] for b in bands if b.get("probability") is not None]
    return float(min(found)) if found else None


def _coordinate(document: Document) -> str:
    """Return the coordinate; a speed and a Dean number are the same but for a factor."""
    return "dean" if document["coordinate"] == "speed" else str(document["coordinate"])


def _brackets(document: Document, truth: Truth) -> tuple[bool, ...]:
    """Return, of each true boundary, whether a stated one of as many holds it.

    A bracket holds a boundary where its ends do, or where the bands beside it part the records
    exactly as the truth does: it is then the bracket of the same two records.
    """
    stated = document.get("boundaries", ())
    if len(stated) != len(truth.boundaries):
        return tuple(False for _ in truth.boundaries)
    kind = str(document["coordinate"])
    values = truth.boundaries
    if kind == "speed" and truth.coordinate == "dean":
        values = truth.speeds
    same = _coordinate(document) == truth.coordinate
    found = []
    below: set[str] = set()
    below_true: set[str] = set()
    for k, (boundary, value) in enumerate(zip(stated, values, strict=True)):
        below |= set(document["bands"][k]["records"])
        below_true |= set(truth.members[k])
        low, high = boundary.get("bracket") or (math.inf, -math.inf)
        inside = same and low * (1.0 - _EDGE) <= value <= high * (1.0 + _EDGE)
        found.append(bool(inside or below == below_true))
    return tuple(found)


def _intervals(
    bands: Sequence[Mapping[str, Any]], truth: Truth, *, core_right: bool, number: bool
) -> dict[str, Any]:
    """Return coverage of orders, exponents and inertances where the structure is right."""
    found: dict[str, list[bool]] = {"orders": [], "exponents": [], "inertances": []}
    absent = 0
    if core_right and number:
        wanted = (
            ("orders", "fractional-derivative", "order_interval", truth.orders),
            ("exponents", "power-law-damping", "exponent_interval", truth.exponents),
            ("inertances", "inertia", "interval", truth.inertances),
        )
        for name, identifier, key, values in wanted:
            for band, value in zip(bands, values, strict=True):
                ends = _ends(band, identifier, key)
                if value is None:
                    continue
                if ends is None:
                    absent += name == "orders"
                    continue
                found[name].append(ends[0] <= value <= ends[1])
    return {name: tuple(values) for name, values in found.items()} | {"without_interval": absent}


def _ends(band: Mapping[str, Any], identifier: str, key: str) -> tuple[float, float] | None:
    """Return an interval of a term; None where there is none or it is a fixed value."""
    for term in band["terms"]:
        if term["id"] == identifier and term.get(key) is not None:
            low, high = term[key]
            if low is not None and high is not None and low < high:
                return float(low), float(high)
    return None


def _own_ratio(document: Document) -> float | None:
    noises = [b.get("noise_percent") for b in document["bands"]]
    errors = [b.get("relative_error_percent") for b in document["bands"]]
    pairs = [(e, n) for e, n in zip(errors, noises, strict=True) if e is not None and n]
    if not pairs:
        return None
    return math.sqrt(sum(e * e for e, _ in pairs) / sum(n * n for _, n in pairs))


def named_extras(document: Document) -> set[str]:
    """Return ids named beside the cores: from `extras`, and else from terms beyond any core.

    Nuisances that the document states are named too.
    """
    found: set[str] = set()
    for band in document["bands"]:
        if band.get("extras") is not None:
            found |= {
                str(e["id"]) for e in band["extras"]
                if e.get("probability") is None or e["probability"] >= NAMED
            }
        else:
            found |= {str(t["id"]) for t in band["terms"]} - set(_CORE_TERMS)
    found |= {str(n["id"]) for n in document.get("nuisance", ())}
    return {_SAME.get(i, i) for i in found} - set(_FRICTION)


def _effects(document: Document, case: Case, truth: Truth) -> dict[str, Any]:
    named = named_extras(document)
    expected = {truth.extra} if case.set == "one-extra" else set()
    if case.twist == "even":
        expected |= {"force-offset", "asymmetric-damping"}
    result: dict[str, Any] = {"false_extras": tuple(sorted(named - expected))}
    if case.set == "one-extra":
        result["extra_right"] = truth.extra in named
    if case.set == "outside":
        result |= _remainder(document, truth)
    return result


def _remainder(document: Document, truth: Truth) -> dict[str, Any]:
    """Judge the stated remainder against either definition of its true size.

    Bands are put together by the number of their records.
    """
    square, count, ends = 0.0, 0, []
    for band in document["bands"]:
        stated = band.get("remainder_percent")
        if stated is None or stated.get("value") is None:
            return {"remainder_right": False}
        square += len(band["records"]) * float(stated["value"]) ** 2
        count += len(band["records"])
        if stated.get("interval") is not None:
            ends.append([float(e) for e in stated["interval"]])
    value = math.sqrt(square / count)
    sizes = [100.0 * s for s in truth.remainder]
    ratios = [value / s for s in sizes]
    result: dict[str, Any] = {
        "remainder": ratios[0],
        "remainder_right": any(1.0 / WITHIN <= r <= WITHIN for r in ratios),
    }
    if len(ends) == len(document["bands"]) == 1:
        result["remainder_covers"] = any(ends[0][0] <= s <= ends[0][1] for s in sizes)
    return result


def _answer(document: Document) -> str:
    words = [
        f"{_core(b)} ({b['probability']:.2f})" if b.get("probability") is not None else _core(b)
        for b in document["bands"]
    ]
    return f"{document['coordinate']}: {' | '.join(words)} + {sorted(named_extras(document))}"

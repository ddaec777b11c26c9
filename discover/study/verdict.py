"""A study's answer in plain sentences: what holds where, how well, how surely, what to do next."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from discover.friction_parts import whole_friction
from discover.shape_words import shape
from discover.study.extras_words import extras_line
from discover.words import (
    COORDINATE_UNITS,
    band_range,
    coordinate_name,
    coordinate_value,
    interval,
    left_over,
    listed,
    percent,
    probability,
    quantity,
    remainder_text,
    short_name,
    significant,
    zero_possible,
)
from models.cores import FRICTION, OTHER
from models.terms import TERMS
from models.terms.between_tests import ONLY

SURE = 0.8
"""Probability under which a structure is not stated: whoever acts on it is wrong once in five."""

MOST_LEFT = 0.5
"""Of the noise: where no term explains more than that, a structure is the best so far."""


def headline(document: Mapping[str, Any]) -> str:
    """Return the answer in one sentence: a structure a band, the boundary, the Dean verdict.

    Parameters
    ----------
    document : mapping
        The study as in ``study.json``.
    """
    bands = document["bands"]
    if not bands:
        return "no band could be formed from these records"
    names = [structure_name(b) for b in bands]
    besides = _effects_beside(bands[0])
    if len(bands) == 1:
        count = len(bands[0]["records"])
        fitted = document.get("held_out_relative_error_percent") is not None
        noun = "fitted record" if fitted else "record"  # there are others, held out
        where = f"{_ALL.get(count, f'all {count}')} {noun}{'s' * (count > 1)}"
        return f"{names[0]}{besides} in {where}{_dean_short(document)}{_so_far(document)}"
    coordinate = str(document["coordinate"])
    parts = [f"{n} {band_range(b, coordinate)}" for n, b in zip(names, bands, strict=True)]
    number = _NUMBERS.get(len(bands), str(len(bands)))
    ends = [i for b in document.get("boundaries", ()) if (i := interval(b.get("interval")))]
    where = f"{number} bands of {coordinate_name(document)}: {listed(parts)}"
    unit = COORDINATE_UNITS.get(coordinate, "")
    known = f" (boundary {listed(ends)}{unit})" if ends else ""
    return f"{where}{besides}{known}{_dean_short(document)}{_so_far(document)}"


def verdict_lines(document: Mapping[str, Any]) -> tuple[str, ...]:
    """Return the sentences that the terminal and the report lead with.

    Parameters
    ----------
    document : mapping
        The study as in ``study.json``.
    """
    lines = (
        f"Verdict: {headline(document)}.",
        values_line(document),
        extras_line(document),
        friction_line(document),
        accuracy_line(document),
        remainder_line(document),
        certainty_line(document),
        dean_line(document),
        next_line(document),
    )
    return tuple(line for line in lines if line)


_ALL = {1: "the one", 2: "both"}  # records that a band holds
_NUMBERS = {2: "two", 3: "three", 4: "four", 5: "five"}  # of bands, in words


def structure_name(band: Mapping[str, Any]) -> str:
    """Return a band's structure with the order that was found, or what it may be.

    Examples
    --------
    >>> open_band = {"structure": "FOIM", "probability": 0.6, "terms": [], "equivalents": [
    ...     {"structure": "FOIM", "probability": 0.6},
    ...     {"structure": "IOIM-linear", "probability": 0.4}]}
    >>> structure_name(open_band)
    'undetermined: FOIM or IOIM-linear'
    >>> structure_name({"structure": "other", "probability": 0.9, "terms": []})
    'none of the structures'
    """
    name = str(band["structure"])
    sure = band.get("probability")
    if sure is not None and sure < SURE:
        names = [str(e["structure"]) for e in band.get("equivalents", ())]
        return f"undetermined: {listed(names or [name], last='or')}"
    if name == OTHER and not band["terms"]:
        return "none of the structures"
    if name == OTHER:
        told = [t for t in band["terms"] if not zero_possible(t.get("interval"))]
        return f"other ({listed(_names(told or band['terms']))})"
    orders = [round(t["order"], 4) for t in band["terms"] if t.get("order") is not None]
    return f"{name} of order {listed(significant(o, 3) for o in orders)}" if orders else name


def _effects_beside(band: Mapping[str, Any]) -> str:
    """Return what the device surely has beside its structure, by name: the same in all bands."""
    names = _names(e for e in band.get("extras", ()) if not zero_possible(e["interval"]))
    friction = band.get("friction") or {}
    if "presliding_displacement" in friction and _is_told(_frictions(band)):
        names.insert(0, "presliding")
    return f", with {listed(names)}" if names else ""


def _frictions(band: Mapping[str, Any]) -> list[Mapping[str, Any]]:
    """Return a band's terms of friction: a curve may be several."""
    return [t for t in band["terms"] if t["id"] == FRICTION]


def _is_told(entries: Iterable[Mapping[str, Any]]) -> bool:
    """Tell whether one of some terms is surely not zero."""
    return any(not zero_possible(e.get("interval")) for e in entries)


def _names(entries: Iterable[Mapping[str, Any]]) -> list[str]:
    """Return the short names of terms, each once."""
    return list(dict.fromkeys(short_name(str(e["id"])) for e in entries))


def _dean_short(document: Mapping[str, Any]) -> str:
    check = document["dean_check"]
    verdict = check["verdict"]
    if verdict == "no-geometry":
        return ""
    if verdict == "no-boundary":
        return "; no boundary to test the Dean criterion on"
    said = {
        "consistent": "agrees with it", "contradicted": "contradicts it",
        "undetermined": "leaves it undetermined",
    }[verdict]
    return f"; Dean criterion {significant(check['criterion'], 3)}: the boundary {said}"


def _so_far(document: Mapping[str, Any]) -> str:
    """Return that something else is in the force, where no term explains much of it."""
    lefts = [
        b["remainder_percent"]["value"] for b in document["bands"]
        if b.get("remainder_percent") and b.get("noise_percent") is not None
        and b["remainder_percent"]["interval"][0] > MOST_LEFT * b["noise_percent"]
    ]
    return f"; the best so far, {percent(max(lefts))} of the force is unexplained" if lefts else ""


def values_line(document: Mapping[str, Any]) -> str:
    """Say the numbers of each band's structure, with intervals; "" where none has a term."""
    texts = []
    for number, band in enumerate(document["bands"], start=1):
        beside = {e["id"] for e in band.get("extras", ())}
        own = [_value(t) for t in band["terms"] if t["id"] not in beside and not _rubs(t)]
        place = [f"band {number}"] if len(document["bands"]) > 1 else []
        sure = band.get("probability")
        if sure is not None and sure < SURE:
            place.append(f"as {band['structure']}")
        if own:
            texts.append(": ".join(filter(None, (", ".join(place), listed(own)))))
    return f"Values: {'; '.join(texts)}." if texts else ""


def _rubs(term: Mapping[str, Any]) -> bool:
    """Tell whether a term is a part of friction's curve, which has a sentence of its own."""
    return term["id"] in TERMS and TERMS[term["id"]].curves is not None


def _value(term: Mapping[str, Any]) -> str:
    """Return a term's name, coefficient and shape."""
    size = quantity(term["coefficient"], term["unit"], term.get("interval"))
    return ", ".join(filter(None, (f"{short_name(str(term['id']))} {size}", shape(term))))


def friction_text(band: Mapping[str, Any]) -> str:
    """Return a band's friction in words: how much, how it reverses, how records differ.

    It is "" without friction: of none there is no way in which it reverses. Nor is any told of
    one that may be zero.
    """
    friction, own = band.get("friction"), _frictions(band)
    if not friction or not any(t["coefficient"] for t in own):
        return ""
    if not _is_told(own):
        highs = [t["interval"][1] for t in own]
        most = "" if None in highs else f", at most {significant(sum(highs), 3)} N"
        return f"not told from zero{most}"
    (whole,) = _frictions({"terms": whole_friction(own)})
    size = quantity(whole["coefficient"], whole.get("unit", "N"), whole.get("interval"))
    text = f"{size}, {friction['curve']}"
    if "presliding_displacement" in friction or "transition_speed" in friction:
        pair = ("a displacement", "a speed")
        over, other = pair if "presliding_displacement" in friction else pair[::-1]
        sure = friction["probability"]
        said = f"{over} and not {other}" if sure >= SURE else f"{over} rather than {other}"
        text += f": {said}, {probability(sure)}"
    if friction["differs_by_record"] >= _WORTH_SAYING:
        differs = percent(100.0 * friction["differs_by_record"])
        where = "between records" if len(band["records"]) > 1 else "along the record"
        text += f"; it differs {where} by {differs}"
    return text


_WORTH_SAYING = 0.001  # of the friction: less reads as 0.0 %


def friction_line(document: Mapping[str, Any]) -> str:
    """Say how friction reverses; "" without friction."""
    texts = list(dict.fromkeys(t for b in document["bands"] if (t := friction_text(b))))
    if len(texts) > 1:
        texts = [
            f"band {i}: {t}" for i, b in enumerate(document["bands"], start=1)
            if (t := friction_text(b))
        ]
    return f"Friction: {'; '.join(texts)}." if texts else ""


def accuracy_line(document: Mapping[str, Any]) -> str:
    """Say how much of the force the model misses, beside the noise."""
    text = f"Accuracy: the model misses {percent(document['relative_error_percent'])} of the force"
    floors = [b["noise_percent"] for b in document["bands"] if b.get("noise_percent") is not None]
    if floors:
        text += f" (noise {_range(floors)})"
    held_out = document.get("held_out_relative_error_percent")
    if held_out is not None:
        text += f", and {percent(held_out)} on records that were not fitted"
    own = document.get("held_out_with_own_values_percent")
    names = dict.fromkeys(
        short_name(e["id"]) for b in document["bands"] for e in b["extras"] if e.get(ONLY.name)
    )
    if own is not None and names:
        text += f" ({percent(own)} once a {listed(names)} of their own is fitted to them)"
    return text + "."


def _range(values: Sequence[float]) -> str:
    least, most = min(values), max(values)
    return percent(most) if most - least < 0.1 * most else f"{percent(least)} to {percent(most)}"


def remainder_line(document: Mapping[str, Any]) -> str:
    """Say how much of the force neither a term nor noise explains."""
    texts = [
        remainder_text(b["remainder_percent"])
        for b in document["bands"] if b.get("remainder_percent")
    ]
    if len(texts) > 1:
        texts = [f"{t} in band {i}" for i, t in enumerate(texts, start=1)]
    if not texts:
        return ""
    several = sum(len(b["records"]) for b in document["bands"]) > 1
    return f"Left over: {left_over(listed(texts), several=several)}."


def certainty_line(document: Mapping[str, Any]) -> str:
    """Say how sure the structures are and what can't be ruled out."""
    parts = []
    several = len(document["bands"]) > 1
    for number, band in enumerate(document["bands"], start=1):
        text = f"{band['structure']} {probability(band.get('probability'))}"
        others = [
            f"{e['structure']} ({probability(e['probability'])})" for e in not_ruled_out(band)
        ]
        if others:
            text += f", {listed(others)} not ruled out"
        parts.append(f"band {number}: {text}" if several else text)
    if not parts:
        return "Certainty: nothing to weigh."
    ending = "" if document.get("identifiable", True) else "; these records leave that open"
    return f"Certainty: {'; '.join(parts)}{ending}."


def not_ruled_out(band: Mapping[str, Any]) -> list[Mapping[str, Any]]:
    """Return a band's equivalents without its own structure."""
    return [e for e in band.get("equivalents", ()) if e["structure"] != band["structure"]]


_WHY = {
    "consistent": "the boundary lies at a constant Dean number that agrees with the criterion",
    "contradicted": "the boundary does not follow the criterion",
    "undetermined": "these records can't decide it",
    "no-boundary": "one structure holds throughout, so there is no boundary to check",
}


def dean_line(document: Mapping[str, Any]) -> str:
    """Say what the Dean check found, its convention named; "" where no fluid is known."""
    check = document["dean_check"]
    verdict = str(check["verdict"])
    if verdict == "no-geometry":
        return ""
    text = f"Dean check: {verdict.replace('-', ' ')}: {_WHY[verdict]}"
    boundary = check.get("boundary_dean")
    if boundary is not None:
        text += f"; boundary at De {significant(boundary, 3)}"
        spread = interval(check.get("interval"))
        if spread:
            text += f" ({spread})"
        text += (
            f", {check['convention']} convention, criterion {significant(check['criterion'], 3)}"
        )
    return text + "."


def next_line(document: Mapping[str, Any]) -> str:
    """Say which test to run next, or that none would tell structures apart."""
    test = document.get("next_test")
    if not test or test.get("frequency_hz") is None:
        if document.get("identifiable", True):
            left = " What is unexplained is in none of them." if _so_far(document) else ""
            return f"Next test: none; no pair of structures is left to tell apart.{left}"
        if any(f.get("about") == "unit" for f in document.get("findings", ())):
            return "Next test: none proposed while a unit is in doubt."
        return "Next test: none proposed."
    amplitude = significant(1e3 * test["amplitude_m"], 3)
    purpose = next_purpose(test)
    return (
        f"Next test: {significant(test['frequency_hz'], 3)} Hz at {amplitude} mm"
        + (f", which best {purpose}" if purpose else "")
        + "."
    )


def next_purpose(test: Mapping[str, Any]) -> str:
    """Say what the next test does best; "" where that is not said.

    Two bands of one structure are separated by their boundary alone.
    """
    separates = [str(s) for s in test.get("separates", ())]
    if len(set(separates)) == 1:
        return f"narrows the boundary between the bands of {separates[0]}"
    return f"tells {listed(separates, last='from')}" if separates else ""


def boundary_text(boundary: Mapping[str, Any], document: Mapping[str, Any]) -> str:
    """Return one boundary in words, in the study's coordinate."""
    coordinate = str(document["coordinate"])
    unit = COORDINATE_UNITS.get(coordinate, "")
    text = f"{coordinate_name(document)} {coordinate_value(boundary['coordinate'], coordinate)}"
    spread = interval(boundary.get("interval"))
    if spread:
        text += f" (interval {spread}{unit})"
    bracket = interval(boundary.get("bracket"))
    if bracket:
        text += f", between the records at {bracket}{unit}"
    width = boundary.get("width")
    if width:
        text += f"; a gradual change, over a factor of {significant(math.exp(width), 2)}"
    return text

"""A study's answer in five plain sentences: what, how well, how surely, Dean check, next test."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from discover.report.words import (
    band_range,
    capitalize_first,
    coordinate_name,
    coordinate_value,
    counted,
    interval,
    listed,
    percent,
    probability,
    significant,
)


def verdict_lines(document: Mapping[str, Any]) -> tuple[str, str, str, str, str]:
    """Return the five sentences that the terminal and the report lead with.

    Parameters
    ----------
    document : mapping
        The study as in ``study.json``.
    """
    return (
        structure_line(document),
        accuracy_line(document),
        certainty_line(document),
        dean_line(document),
        next_line(document),
    )


def error_lines(document: Mapping[str, Any]) -> list[str]:
    """Return what is wrong with the data, which a verdict can't repair."""
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


_NUMBERS = {2: "two", 3: "three", 4: "four", 5: "five"}


def structure_line(document: Mapping[str, Any]) -> str:
    """Say which structure holds where."""
    bands, coordinate = document["bands"], str(document["coordinate"])
    if not bands:
        return "Structure: no band could be formed from these records."
    if len(bands) == 1:
        count = len(bands[0]["records"])
        where = "the one record" if count == 1 else f"all {counted(count, 'record')}"
        return f"Structure: one band, {_structure(bands[0])} in {where}."
    parts = [f"{_structure(b)} {band_range(b, coordinate)}" for b in bands]
    number = _NUMBERS.get(len(bands), str(len(bands)))
    return f"Structure: {number} bands of {coordinate_name(document)}: {listed(parts)}."


def _structure(band: Mapping[str, Any]) -> str:
    """Return a band's structure with the order or exponent that was found."""
    name = str(band["structure"])
    if name == "other":
        name = f"other ({listed(str(t['id']) for t in band['terms'])})"
    orders = [t["order"] for t in band["terms"] if t.get("order") is not None]
    return f"{name} of order {listed(significant(o, 3) for o in orders)}" if orders else name


def accuracy_line(document: Mapping[str, Any]) -> str:
    """Say how much of the force the model misses, beside the noise."""
    text = f"Accuracy: the model misses {percent(document['relative_error_percent'])} of the force"
    floors = [b["noise_percent"] for b in document["bands"] if b.get("noise_percent") is not None]
    if floors:
        least, most = min(floors), max(floors)
        spread = (
            percent(most) if most - least < 0.1 * most else (f"{percent(least)} to {percent(most)}")
        )
        text += f" (noise floor {spread})"
    held_out = document.get("held_out_relative_error_percent")
    if held_out is not None:
        text += f", and {percent(held_out)} on records that were not fitted"
    return text + "."


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
    "no-geometry": "the campaign gives no device geometry, so there is no Dean number",
}


def dean_line(document: Mapping[str, Any]) -> str:
    """Say what the Dean check found, its convention named."""
    check = document["dean_check"]
    verdict = str(check["verdict"])
    text = f"Dean check: {verdict}: {_WHY.get(verdict, '')}"
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
    """Say which test to run next, or that none is needed."""
    test = document.get("next_test")
    if not test or test.get("frequency_hz") is None:
        if document.get("identifiable", True):
            return "Next test: none needed; no pair of structures is left to tell apart."
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
    text = f"{coordinate_name(document)} {coordinate_value(boundary['coordinate'], coordinate)}"
    spread = interval(boundary.get("interval"))
    if spread:
        text += f" (interval {spread})"
    bracket = interval(boundary.get("bracket"))
    if bracket:
        text += f", between the records at {bracket}"
    width = boundary.get("width")
    if width:
        text += f"; a gradual change, {significant(width, 2)} wide"
    return text


def named_line(line: str) -> tuple[str, str]:
    """Return a line of a verdict as its name and its sentence.

    Examples
    --------
    >>> named_line("Structure: one band")
    ('Structure', 'One band')
    """
    name, _, text = line.partition(": ")
    return name, capitalize_first(text)

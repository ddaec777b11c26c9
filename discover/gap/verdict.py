"""A gap search's answer in plain sentences: what is missing, what it explains, what remains."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from discover.words import (
    left_over,
    listed,
    percent,
    probability,
    remainder_text,
    short_name,
    significant,
    zero_possible,
)

CLOSED = 1.15
"""Times the noise floor, up to which a gap is closed: pooled, and where records count alike."""

_VERDICTS = {
    "agrees": "model and measurement agree within the noise; nothing is missing",
    "closed": "with {} added the gap{} is down to {}the noise",
    "reduced": "with {} added the gap{} is smaller, but more is left than noise",
    "unexplained": "something is missing that no effect in the catalogue explains",
}
_LINES_QUIET = "with {} added nothing more shows in the tests' own lines"
_AGREES_REFITTED = (
    "with the model's own coefficients refitted it meets the measurement within the noise;"
    " no term is missing"
)
_NOT_SHOWN = "nothing is missing that these tests would show"
_UNASKED = "something is missing that none of the effects asked for explains"
_FALLS = 0.995  # of a gap: what does not fall below it is not said to fall
_REFITTED = 1.01  # of a gap, from which the model's own coefficients are said to have closed some


def verdict_lines(document: Mapping[str, Any]) -> list[str]:
    """Return the answer in a few sentences, for the terminal and the head of the report.

    Parameters
    ----------
    document : mapping
        The search as in ``gap.json``.
    """
    verdict = str(document["verdict"])
    dropped = {name for r in document["rounds"] for name in r.get("dropped", ())}
    kept = [r for r in document["rounds"] if r["effect"] not in dropped]
    added = listed(short_name(str(r["effect"])) for r in kept)
    pooled = " over all tests" if len(document["records"]) > 1 else ""
    said = _said(document, verdict).format(added, pooled, _times(document))
    lines = [f"Verdict: {verdict}: {said}."]
    if kept:
        lines.append(f"Missing: {listed(_missing(r) for r in kept)}.")
        for number, entry in enumerate(document["rounds"], start=1):
            lines.append(f"Round {number}: {round_text(entry)}.")
    held_out = document.get("final_held_out_gap_percent")
    left = f"; {percent(held_out)} on records that were not fitted" if held_out is not None else ""
    noise = f"noise {percent(document['noise_percent'])}"
    lines.append(f"Gap: {_gaps(document)}{left}; {noise}{_worst(document['records'])}.")
    return [*lines, *_left_over(document)]


def _worst(records: Sequence[Mapping[str, Any]]) -> str:
    """Return the test that is farthest above its own noise, which pooling hides; "" for one."""
    over = {r["file"]: r["gap_after_percent"] / max(r["noise_percent"], 1e-300) for r in records}
    if len(over) < 2:
        return ""
    worst = max(over, key=lambda file: over[file])
    return f"; of single tests {worst} is worst, {significant(over[worst], 3)} times its noise"


def _over_noise(document: Mapping[str, Any]) -> float:
    return float(document["final_gap_percent"] / max(document["noise_percent"], 1e-300))


def _times(document: Mapping[str, Any]) -> str:
    """Return how many times the noise a gap is, before these words; "" where it is the noise."""
    over = significant(max(_over_noise(document), 1.0), 2)
    return "" if over == "1" else f"{over} times "


def _said(document: Mapping[str, Any], verdict: str) -> str:
    over = _over_noise(document)
    times = f"the gap is {significant(over, 2)} times the noise"
    if verdict == "closed" and over > CLOSED:
        return f"{_LINES_QUIET} ({times}; see the notes)"
    if verdict == "agrees" and over > CLOSED:
        return f"{_NOT_SHOWN} ({times}; see the notes)"
    said = _VERDICTS.get(verdict, "")
    if verdict == "agrees" and _begun(document) * _REFITTED <= document["gap_percent"]:
        return _AGREES_REFITTED
    if verdict == "unexplained":
        said = _UNASKED if document.get("effects") else said
        return f"{said} ({times})"
    return said


def _begun(document: Mapping[str, Any]) -> float:
    """Return the gap from which the rounds start: of the model with its coefficients refitted."""
    rounds = document["rounds"]
    return float(rounds[0]["gap_before_percent"] if rounds else document["final_gap_percent"])


def _gaps(document: Mapping[str, Any]) -> str:
    """Return the gap as the model was given, refitted, and with what was added."""
    given, final = document["gap_percent"], document["final_gap_percent"]
    rounds = document["rounds"]
    begun = _begun(document)
    parts = [f"{percent(given)} {'before' if begun * _REFITTED > given else 'as given'}"]
    if begun * _REFITTED <= given:
        parts.append(f"{percent(begun)} with the model's own coefficients refitted")
    if rounds:
        parts.append(f"{percent(final)} after")
    return ", ".join(parts)


def _missing(entry: Mapping[str, Any]) -> str:
    """Return a name with what it can't be told apart from."""
    same = [short_name(str(e)) for e in entry.get("not_distinguishable_from") or ()]
    apart = f" (or {listed(same, last='or')}: not told apart)" if same else ""
    size = " (its size is not told from zero)" if zero_possible(entry["interval"]) else ""
    return f"{short_name(str(entry['effect']))} {probability(entry['probability'])}{size}{apart}"


def round_text(entry: Mapping[str, Any]) -> str:
    """Return a round in words: the name, how surely, what it explains, whether its shape holds.

    Parameters
    ----------
    entry : mapping
        One of the document's ``rounds``.
    """
    text = f"{short_name(str(entry['effect']))} {probability(entry['probability'])}"
    if entry.get("dropped"):
        text += f" instead of {listed([short_name(str(e)) for e in entry['dropped']])}"
    others = [
        f"{short_name(str(a['effect']))} ({probability(a['probability'])})"
        for a in entry.get("alternatives", ())
        if a["effect"] != entry["effect"]
    ]
    if others:
        text += f", or {listed(others, last='or')}"
    gaps = f"{percent(entry['gap_before_percent'])} to {percent(entry['gap_after_percent'])}"
    share = f"explains {percent(round(entry['share_percent']))} of what was more than noise"
    shape = "its shape holds" if entry["shape_adequate"] else "its formula leaves more than noise"
    return f"{text}; {share}, gap {gaps}{_alike(entry)}; {shape}{_unseen(entry)}"


def _unseen(entry: Mapping[str, Any]) -> str:
    """Return whether records that were not fitted are predicted better."""
    better = entry.get("held_out_better")
    if better is None:
        return ""
    gaps = [entry[f"held_out_{at}_percent"] for at in ("before", "after")]
    how = "better" if better else "no better"
    return f"; records not fitted are met {how} ({percent(gaps[0])} to {percent(gaps[1])})"


def _alike(entry: Mapping[str, Any]) -> str:
    """Return what a round gains with every record counting alike, where the pooled gap hides it."""
    if entry["gap_after_percent"] <= _FALLS * entry["gap_before_percent"]:
        return ""
    before, after = (entry[f"rms_record_gap_{at}_percent"] for at in ("before", "after"))
    return f" pooled, {percent(before)} to {percent(after)} with every record counting alike"


def _left_over(document: Mapping[str, Any]) -> list[str]:
    """Return what no term explains: how much, and of what shape where that is told."""
    lines = []
    remainder = document.get("remainder_percent")
    if remainder:
        several = len(document["records"]) > 1
        lines.append(f"Left over: {left_over(remainder_text(remainder), several=several)}.")
    if document.get("shape"):
        lines.append(f"Its shape: {document['shape']}.")
    return lines

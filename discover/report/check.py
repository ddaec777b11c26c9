"""A check of the data: lines for the terminal, and its report with the plan in pictures."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Mapping, Sequence
from typing import Any

from markupsafe import Markup

from discover.data_check import TELLING
from discover.figure_data import PlanFigureData
from discover.plots.plan_map import plan_map
from discover.plots.separation_matrix import nats_text, separation_matrix
from discover.report.environment import render
from discover.words import (
    counted,
    kind_name,
    listed,
    named_line,
    odds,
    percent,
    significant,
    some_of,
)


def check_lines(document: Mapping[str, Any], *, campaign: str) -> list[str]:
    """Return what a person should know: records, noise, findings, what can't be told apart.

    Parameters
    ----------
    document : mapping
        The check as in ``check.json``.
    campaign : str
        The campaign's folder as a command takes it.
    """
    lines = [_records_line(document)]
    lines += _found_lines(document["findings"])
    lines += _plan_lines(document)
    lines.append(f"Next: {next_step(document, campaign=campaign)}")
    lines.append("Check: passed." if document["passed"] else "Check: failed.")
    return lines


def _found_lines(findings: Sequence[Mapping[str, Any]]) -> list[str]:
    """Return what was found, once for all records of which it is said."""
    files: dict[tuple[str, str], list[str]] = {}
    for finding in findings:
        own = files.setdefault((str(finding["level"]), str(finding["text"])), [])
        own += [str(finding["record"])] if finding.get("record") else []
    return [
        f"{level.capitalize()}: {some_of(own) + ': ' if own else ''}{text}"
        for (level, text), own in files.items()
    ]


def check_figures(document: Mapping[str, Any], data: PlanFigureData) -> dict[str, str]:
    """Return the check's pictures by name, each one ``<svg>`` element.

    Parameters
    ----------
    document : mapping
        The check as in ``check.json``.
    data : PlanFigureData
        What the pictures need besides.
    """
    drawn = {"plan": plan_map(data), "separation": separation_matrix(document)}
    return {name: svg for name, svg in drawn.items() if svg is not None}


def check_report(
    document: Mapping[str, Any],
    data: PlanFigureData,
    figures: Mapping[str, str],
    *,
    campaign: str,
    command: str,
) -> str:
    """Return ``report.html`` of a check: self-contained, the answer first.

    Parameters
    ----------
    document : mapping
        The check as in ``check.json``.
    data : PlanFigureData
        What the map's caption says.
    figures : mapping
        From `check_figures`.
    campaign : str
        The campaign's folder as a command takes it.
    command : str
        What a person types to repeat it.
    """
    lines = [_passed_line(document), *_plan_lines(document), _records_line(document)]
    return render(
        "check.html",
        command=command,
        document_name="check.json",
        document=document,
        verdict=[named_line(line) for line in lines],
        figures={name: Markup(figures.get(name, "")) for name in ("plan", "separation")},
        plan_caption=_plan_caption(data),
        telling=TELLING,
        pairs=[{**p, "gap": nats_text(float(p["gap_nats"]))} for p in document["pairs"]],
        next_step=next_step(document, campaign=campaign),
    )


def next_step(document: Mapping[str, Any], *, campaign: str) -> str:
    """Return what to do after a check, commands between backticks.

    Parameters
    ----------
    document : mapping
        The check as in ``check.json``.
    campaign : str
        The campaign's folder as a command takes it.
    """
    again = f"`inerter check {campaign}`"
    study = f"`inerter discover {campaign}`"
    if not document["passed"]:
        return f"mend what is in error, then run {again} again."
    if any(f.get("about") == "unit" for f in document["findings"]):
        return (
            f"see whether the unit in question is right; once it is, run {again} again. {study}"
            " works as it is, with sizes as read."
        )
    if not document["inseparable"]:
        return f"{study} finds which structure the records support."
    as_it_is = f"{study} works as it is, and leaves such pairs open."
    test = document["added_test"]
    if test is None:
        widest = min(document["inseparable"], key=lambda pair: float(pair["gap"]))
        pair = listed(widest["structures"], last="from")
        return (
            f"no sine test within the limits of the tests so far tells {pair}; wider limits can be"
            f" given in [rig] of campaign.toml{_noise_needed(float(widest['gap']))}. {as_it_is}"
        )
    nats = float(test["gap_nats"])
    place = (
        f"add a test at {significant(test['frequency_hz'], 2)} Hz and"
        f" {significant(1e3 * test['amplitude_m'], 2)} mm"
    )
    pair = listed(test["structures"], last="from")
    if nats < TELLING:
        return (
            f"{place}, the best one more within limits; {pair} would then be told with odds of"
            f" {odds(nats)} only{_noise_needed(nats)}. {as_it_is}"
        )
    return (
        f"{place}: what can't be told apart now would then be told with odds of {odds(nats)} at"
        f" least, and {odds(TELLING)} are needed. Then run {again} again. {as_it_is}"
    )


def _noise_needed(nats: float) -> str:
    """Return how much less noise would do; "" where no such noise is in reach."""
    if nats < 0.01 * TELLING:
        return ""
    return f", and noise {significant(math.sqrt(TELLING / nats), 2)} times lower would do"


def _records_line(document: Mapping[str, Any]) -> str:
    records = document["records"]
    kinds = Counter(str(r["kind"]) for r in records)
    noise = [r["force_noise_percent"] for r in records if r["force_noise_percent"] is not None]
    kind_text = "; ".join(f"{n} {kind_name(kind)}" for kind, n in kinds.items())
    return f"Records: {counted(len(records), 'record')} ({kind_text})" + (
        f"; force noise {_spread(noise)} of the force." if noise else "."
    )


def _passed_line(document: Mapping[str, Any]) -> str:
    levels = Counter(str(f["level"]) for f in document["findings"])
    found = [counted(levels[level], level) for level in ("error", "warning") if levels[level]]
    word = "passed" if document["passed"] else "failed"
    return f"Check: {word}: {listed(found) or 'neither an error nor a warning'}."


def _plan_lines(document: Mapping[str, Any]) -> list[str]:
    """Return what the plan can't see of a structure, and what it can't tell apart."""
    if not document["pairs"]:
        return ["Plan: no record may be fitted, so nothing can be told apart."]
    lines = [
        f"Can't be determined: of {s['name']}'s {s['columns']} parameters these tests see"
        f" {s['rank']} combinations at their noise."
        for s in document["structures"]
        if s["rank"] < s["columns"]
    ]
    lines += [f"Can't be told apart: {why}." for why in _reasons(document["inseparable"])]
    if document["passed"] and not document["inseparable"]:
        lines.append("Plan: these tests can tell the four structures apart at their noise.")
    return lines


def _reasons(inseparable: Sequence[Mapping[str, Any]]) -> list[str]:
    """Return why pairs can't be told apart, those with one reason in one sentence."""
    pairs: dict[str, list[str]] = {}
    for entry in inseparable:
        pair = " and ".join(entry["structures"])
        before, _, after = str(entry["why"]).partition(pair)
        pairs.setdefault(f"{before}{{}}{after}", []).append(pair)
    return [reason.replace("{}", ", ".join(named)) for reason, named in pairs.items()]


def _plan_caption(data: PlanFigureData) -> str:
    windows = any(t.kind != "sine" for t in data.tests)
    text = "Each mark is one sine test"
    if windows:
        text += ", or one window of a record that is none, at its mean frequency and amplitude"
    named = "" if windows else ", and the number under it where there is room,"
    text += f"; its colour{named} is the force's noise over the force."
    if any(t.held_out for t in data.tests):
        text += " Hollow marks are never fitted."
    if data.dean_per_speed_paper:
        text += " On a falling line the Dean number is 100 by the convention that it names."
    return text


def _spread(noise: Sequence[float]) -> str:
    low, high = percent(min(noise)), percent(max(noise))
    return low if low == high else f"{low} to {high}"

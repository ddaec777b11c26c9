"""A drafted campaign: its document, lines for the terminal, and the page with its records."""

from __future__ import annotations

import shlex
from collections.abc import Mapping, Sequence
from typing import Any

from markupsafe import Markup

from discover.header import document_header
from discover.plots.record_view import record_view
from discover.readers import Draft
from discover.readers.guess import listed
from discover.report.environment import render
from discover.words import capitalize_first, counted, named_line, some_of
from models.checks import printable


def draft_document(draft: Draft, *, content_hash: str, written: str) -> dict[str, Any]:
    """Return ``init.json``.

    Parameters
    ----------
    draft : Draft
        From `discover.readers.draft_campaign`.
    content_hash : str
        Of the campaign that was written.
    written : str
        Path of its ``campaign.toml``.
    """
    return {
        **document_header("init", seed=0, title=draft.title, content_hash=content_hash),
        "written": written,
        "columns": dict(draft.columns),
        "units": dict(draft.units),
        "records": [
            {
                "file": r.record.file,
                "held_out": r.entry.held_out,
                "samples": r.record.samples,
                "sampling_hz": 1.0 / r.record.step,
                "columns": {
                    quantity: {
                        "header": g.header, "unit": g.unit, "unit_stated": g.unit_stated,
                        "sure": g.sure, "why": g.why,
                    }
                    for quantity, g in r.guess.columns.items()
                },
                "findings": [f.to_dict() for f in r.findings],
            }
            for r in draft.records
        ],
        "left_out": [{"file": file, "why": why} for file, why in draft.left_out],
        "doubts": [
            {"what": f"{d.key}.{d.quantity}", "taken": d.taken, "choices": list(d.choices),
             "why": d.why}
            for d in draft.doubts
        ],
    }  # fmt: skip


def draft_lines(draft: Draft, *, written: str, campaign: str, command: str) -> list[str]:
    """Return what a person should know of a drafted campaign, the next command last.

    Parameters
    ----------
    draft : Draft
        As written.
    written : str
        Path of ``campaign.toml``.
    campaign : str
        The folder as a command takes it.
    command : str
        What a person types to draft it again.
    """
    held = sum(r.entry.held_out for r in draft.records)
    lines = [
        f"Campaign: {counted(len(draft.records), 'record')}, {held} of them held out, in {written}"
    ]
    lines += [f"Columns: {text}" for text in _guessed(draft)]
    lines += [f"Stepped sine: {text}" for text in _stepped(draft)]
    lines += [f"Left out: {text}" for text in _left_out(draft)]
    for doubt in draft.doubts:
        option = "--column" if doubt.key == "columns" else "--unit"
        other = next(iter(doubt.choices[1:]), doubt.taken)
        answer = shlex.quote(f"{doubt.quantity}={printable(other)}")
        lines.append(
            f"Unsure: the {doubt.key.removesuffix('s')} of {doubt.quantity},"
            f" {printable(doubt.taken)} ({doubt.why}); correct it in campaign.toml, or with"
            f" `{command} {option} {answer}`"
        )
    lines.append(f"Next: inerter check {campaign}")
    return lines


def _left_out(draft: Draft) -> list[str]:
    """Return the files that are no record with why, a reason once."""
    files: dict[str, list[str]] = {}
    for file, why in draft.left_out:
        files.setdefault(why, []).append(printable(file))
    return [f"{some_of(own)}: {printable(why)}" for why, own in files.items()]


def _stepped(draft: Draft) -> list[str]:
    """Return how many sine tests were found in how many files or parts of them."""
    own = [(r.entry.file, r.entry.part) for r in draft.records if r.entry.span_text]
    if not own:
        return []
    whole = counted(len(set(own)), "record")
    return [f"{whole} of several steps, {counted(len(own), 'sine test')} in all, a range each"]


def _guessed(draft: Draft) -> list[str]:
    """Return what columns are taken for, each reading once."""
    texts: dict[str, int] = {}
    for record in draft.records:
        for text in listed(record.guess):
            texts[text] = texts.get(text, 0) + 1
    return [
        text + ("" if count == len(draft.records) else f" in {counted(count, 'record')}")
        for text, count in texts.items()
    ]


def draft_figures(draft: Draft) -> dict[str, str]:
    """Return a picture of every record by name, each one ``<svg>`` element."""
    return {
        f"record-{number}": record_view(r.record, name=f"record-{number}")
        for number, r in enumerate(draft.records, start=1)
    }


def draft_report(
    draft: Draft,
    document: Mapping[str, Any],
    figures: Mapping[str, str],
    *,
    lines: Sequence[str],
    command: str,
) -> str:
    """Return ``report.html`` of a drafted campaign: self-contained.

    Parameters
    ----------
    draft : Draft
        As written.
    document : mapping
        From `draft_document`.
    figures : mapping
        From `draft_figures`.
    lines : sequence of str
        From `draft_lines`.
    command : str
        What a person types to repeat it.
    """
    return render(
        "init.html",
        command=command,
        document_name="init.json",
        document=document,
        verdict=[named_line(lines[0]), ("Next", f"`{lines[-1].removeprefix('Next: ')}`")],
        told=[capitalize_first(line.removeprefix("Columns: ")) for line in lines[1:-1]],
        toml=draft.toml(),
        figures=[Markup(svg) for svg in figures.values()],
    )

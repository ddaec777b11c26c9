"""What only the user can know of records, asked for on a terminal."""

from __future__ import annotations

import sys
from dataclasses import replace

import typer

from discover.readers.doubts import Doubt
from discover.readers.draft import Draft
from discover.readers.draft_tables import Answers
from discover.readers.units import quantity
from models.checks import InputError, number, printable
from models.device import PRESETS


def at_terminal() -> bool:
    """Return whether somebody is there to ask."""
    return sys.stdin.isatty() and sys.stderr.isatty()


def rate(text: str) -> float:
    """Return a sampling rate, Hz; a bare number is in Hz.

    Examples
    --------
    >>> rate("1 kHz"), rate("200")
    (1000.0, 200.0)
    """
    try:
        return number("rate", float(text), above=0.0, where="--sampling-rate")
    except InputError:
        raise
    except ValueError:
        si = quantity(text, "frequency", name="rate", where="--sampling-rate")
        return number("rate", si, above=0.0, where="--sampling-rate")


def ask(draft: Draft, answers: Answers, device: str | None) -> tuple[Answers, str]:
    """Return the answers with what the user says of everything unsure, and the device's preset.

    Parameters
    ----------
    draft : Draft
        Whose doubts are asked about.
    answers : Answers
        As far as they are known.
    device : str or None
        A preset; None to ask.
    """
    columns, units = dict(answers.columns), dict(answers.units)
    for doubt in draft.doubts:
        chosen = _choice(doubt)
        (columns if doubt.key == "columns" else units)[doubt.quantity] = chosen
    preset = device
    while preset is None:
        text = typer.prompt(
            f"Device ({', '.join(PRESETS)}; Enter for none)", default="", show_default=False,
            err=True,
        )  # fmt: skip
        preset = text.strip() if text.strip() in ("", *PRESETS) else None
    return replace(answers, columns=columns, units=units), preset


def _choice(doubt: Doubt) -> str:
    what = "column is the" if doubt.key == "columns" else "unit has the"
    typer.echo(f"Which {what} {doubt.quantity}? ({doubt.why})", err=True)
    for number_, choice in enumerate(doubt.choices, start=1):
        typer.echo(f"  {number_}  {printable(choice)}", err=True)
    while True:
        text = str(typer.prompt("Number, or another name", default="1", err=True)).strip()
        if not text.isdigit():
            return text
        if 1 <= int(text) <= len(doubt.choices):
            return doubt.choices[int(text) - 1]

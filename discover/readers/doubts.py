"""What of a drafted campaign is unsure, so that the user should look at it."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from discover.readers.columns import find_column, split_header
from discover.readers.guess import UNSURE, Guess, TableGuess
from discover.readers.names import NAMED
from discover.readers.source import Source
from models.checks import InputError, printable

_MOST = 9  # headers to choose from


@dataclass(frozen=True)
class Doubt:
    """A guess that the user should look at."""

    quantity: str
    """Column that it is of."""
    key: str
    """"columns" or "units"."""
    taken: str
    """The header or the unit that was taken."""
    choices: tuple[str, ...]
    """What it may be besides, the taken one first."""
    why: str
    """In words."""


def doubts(tables: Sequence[tuple[Source, TableGuess]]) -> tuple[Doubt, ...]:
    """Return what is unsure, each once.

    Parameters
    ----------
    tables : sequence of (Source, TableGuess)
        The records' tables, and what their columns are taken for.
    """
    found: dict[tuple[str, str], Doubt] = {}
    for source, table in tables:
        for quantity, guess in table.columns.items():
            for doubt in _of_guess(guess, _besides(source, table, guess)):
                found.setdefault((quantity, doubt.key), doubt)
    for doubt in _of_changes(tables):
        found.setdefault((doubt.quantity, doubt.key), doubt)
    return tuple(found.values())


def _besides(source: Source, table: TableGuess, guess: Guess) -> tuple[str, ...]:
    """Return the headers that a guess by what is left may be instead."""
    if guess.others:
        return guess.others
    time = table.columns["time"].header if "time" in table.columns else ""
    return tuple(h for h in source.headers if h and h not in (guess.header, time))[:_MOST]


def _of_guess(guess: Guess, others: Sequence[str]) -> Iterator[Doubt]:
    if guess.sure == UNSURE:
        choices = (guess.header, *others)
        yield Doubt(guess.quantity, "columns", guess.header, choices, guess.why)
    if guess.unit_guessed:
        kinds = {"time": ("s", "ms"), "displacement": ("m", "mm"), "force": ("N", "kN")}
        usual = (u for u in kinds.get(guess.quantity, ()) if u != guess.unit)
        why = "no file states it; taken by the size of the values"
        yield Doubt(guess.quantity, "units", guess.unit, (guess.unit, *usual), why)


def _of_changes(tables: Sequence[tuple[Source, TableGuess]]) -> Iterator[Doubt]:
    """Yield a doubt where a file's column is another than in most files, which it has too."""
    for quantity in NAMED:
        own = [(s, g.columns[quantity]) for s, g in tables if quantity in g.columns]
        names = Counter(split_header(guess.header)[0] for _, guess in own)
        usual = names.most_common(1)[0][0] if names else ""
        for source, guess in own:
            name = split_header(guess.header)[0]
            if name != usual and _has_another(source, guess, usual):
                why = (
                    f"{printable(guess.header)} is taken in {source.name}, which has"
                    f" {printable(usual)} too, as {names[usual]} of {len(own)} have it"
                )
                yield Doubt(quantity, "columns", usual, (usual, name), why)
                break


def _has_another(source: Source, guess: Guess, header: str) -> bool:
    """Tell whether a header names a column that is not the guessed one."""
    try:
        index = find_column(source, guess.quantity, header)
    except InputError:  # it names several
        return True
    return index is not None and source.headers[index] != guess.header

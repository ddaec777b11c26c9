"""Files that lack something alone and are one test together, where their names say so plainly."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import PurePath

from discover.readers.entries import Entry
from discover.readers.guess import TableGuess
from discover.readers.joined import joined, name_words, named_quantity
from discover.readers.source import Source
from models.checks import InputError

_CHANNEL = ("ch", "chan", "channel", "kanal", "voie", "ai", "input", "signal", "sensor", "track")
_NEEDED = {"force", "displacement"}


@dataclass(frozen=True)
class LoneTable:
    """A file's only table, which is no record."""

    file: str
    """As in ``campaign.toml``."""
    source: Source
    """The table."""
    guess: TableGuess
    """What its columns are taken for."""


def joined_tables(
    tables: Sequence[LoneTable],
    *,
    step: float | None,
    guessed: Callable[[Source], TableGuess],
) -> tuple[list[tuple[Entry, Source, TableGuess]], dict[str, InputError]]:
    """Return the tests that several files make, and what is wrong with files that would be one.

    Names that differ in one word, as ``run1_force`` and ``run1_stroke``, or in the number of a
    channel, as ``run1_ch1`` and ``run1_ch2``, belong together where each file has another quantity,
    by its headers or else by that word, and all of them make a record.

    Parameters
    ----------
    tables : sequence of LoneTable
        Of files that hold no record.
    step : float, optional
        s, a sampling interval that stands for times.
    guessed : callable
        What a table's columns are taken for.
    """
    groups: dict[tuple[object, ...], list[tuple[LoneTable, str]]] = {}
    for table in tables:
        words = name_words(table.file)
        end = PurePath(table.file).suffix.lower()
        for at, word in enumerate(words):
            if word.isdigit() and not (at and words[at - 1].lower() in _CHANNEL):
                continue  # which may be the test's number
            rest = tuple(w.lower() for w in words[:at]), tuple(w.lower() for w in words[at + 1 :])
            groups.setdefault((end, *rest), []).append((table, word))
    found: dict[tuple[str, ...], tuple[Entry, Source, TableGuess]] = {}
    wrong: dict[str, InputError] = {}
    for group in groups.values():
        members = _members(group)
        files = tuple(table.file for table in members)
        if not members or any(set(files) & set(others) for others in found):
            continue
        try:
            source = joined([table.source for table in members], files, {})
        except InputError as error:
            wrong.update(dict.fromkeys(files, error))
            continue
        guess = guessed(source)
        if not [q for q in guess.lacks if not (q == "time" and step)]:
            entry = Entry(files[0], beside=files[1:], step=step)
            found[files] = (entry, source, guess)
    return list(found.values()), wrong


def _members(group: Sequence[tuple[LoneTable, str]]) -> list[LoneTable]:
    """Return the files of a group that make one test, none where that is not plain."""
    offers = [(table, _offered(table, word)) for table, word in group]
    offering = [(table, own) for table, own in offers if own]
    every = [quantity for _, own in offering for quantity in own]
    plain = len(offering) > 1 and len(set(every)) == len(every) and set(every) >= _NEEDED
    return [table for table, _ in offering] if plain else []


def _offered(table: LoneTable, word: str) -> set[str]:
    """Return the quantities that a file has, time only where it has nothing else."""
    known = set(table.guess.columns)
    if known - {"time"} or len(table.source.headers) == len(known):
        return known - {"time"} or known
    named = named_quantity([word])
    return set() if named is None else {named}

"""Files that lack something alone and are one test together, where their names say so plainly."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import PurePath

from discover.readers.entries import Entry
from discover.readers.guess import TableGuess
from discover.readers.joined import joined, name_words, named_quantity
from discover.readers.source import Source
from models.checks import InputError

_CHANNEL = ("ch", "chan", "channel", "kanal", "voie", "ai", "input", "signal", "sensor", "track")
_NEEDED = {"force", "displacement"}
_MOST_WORDS = 3  # in which names differ


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

    Names that differ in some words beside each other, as ``Run1LoadCell`` and ``Run1LVDT``, or in
    the number of a channel, as ``run1_ch1`` and ``run1_ch2``, belong together where each file has
    another quantity, by its headers or else by those words, and all of them make a record.

    Parameters
    ----------
    tables : sequence of LoneTable
        Of files that hold no record.
    step : float, optional
        s, a sampling interval that stands for times.
    guessed : callable
        What a table's columns are taken for.
    """
    groups: dict[tuple[object, ...], list[tuple[LoneTable, tuple[str, ...]]]] = {}
    for length in range(1, _MOST_WORDS + 1):  # of names that fit in several ways, the nearest
        for table in tables:
            for own, rest in _parted(name_words(table.file), length):
                key = (PurePath(table.file).suffix.lower(), *rest)
                fitting = groups.setdefault(key, [])
                if all(table is not member for member, _ in fitting):
                    fitting.append((table, own))
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


def _parted(words: Sequence[str], length: int) -> Iterator[tuple[tuple[str, ...], list[str]]]:
    """Yield some words beside each other of a name, and the others; numbers only of channels."""
    for at in range(len(words) - length + 1):
        own = tuple(words[at : at + length])
        channel = length == 1 and at > 0 and words[at - 1].lower() in _CHANNEL
        if channel or not any(word.isdigit() for word in own):  # which may be the test's number
            yield own, [word.lower() for word in (*words[:at], *words[at + length :])]


def _members(group: Sequence[tuple[LoneTable, tuple[str, ...]]]) -> list[LoneTable]:
    """Return the files of a group that make one test, none where that is not plain."""
    offers = [(table, _offered(table, words)) for table, words in group]
    offering = [(table, own) for table, own in offers if own]
    every = [quantity for _, own in offering for quantity in own]
    plain = len(offering) > 1 and len(set(every)) == len(every) and set(every) >= _NEEDED
    return [table for table, _ in offering] if plain else []


def _offered(table: LoneTable, words: Sequence[str]) -> set[str]:
    """Return the quantities that a file has, time only where it has nothing else."""
    known = set(table.guess.columns)
    if known - {"time"} or len(table.source.headers) == len(known):
        return known - {"time"} or known
    named = named_quantity(words)
    return set() if named is None else {named}

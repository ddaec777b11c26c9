"""Records of a file, with what is found in them, wherever a process sees the folder.

What goes there is the file's name and what ``campaign.toml`` says of it. What comes back of a
sine test is motion, lines and sums of all its samples, and its first ones, to be shown. Nothing
as compact stands for other motion: of such a record that is long, band and noise come back, and
its samples are read again where they are needed.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import cache
from itertools import groupby
from pathlib import Path

from threadpoolctl import ThreadpoolController

from discover.executor import Executor, Lost
from discover.motion_fit import Found, found_in, stands_for_samples
from discover.readers.choice import chosen_sources, one_table
from discover.readers.entries import Entry
from discover.readers.formats import IN_PIECES, open_book
from discover.readers.inside import bytes_of, path_of
from discover.readers.joined import joined
from discover.readers.long_record import read_record_of_any_length
from discover.readers.plausibility import sizes_of
from discover.readers.source import Book, Source
from discover.record_checks import (
    apparent_of,
    digest_of,
    force_deviation,
    returns,
    turns,
    work_of,
)
from discover.record_kind import classify
from discover.records import Finding, Record
from models.checks import InputError

HELD = 2**16
"""Samples that come back of a record."""


@dataclass(frozen=True)
class Asked:
    """Records that are asked for, of one file or of files beside each other."""

    folder: Path
    """Of the campaign, absolute."""
    entries: tuple[Entry, ...]
    """What ``campaign.toml`` says of them."""
    names: Mapping[str, str]
    """``[columns]``."""
    units: Mapping[str, str]
    """``[units]``."""
    where: str
    """What holds the entries, for messages."""
    inertial: bool
    """True where the apparent inertance is wanted."""
    apart: bool = False
    """True where what is found goes to another process."""


@dataclass(frozen=True)
class Taken:
    """A record, as read."""

    record: Record
    """Its samples."""
    findings: tuple[Finding, ...]
    """What had to be mended or was odd."""
    units: Mapping[str, str | None]
    """By quantity, as read; None where none is stated."""


def parted(
    entries: Sequence[Entry],
    folder: Path,
    *,
    names: Mapping[str, str],
    units: Mapping[str, str],
    where: str,
    inertial: bool,
) -> list[Asked]:
    """Return the entries of a campaign as parts of work, of a file each, in their order."""
    root = folder.resolve()
    return [
        Asked(root, tuple(group), names, units, where, inertial)
        for _, group in groupby(entries, key=lambda entry: entry.files)
    ]


def taken(asked: Asked) -> Iterator[Taken | InputError]:
    """Yield the records that are asked for, or what is wrong with them."""
    book: Book | None = None
    for entry in asked.entries:
        own = {**asked.names, **entry.channel}
        try:
            if entry.beside:
                tables = [one_table(_opened(asked, file), entry, own) for file in entry.files]
                sources = [joined(tables, entry.files, own)]
            else:
                book = book or _opened(asked, entry.file)
                sources = chosen_sources(book, entry, own)
        except InputError as error:
            yield error
            continue
        for source in sources:
            part = source.part if entry.part is not None or len(sources) > 1 else ""
            try:
                yield _taken(source, entry, own, {**asked.units, **entry.units}, part)
            except InputError as error:
                yield error


def _taken(
    source: Source, entry: Entry, names: Mapping[str, str], units: Mapping[str, str], part: str
) -> Taken:
    found = read_record_of_any_length(source, entry, names=names, units=units, part=part)
    record, findings, read = found
    return Taken(record, tuple(findings), read)


def _opened(asked: Asked, file: str) -> Book:
    opener = IN_PIECES.get(Path(file).suffix.lower())
    if opener is not None:
        return opener(path_of(asked.folder, file, where=asked.where), file)
    return open_book(
        bytes_of(asked.folder, file, where=asked.where), file, where=asked.where
    )


def taken_over(
    asked: Sequence[Asked], over: Executor, tell: Callable[[str], None] | None = None
) -> Iterator[Taken | InputError]:
    """Yield the records of all parts of the work, in their order, as an executor has done them.

    Raises
    ------
    InputError
        Where the executor can't do the work.
    """
    parts = [replace(each, apart=over.apart) for each in asked]
    done: dict[int, list[_Found | InputError]] = {}
    for place, found in over.finished(found_of, parts):
        if isinstance(found, Lost):
            file = " + ".join(parts[place].entries[0].files)
            raise InputError("file", expected="worked on", found=found.reason, where=file)
        done[place] = found
        if tell is not None:
            tell(f"{len(done)} of {len(parts)}")
    for place, part in enumerate(parts):
        yield from _here(part, done.pop(place))


@dataclass(frozen=True)
class _Found:
    """What comes back of a record."""

    taken: Taken | None
    """None where its samples are too many to come along."""
    found: Found
    """In all its samples."""


def found_of(asked: Asked) -> list[_Found | InputError]:
    """Return the records that are asked for, observed, or what is wrong with them."""
    with _libraries().limit(limits=1):  # so that results are the same wherever they are made
        return [
            each if isinstance(each, InputError) else _found(each, asked)
            for each in taken(asked)
        ]


@cache
def _libraries() -> ThreadpoolController:
    """Return what limits the threads of linear algebra: finding its libraries takes a while."""
    return ThreadpoolController()


def _found(each: Taken, asked: Asked) -> _Found:
    """Return a record with what verbs ask of all its samples, or that alone."""
    record = each.record
    found_in(record)
    digest_of(record)
    force_deviation(record)
    returns(record)
    turns(record)
    work = work_of(record)
    if record.displacement is not None:
        sizes_of(record)
    with suppress(InputError):
        if asked.inertial or (work is not None and work.gives):
            apparent_of(record)
    if stands_for_samples(record):
        start = classify(record).usable.start or 0
        record = record.first(start + HELD)
    elif asked.apart and record.time.size > HELD:
        return _Found(None, dict(record.found))
    return _Found(replace(each, record=record), {})


def _here(part: Asked, found: Sequence[_Found | InputError]) -> Iterator[Taken | InputError]:
    """Yield what came back; records whose samples did not come along are read again."""
    again = any(isinstance(f, _Found) and f.taken is None for f in found)
    for each, own in zip(taken(part) if again else found, found, strict=True):
        if isinstance(own, InputError):
            yield own
        elif own.taken is not None:
            yield own.taken
        elif isinstance(each, Taken):
            each.record.learn(own.found)
            yield each
        elif isinstance(each, InputError):  # the file is another one by now
            yield each

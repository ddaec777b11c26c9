"""Which table of a file is a record: the one that is asked for, or the only one that can be."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from fnmatch import fnmatchcase

from discover.readers.columns import find_column
from discover.readers.entries import Entry
from discover.readers.source import Book, Source
from discover.readers.stacked import stacked
from models.checks import InputError, nearest, shown

_NEEDED = ("time", "displacement", "force")


def chosen_sources(book: Book, entry: Entry, names: Mapping[str, str]) -> list[Source]:
    """Return the tables of a file that an entry asks for.

    Parameters
    ----------
    book : Book
        The opened file.
    entry : Entry
        What ``campaign.toml`` says of it. A pattern of parts gives every one that has a record's
        columns.
    names : mapping
        Headers by quantity.

    Raises
    ------
    InputError
        Where the file has no such part, or several could be meant.
    """
    if entry.part is None:
        source = _only_source(book, entry, names)
        return [_range_of(book, source, entry)]
    if entry.key != book.key:
        raise InputError(
            f"key {entry.key!r}", expected=f"{book.key!r} for a file of this kind",
            found=shown(entry.part), where=entry.file,
        )  # fmt: skip
    named = [part for part in book.parts if part.part == str(entry.part).strip()]
    parts = named or _parts(book, entry, names)
    listed = [part.part for part in parts]
    if isinstance(entry.part, int):
        if not 1 <= entry.part <= len(listed):
            raise InputError(
                book.key, expected=f"from 1 to {len(listed)}", found=shown(entry.part),
                where=entry.file,
            )  # fmt: skip
        return [_range_of(book, parts[entry.part - 1], entry)]
    wanted = entry.part.strip()
    if wanted in listed:
        return [_range_of(book, parts[listed.index(wanted)], entry)]
    fitting = [part for part in parts if fnmatchcase(part.part, wanted)]
    able = [part for part in fitting if has_record(part, entry, names)] or fitting
    if not able:
        raise InputError(
            book.key, expected="one of " + _listed(listed),
            found=shown(entry.part) + nearest(wanted, listed), where=entry.file,
        )  # fmt: skip
    return [_range_of(book, part, entry) for part in able]


def _parts(book: Book, entry: Entry, names: Mapping[str, str]) -> list[Source]:
    """Return a file's tables, of one in which several tests are stacked these."""
    timed = entry.step is not None
    parts = [s for table in book.parts for s in _tests(book, table, names, timed=timed) or [table]]
    if book.whole is None or any(has_record(part, entry, names) for part in parts):
        return parts
    return parts + _tests(book, book.whole, names, timed=timed)


def _tests(book: Book, table: Source, names: Mapping[str, str], *, timed: bool) -> list[Source]:
    """Return the tests that are stacked in a table of a file."""
    asked = (table.name, names.get("time", "time"), timed)
    if asked not in book.stacks:
        book.stacks[asked] = stacked(table, names, timed=timed)
    return book.stacks[asked]


def one_table(book: Book, entry: Entry, names: Mapping[str, str]) -> Source:
    """Return the table of a file that holds some channels of a test.

    Raises
    ------
    InputError
        As `chosen_sources`; or where the file has several tables and none is asked for.
    """
    if entry.part is None and book.whole is not None:
        return book.whole
    if entry.part is None and len(book.parts) > 1:
        raise InputError(
            book.key, expected="given in [[records]], as one of "
            + _listed([part.part for part in book.parts]), found="none", where=book.name,
        )  # fmt: skip
    found = chosen_sources(book, replace(entry, file=book.name), names)
    if len(found) > 1:
        raise InputError(
            book.key, expected="one table, in a list of the files of one test",
            found=f"{len(found)} that {shown(entry.part)} fits", where=book.name,
        )  # fmt: skip
    return found[0]


def has_record(source: Source, entry: Entry, names: Mapping[str, str]) -> bool:
    """Return whether a table has what a record needs: force, time, and motion unless labelled."""
    timed = source.step is not None or entry.step is not None
    labelled = entry.frequency is not None and entry.amplitude is not None
    for quantity in _NEEDED:
        if (quantity == "time" and timed) or (quantity == "displacement" and labelled):
            continue
        try:
            found = find_column(source, quantity, names.get(quantity, quantity))
        except InputError:
            return False
        if found is None:
            return False
    return True


def _only_source(book: Book, entry: Entry, names: Mapping[str, str]) -> Source:
    if len(book.parts) == 1:
        tests = _unseen_tests(book.parts[0], entry, names)
        if tests:
            raise _which(book, tests, entry)
        return book.parts[0]
    if book.whole is not None and has_record(book.whole, entry, names):
        return book.whole
    able = [part for part in book.parts if has_record(part, entry, names)]
    if len(able) == 1:
        return able[0]
    if not able:
        return book.whole or book.parts[0]  # which says what it lacks
    raise _which(book, able, entry)


def _unseen_tests(source: Source, entry: Entry, names: Mapping[str, str]) -> list[Source]:
    """Return the tests of a table whose times, made of a rate, would run through all of them."""
    if entry.span != (None, None):
        return []
    if entry.step is None:
        if (
            source.step is None
            or find_column(source, "time", names.get("time", "time")) is not None
        ):
            return []
    return stacked(source, names, timed=True)


def _which(book: Book, parts: Sequence[Source], entry: Entry) -> InputError:
    return InputError(
        book.key,
        expected="given in [[records]], as one of " + _listed([part.part for part in parts])
        + ', or as "*" for a record each',
        found="none",
        where=entry.file,
    )  # fmt: skip


def _listed(names: list[str]) -> str:
    shown_names = [shown(name, longest=40) for name in names[:12]]
    more = f" and {len(names) - 12} more" if len(names) > 12 else ""
    return ", ".join(shown_names) + more


def _range_of(book: Book, source: Source, entry: Entry) -> Source:
    if not entry.cells:
        return source
    if book.cells is None:
        raise InputError(
            "range", expected='a span of time, as "10 s : 25 s"', found=shown(entry.cells),
            where=entry.file,
        )  # fmt: skip
    return book.cells(source.part, entry.cells)

"""Which tables of a folder's files can be records, by what their columns are taken for."""

from __future__ import annotations

import shlex
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from discover.readers.columns import QUANTITIES, find_column, split_header, stated_unit
from discover.readers.draft_joined import LoneTable, joined_tables
from discover.readers.entries import Entry
from discover.readers.formats import OPENERS, open_file
from discover.readers.guess import Guess, TableGuess, guess_table
from discover.readers.long_record import first_part
from discover.readers.names import NAMED, name_score
from discover.readers.source import Book, Source
from discover.readers.stacked import stacked_by, stacked_time
from discover.readers.units import measures
from models.checks import InputError, nearest, printable, shown

_VOLTS = ("V", "mV", "volt", "volts", "Volt", "Volts")
_EXAMPLES = {"time": "1 ms", "displacement": "5 mm", "force": "2 kN"}
_WEIGHTS = {"kg": "kgf", "lb": "lbf", "lbs": "lbf"}
_MOST_TOLD = 30  # headers
NO_TIME = "no column for time among"
"""Begins what is told of a table that lacks nothing but time."""


@dataclass(frozen=True)
class Answers:
    """What the user says in place of a guess."""

    columns: Mapping[str, str]
    """Headers by quantity."""
    units: Mapping[str, str]
    """Units by quantity, for columns whose unit the files do not state."""
    sampling_rate: float | None = None
    """Hz, of files without a time column."""


def record_files(folder: Path) -> list[str]:
    """Return the files below a folder that may be records, hidden ones and results left out."""
    found = []
    for path in sorted(folder.rglob("*")):
        inside = path.relative_to(folder)
        hidden = any(part.startswith(".") or part == "inerter-out" for part in inside.parts)
        if not hidden and path.suffix.lower() in OPENERS and path.is_file():
            found.append(inside.as_posix())
    return found


def found_tables(
    folder: Path, files: Sequence[str], answers: Answers
) -> tuple[list[tuple[Entry, Source, TableGuess]], list[tuple[str, str]]]:
    """Return the tables of all files that can be records, and the files that hold none with why."""
    found: list[tuple[Entry, Source, TableGuess]] = []
    left_out: list[tuple[str, str]] = []
    headers: list[str] = []
    lone: list[LoneTable] = []
    for file in files:
        entry = Entry(file, step=_step(answers))
        try:
            book = open_file(folder / file, file, where=file)
        except InputError as error:
            left_out.append((file, without(file, error)))
            continue
        headers += [h for source in (*book.parts, book.whole) if source for h in source.headers]
        parts, lacking = _tables(book, answers, stepped=entry.step is not None)
        found += [(_named(entry, book, source), source, guess) for source, guess in parts]
        if not parts:
            left_out.append((file, lacking))
            table = book.whole or book.parts[0]
            if len(book.parts) == 1 or book.whole is not None:
                lone.append(LoneTable(file, table, _guessed(table, answers)))
    together, wrong = joined_tables(
        lone, step=_step(answers), guessed=lambda source: _guessed(source, answers)
    )
    found = sorted([*found, *together], key=lambda table: files.index(table[0].file))
    used = {file for entry, _, _ in together for file in entry.files}
    headers += [h for _, source, _ in together for h in source.headers]
    _check_named(answers.columns, headers)
    told = [(f, str(wrong[f]) if f in wrong else why) for f, why in left_out if f not in used]
    return found, told


def _step(answers: Answers) -> float | None:
    return None if answers.sampling_rate is None else 1.0 / answers.sampling_rate


def _tables(
    book: Book, answers: Answers, *, stepped: bool
) -> tuple[list[tuple[Source, TableGuess]], str]:
    """Return the tables that can be records, or none and what the first one lacks."""
    whole = [] if book.whole is None else [book.whole]
    first = ""
    for sources in (book.parts, whole):
        able: list[tuple[Source, TableGuess]] = []
        for source in sources:
            guess = _guessed(source, answers)
            tests = _stacked(source, guess, stepped=stepped)
            guesses = [_guessed(test, answers) for test in tests] or [guess]
            lacks = [q for q in guesses[0].lacks if not (q == "time" and stepped)]
            if not lacks:
                able += zip(tests or [source], guesses, strict=True)
            elif not first:
                first = _lacking(source, lacks, answers.columns)
        if able:
            return able, ""
    return [], first


def _stacked(source: Source, guess: TableGuess, *, stepped: bool) -> list[Source]:
    """Return the tests that stand below each other in a table; none where it is one test."""
    if stepped or ("time" not in guess.columns and source.step is not None):
        return stacked_by(source, None)
    own = guess.columns.get("time")
    time = stacked_time(source) if own is None else source.headers.index(own.header)
    try:
        return [] if time is None else stacked_by(source, time)
    except InputError:  # which reading tells with its place
        return []


def _lacking(source: Source, lacks: Sequence[str], named: Mapping[str, str]) -> str:
    """Return what a table lacks and what to do about it."""
    names = printable(", ".join(source.headers[:12]))
    text = f"no column for {' and '.join(lacks)} among {names}"
    foreign = _foreign(source, lacks, named)
    if foreign is not None:
        quantity, index = foreign
        header = printable(source.headers[index])
        stated = stated_unit(source, index) or ""
        example = _WEIGHTS.get(stated, _EXAMPLES[quantity])
        column, unit = (shlex.quote(f"{quantity}={v}") for v in (header, example))
        return text + (
            f"; {header} has the unit {shown(stated)}: if it is the"
            f" {quantity}, --column {column} --unit {unit} say so, and what one of it is"
        )
    text += _no_number(source)
    if tuple(lacks) == ("time",):
        return text + "; --sampling-rate '1 kHz' makes the times, or --column time=HEADER names it"
    if tuple(lacks) == ("displacement",):
        return text + (
            "; --column displacement=HEADER names it; velocity or acceleration alone will not do:"
            " integrate it in the file"
        )
    return text + f"; --column {lacks[0]}=HEADER names it"


def _no_number(source: Source) -> str:
    """Return which column of numbers could not be told by its values, and why, "" for none."""
    for index, header in enumerate(source.headers):
        named = any(name_score(split_header(header)[0], q) for q in NAMED)
        try:
            column = np.empty(0) if named else source.read([index])[0]
        except InputError:
            continue
        bad = np.flatnonzero(~np.isfinite(column))
        if 0 < bad.size < 0.5 * column.size:
            row = int(bad[0])
            text = source.cell(row, index) if source.cell else f"{column[row]:g}"
            return f"; {printable(header)} has {shown(text)} in {source.place(row)}"
    return ""


def _foreign(
    source: Source, lacks: Sequence[str], named: Mapping[str, str]
) -> tuple[str, int] | None:
    """Return what is lacking and the column that may be it, but for a unit of another kind.

    It is the one that the user names, or one of the quantity's name or in volts.
    """
    known = {find_column(source, q, header): q for q, header in named.items()}
    for quantity in (q for q in lacks if q in _EXAMPLES):
        for index, header in enumerate(source.headers):
            unit = stated_unit(source, index)
            if unit is None or measures(unit, QUANTITIES[quantity]):
                continue
            if quantity in known.values() or index in known:
                fitting = known.get(index) == quantity
            else:
                by_name = name_score(split_header(header)[0], quantity) > 0.0
                fitting = by_name or (unit in _VOLTS and quantity != "time")
            if fitting:
                return quantity, index
    return None


def _guessed(source: Source, answers: Answers) -> TableGuess:
    """Return a table's guess with the columns that the user named."""
    guess = guess_table(first_part(source))
    columns = dict(guess.columns)
    if answers.sampling_rate is not None:
        columns.pop("time", None)  # the rate is asked for in its place
    for quantity, header in answers.columns.items():
        index = find_column(source, quantity, header)
        if index is None:
            continue
        named = source.headers[index]
        named = named if source.headers.count(named) == 1 else header  # which is its place
        columns = {q: g for q, g in columns.items() if g.header != named or q == quantity}
        stated, told = stated_unit(source, index) or "", answers.units.get(quantity, "")
        fits = measures(stated, QUANTITIES[quantity])
        if stated and not fits and not told:
            columns.pop(quantity, None)  # nobody says what one of it is, as one volt
            continue
        unit = (stated if fits else told) or _unit_of(columns.get(quantity), quantity)
        columns[quantity] = Guess(quantity, named, "sure", "you said so", unit, fits)
    missing = [q for q in ("time", "force", "displacement") if q not in columns]
    timed = source.step is not None
    lacks = tuple(q for q in missing if not (q == "time" and timed))
    return TableGuess(columns, lacks)


def _unit_of(guess: Guess | None, quantity: str) -> str:
    return guess.unit if guess else {"time": "s", "force": "N"}.get(quantity, "m")


def _check_named(named: Mapping[str, str], headers: Sequence[str]) -> None:
    """Refuse a header that the user named and no file has."""
    there = list(dict.fromkeys(headers))
    source = Source("", tuple(there), lambda _: [])
    for quantity, header in named.items():
        if there and not _has(source, quantity, header):
            known = {split_header(h)[0].lower(): h for h in there}
            near = nearest(split_header(header)[0].lower(), known)
            raise InputError(
                f"column of {quantity}",
                expected="one that some file has: " + ", ".join(there[:_MOST_TOLD]),
                found=shown(header) + near,
                where="--column",
            )


def _has(source: Source, quantity: str, header: str) -> bool:
    try:
        return find_column(source, quantity, header) is not None
    except InputError:  # several files have it, each in its own case
        return True


def _named(entry: Entry, book: Book, source: Source) -> Entry:
    """Return the entry with the part of the file, where it has several."""
    if (len(book.parts) == 1 and source.part == book.parts[0].part) or not source.part:
        return entry
    return replace(entry, key=book.key, part=source.part)


def without(file: str, error: InputError) -> str:
    """Return an error's text without the file that it begins with."""
    text = str(error)
    return text.removeprefix(file).lstrip(" :,") if text.startswith(file) else text
